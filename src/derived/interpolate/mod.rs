//! Interpolation of values at the vertices.

mod cavity;
mod hull;
mod measures;
mod natural;
mod numeric;

pub use measures::StolenMeasures;

use super::{Locator, locate::Place, queries::map_along_curve};
use crate::{
    error::Error,
    geometry::{Euclidean, barycentric},
    input::points::Points,
};
use natural::Scratch;

/// How values are interpolated between vertices.
///
/// # Examples
///
/// ```
/// use gdel::{Interpolation, Interpolator, Locator};
///
/// // The centre of a square: linear interpolation sees only one of its two triangles.
/// let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
/// let interpolator = Interpolator::new(&locator, &[1.0, 0.0, 0.0, 0.0])?;
/// let at = |method| interpolator.interpolate(method, [0.5, 0.5]);
/// assert_eq!(at(Interpolation::Sibson)?, 0.25);
/// assert_eq!(at(Interpolation::Laplace)?, 0.25);
/// assert!([0.0, 0.5].contains(&at(Interpolation::Linear)?));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Interpolation {
    /// Barycentric coordinates in the simplex that contains the point: continuous, and the fastest.
    Linear,
    /// Natural neighbours, weighted by the measures of the facets that the point's Voronoi cell
    /// would have, divided by the distances (Belikov et al. 1997; Sugihara 1999): continuous, and
    /// smooth except where natural neighbours change and at the vertices.
    Laplace,
    /// Natural neighbours, weighted by what the point's Voronoi cell would take from theirs (Sibson
    /// 1981): smooth except at the vertices.
    Sibson,
}

/// Interpolates values that are given at the points of a mesh.
///
/// All methods reproduce linear functions, within an error of 10⁻¹⁰ times the largest value, and
/// the value of a vertex at the vertex. Outside the hull, and everywhere if the mesh has no
/// simplices, there is no value: NaN. On the hull's boundary, where the point's Voronoi cell would
/// be unbounded, the weights are the limits from inside, which depend only on the vertices in the
/// same plane or on the same line. Nearer to it than about 10⁻¹⁸ times the distances of the
/// vertices, but not on it, interpolation is linear.
///
/// Linear, Laplace and Sibson interpolation of the same values:
///
#[cfg_attr(doc, doc = concat!("<div>\n", include_str!("../../../docs/answers/interpolate.svg"), "</div>"))]
///
/// # Examples
///
/// ```
/// use gdel::{Interpolation, Interpolator, Locator};
///
/// let points: Vec<[f64; 3]> = (0..1000).map(|i| [i % 10, i / 10 % 10, i / 100].map(f64::from)).collect();
/// let values: Vec<f64> = points.iter().map(|[x, y, z]| x + 2.0 * y - z).collect();
/// let mesh = gdel::delaunay3d(&points)?;
/// let locator = Locator::new(&mesh, &points)?;
/// let interpolator = Interpolator::new(&locator, &values)?;
///
/// let queries = [[1.25, 2.5, 3.75], [4.0, 4.0, 4.0], [9.5, 0.0, 0.0f32]];
/// let found = interpolator.interpolate_many(Interpolation::Sibson, &queries)?;
/// assert!((found[0] - 2.5).abs() < 1e-12);
/// assert_eq!(found[1], 8.0);
/// assert!(found[2].is_nan());
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug)]
pub struct Interpolator<'a, const D: usize = 3, const N: usize = 4> {
    locator: &'a Locator<'a, D, N>,
    values: &'a [f64],
}

/// Interpolates values that are given at the points of a 2D mesh.
pub type Interpolator2<'a> = Interpolator<'a, 2, 3>;

impl<'a, const D: usize, const N: usize> Interpolator<'a, D, N>
where
    Euclidean: StolenMeasures<D, N>,
{
    /// Creates an interpolator for values at the points of a mesh, one per point. Those of
    /// duplicates are not used.
    ///
    /// # Errors
    ///
    /// [`Error::ValueCount`] if there are not as many values as points.
    pub fn new(locator: &'a Locator<'a, D, N>, values: &'a [f64]) -> Result<Self, Error> {
        let points = locator.complex.points().len();
        if values.len() != points {
            return Err(Error::ValueCount { values: values.len(), points });
        }
        Ok(Interpolator { locator, values })
    }

    /// Returns the interpolated value at a point; NaN outside the hull.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`], or [`Error::BrokenMesh`] as for [`Locator::locate`].
    pub fn interpolate(&self, method: Interpolation, query: [f64; D]) -> Result<f64, Error> {
        Points::F64(&[query]).validate()?;
        let Some(place) = self.locator.place(query)? else { return Ok(f64::NAN) };
        Ok(self.value_at(method, query, place, &mut State::default()))
    }

    /// Returns the interpolated value at each of many points; NaN outside the hull.
    ///
    /// # Errors
    ///
    /// The same as for [`interpolate`](Self::interpolate).
    pub fn interpolate_many<'q>(
        &self,
        method: Interpolation,
        queries: impl Into<Points<'q, D>>,
    ) -> Result<Vec<f64>, Error> {
        map_along_curve(queries.into(), self.locator.key, |run| {
            let mut state = State::default();
            let Some(places) = self.locator.places(run)? else { return Ok(vec![f64::NAN; run.len()]) };
            Ok(run.iter().zip(places).map(|(&query, place)| self.value_at(method, query, place, &mut state)).collect())
        })
    }

    /// Returns the vertices whose values are interpolated at a point, with their weights, which are
    /// not negative and have the sum 1; `None` outside the hull.
    ///
    /// # Errors
    ///
    /// The same as for [`interpolate`](Self::interpolate).
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Interpolation, Interpolator, Locator};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// let locator = Locator::new(&mesh, &points)?;
    /// let interpolator = Interpolator::new(&locator, &[0.0; 3])?;
    /// let mut weights = interpolator.weights(Interpolation::Linear, [1.0, 2.0])?.unwrap();
    /// weights.sort_by_key(|&(vertex, _)| vertex);
    /// assert_eq!(weights, [(0, 0.25), (1, 0.25), (2, 0.5)]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn weights(&self, method: Interpolation, query: [f64; D]) -> Result<Option<Vec<(u32, f64)>>, Error> {
        Points::F64(&[query]).validate()?;
        let mut state = State::default();
        let Some(place) = self.locator.place(query)? else { return Ok(None) };
        Ok(self.find_weights(method, query, place, &mut state).then_some(state.weights))
    }

    fn value_at(&self, method: Interpolation, query: [f64; D], place: Place, state: &mut State<D>) -> f64 {
        if !self.find_weights(method, query, place, state) {
            return f64::NAN;
        }
        // A weight of 0 does not spread NaN and infinities.
        let terms = state.weights.iter().filter(|&&(_, weight)| weight != 0.0);
        terms.map(|&(vertex, weight)| weight * self.values[vertex as usize]).sum()
    }

    /// Puts the weights at a point into `state`, or returns `false` outside the hull.
    fn find_weights(&self, method: Interpolation, query: [f64; D], place: Place, state: &mut State<D>) -> bool {
        let State { scratch, weights } = state;
        weights.clear();
        let Place { simplex, beyond: None, on_facet } = place else { return false };
        let vertices = self.locator.complex.simplices[simplex];
        if on_facet && let Some(vertex) = vertices.into_iter().find(|&v| self.locator.complex.point(v) == query) {
            weights.push((vertex, 1.0));
            return true;
        }
        match method {
            Interpolation::Linear => {}
            _ => natural::weights(self.locator, method, query, (simplex, on_facet), scratch, weights),
        }
        // Also where the Voronoi cell of the point is too long, because the hull is too near.
        if weights.is_empty() {
            let shares = barycentric(&self.locator.complex.corners(simplex), query);
            weights.extend(vertices.into_iter().zip(shares));
        }
        true
    }
}

/// Memory that is used again from one point to the next.
struct State<const D: usize> {
    scratch: Scratch<D>,
    weights: Vec<(u32, f64)>,
}

impl<const D: usize> Default for State<D> {
    fn default() -> Self {
        State { scratch: Scratch::default(), weights: Vec::new() }
    }
}
