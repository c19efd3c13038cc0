//! Interpolation whose gradient is continuous, too.

use super::{
    super::{Locator, locate::Beyond},
    Interpolation, Interpolator, Outside, Query, State, StolenMeasures, gradients,
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet, vector},
    predicates::{
        big::{Big, common_exponent, quotient},
        polynomial::minus,
    },
};

impl<const D: usize, const N: usize> Interpolator<'_, D, N>
where
    Euclidean: StolenMeasures<D, N>,
{
    /// Returns the gradient of the values at each point; those of duplicates are 0.
    ///
    /// Along each edge, the values and the gradients of its ends determine a cubic, and the gradients are
    /// those for which the sum of the integrals of the squares of the cubics' second derivatives is least
    /// (Nielson 1983), which SciPy's `CloughTocher2DInterpolator` approximates. Those of linear functions are right
    /// up to rounding. Edges to values that are not finite are left out. What flat points do not
    /// determine is 0.
    ///
    /// The first call finds them, as does the first [smooth](Interpolation::is_smooth) interpolation. All
    /// threads share the work, and the result does not depend on their number.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Interpolator, Locator};
    ///
    /// let points: Vec<[f64; 2]> = (0..100).map(|i| [i % 10, i / 10].map(f64::from)).collect();
    /// let values: Vec<f64> = points.iter().map(|[x, y]| 3.0 * x - y).collect();
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = Locator::new(&mesh, &points)?;
    /// for [x, y] in Interpolator::new(&locator, &values)?.gradients() {
    ///     assert!((x - 3.0).abs() < 1e-12 && (y + 1.0).abs() < 1e-12);
    /// }
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn gradients(&self) -> &[[f64; D]] {
        self.gradients.get_or_init(|| gradients::gradients(self.locator, &self.values).into())
    }

    /// Returns the value at a query by a smooth method, and whether the query is outside the hull.
    pub(super) fn smooth_value(
        &self,
        method: Interpolation,
        query: &Query<D>,
        state: &mut State<D>,
    ) -> Result<(f64, bool), Error> {
        let is_outside = self.find_weights(method.of_weights(), query, state)?;
        if is_outside {
            return Ok((self.smooth_outside(method, query, state)?, true));
        }
        state.weights.retain(|&(_, weight)| weight != 0.0);
        let value = match (method, &state.weights[..]) {
            (_, [] | [_]) => self.weighted(&state.weights),
            (Interpolation::SibsonC1, weights) => self.sibson(query, weights),
            (_, &[from, to]) => self.cubic(from, to),
            (_, &[a, b, c]) => self.clough_tocher([a, b, c], state.simplex),
            _ => f64::NAN,
        };
        Ok((value, false))
    }

    /// Returns the value at a query outside the hull, whose weights are found.
    fn smooth_outside(&self, method: Interpolation, query: &Query<D>, state: &mut State<D>) -> Result<f64, Error> {
        let place = query.place.and_then(|place| Some((place.simplex, place.beyond?)));
        let (Outside::Linear, Some((t, Beyond { facet: k, .. }))) = (self.outside, place) else {
            return Ok(self.weighted(&state.weights));
        };
        let complex = &self.locator.complex;
        let ((t, k), shares) = self.locator.nearest_facet(query.at, (t, k));
        let vertices = facet(&complex.simplices[t], k);
        let mut foot = [0.0; D];
        for (v, share) in vertices.into_iter().zip(shares) {
            foot = vector::plus(foot, vector::times(share, complex.point(v)));
        }
        let way = vector::minus(query.at, foot);
        let at_foot = self.find(foot)?;
        let is_inside = at_foot.place.is_some_and(|place| place.beyond.is_none_or(|beyond| beyond.near));
        let value = if is_inside {
            self.smooth_value(method, &at_foot, state)?.0
        } else {
            // Rounding has moved it too far.
            self.weighted(&vertices.into_iter().zip(shares).collect::<Vec<_>>())
        };
        let slopes = vertices.into_iter().zip(shares).filter(|&(_, share)| share != 0.0);
        Ok(value + slopes.map(|(v, share)| share * vector::dot(self.gradients()[v as usize], way)).sum::<f64>())
    }

    /// Returns the change of value from one vertex to another by the gradient of the first.
    fn rise(&self, from: u32, to: u32) -> f64 {
        let point = |v| self.locator.complex.point(v);
        vector::dot(self.gradients()[from as usize], vector::minus(point(to), point(from)))
    }

    /// Returns the value between two vertices.
    fn cubic(&self, (v, s): (u32, f64), (w, t): (u32, f64)) -> f64 {
        let [at_v, at_w] = [v, w].map(|v| self.values[v as usize]);
        let [by_v, by_w] = [at_v + self.rise(v, w) / 3.0, at_w + self.rise(w, v) / 3.0];
        s * s * (s * at_v + 3.0 * t * by_v) + t * t * (3.0 * s * by_w + t * at_w)
    }

    /// Returns Sibson's C¹ interpolant (Sibson 1981) at a query.
    ///
    /// It mixes the mean of the values with that of what the gradients of the vertices say, in which the
    /// nearer ones count more.
    fn sibson(&self, query: &Query<D>, weights: &[(u32, f64)]) -> f64 {
        let Locator { complex, scale, .. } = self.locator;
        let at = query.place.map_or(query.at, |place| place.at);
        let [mut mean, mut steep, mut inverse, mut direct, mut squares] = [0.0; 5];
        for &(v, weight) in weights {
            let way = vector::minus(at, complex.point(v));
            let distance = vector::norm(vector::times(*scale, way));
            let value = self.values[v as usize];
            mean += weight * value;
            steep += weight / distance * (value + vector::dot(self.gradients()[v as usize], way));
            inverse += weight / distance;
            direct += weight * distance;
            squares += weight * distance * distance;
        }
        let share = direct / inverse;
        let mixed = (share * mean + squares * (steep / inverse)) / (share + squares);
        // So near to a vertex that squares underflow.
        if squares == 0.0 { mean } else { mixed }
    }

    /// Returns the Clough–Tocher interpolant (Alfeld 1984) within a triangle, by the shares of its corners.
    ///
    /// The triangle is divided at its centre into three, each with a cubic in Bernstein–Bézier form. Where
    /// two triangles meet, the derivative along a direction is linear on their edge, that from the centre
    /// of the one to the centre of the other, which no affine map changes.
    fn clough_tocher(&self, corners: [(u32, f64); 3], t: usize) -> f64 {
        let vertices = corners.map(|(v, _)| v);
        let value = vertices.map(|v| self.values[v as usize]);
        // The control point on the edge from one corner to another that is nearer to the first.
        let near = |i: usize, j: usize| value[i] + self.rise(vertices[i], vertices[j]) / 3.0;
        let next: [f64; 3] = std::array::from_fn(|k| near(k, (k + 1) % 3));
        let last: [f64; 3] = std::array::from_fn(|k| near(k, (k + 2) % 3));
        let inner: [f64; 3] = std::array::from_fn(|k| (value[k] + next[k] + last[k]) / 3.0);
        // Opposite corner k, in the middle of the part at that edge.
        let middle: [f64; 3] = std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let along = 3.0 * (next[i] - last[j]) + value[j] - value[i];
            let across = 2.0 * next[i] - last[j] - value[i] + inner[i] + inner[j];
            (self.direction(t, k) * along + across) / 2.0
        });
        let beside: [f64; 3] = std::array::from_fn(|k| (inner[k] + middle[(k + 1) % 3] + middle[(k + 2) % 3]) / 3.0);
        let center = beside.iter().sum::<f64>() / 3.0;
        // The part that contains the query is opposite the corner with the least share.
        let shares = corners.map(|(_, share)| share);
        let k = (0..3).min_by(|&i, &j| shares[i].total_cmp(&shares[j])).unwrap_or(0);
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let [u, v, w] = [shares[i] - shares[k], shares[j] - shares[k], 3.0 * shares[k]];
        let ends = u * u * (u * value[i] + 3.0 * (v * next[i] + w * inner[i]))
            + v * v * (v * value[j] + 3.0 * (u * last[j] + w * inner[j]));
        ends + w * w * (w * center + 3.0 * (u * beside[i] + v * beside[j])) + 6.0 * u * v * w * middle[k]
    }

    /// Returns how far the direction across the edge opposite corner *k* of a triangle, from the first end to the
    /// centre, turns along the edge: −1/2 towards the middle of the edge, as where there is no neighbour.
    fn direction(&self, t: usize, k: usize) -> f64 {
        match &self.plane {
            Some(locators) => direction::<2, 3>(&locators[0], t, k),
            None => direction(self.locator, t, k),
        }
    }
}

/// Does so for a triangle of a 2D mesh.
fn direction<const D: usize, const N: usize>(locator: &Locator<'_, D, N>, t: usize, k: usize) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let complex = &locator.complex;
    let Some(across) = complex.across(t, k) else { return -0.5 };
    let facet = complex.facet_towards(across, t);
    // In 2D, both have two coordinates.
    let planar = |p: [f64; D]| [p[0], p[1]];
    let corners = complex.corners(t);
    let [first, second, opposite] = [(k + 1) % 3, (k + 2) % 3, k].map(|i| planar(corners[i]));
    let apex = planar(complex.point(complex.simplices[across][facet % N]));
    let scaled = |p: [f64; 2]| vector::times(locator.scale, vector::minus(p, apex));
    let [a, b, c] = [first, second, opposite].map(scaled);
    // The shares of the ends of the edge in the apex are ratios of these.
    let area = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let [of_first, of_second] = [area(b, c), area(c, a)];
    let extent = [a, b, c].as_flattened().iter().fold(0.0f64, |extent, x| extent.max(x.abs()));
    let both = of_first + of_second;
    if (1e-90..1e90).contains(&extent) && both * 1024.0 > extent * extent {
        return -(both + of_second) / (3.0 * both);
    }
    exact_direction([first, second, opposite], apex)
}

#[inline(never)]
fn exact_direction(corners: [[f64; 2]; 3], apex: [f64; 2]) -> f64 {
    let exponent = common_exponent(corners.as_flattened()).min(common_exponent(&apex));
    let integer = |p: [f64; 2]| p.map(|x| Big::new(x, exponent));
    let origin = integer(apex);
    let [a, b, c] = corners.map(|corner| minus(&integer(corner), &origin));
    let area = |p: &[Big; 2], q: &[Big; 2]| p[0].clone() * q[1].clone() - p[1].clone() * q[0].clone();
    let [of_first, of_second] = [area(&b, &c), area(&c, &a)];
    let both = of_first + of_second.clone();
    // The mesh is broken.
    if both.sign() <= 0 {
        return f64::NAN;
    }
    -(1.0 + quotient(&of_second, &both, 0)) / 3.0
}
