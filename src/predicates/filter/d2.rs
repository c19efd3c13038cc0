//! The 2D predicates.

use crate::predicates::filter::{
    EPSILON, ERROR_BOUNDS, ExactStage, PredicateContext, PredicatesAt, UNDERFLOW, greatest, minus,
    weights::{in_sphere_error, underflow},
};
use crate::predicates::{Sign, exact, integer, symbolic};

impl<const W: bool> PredicatesAt<'_, '_, 2, W> {
    /// Returns the context's `orient2d` with the vertex as c.
    #[inline]
    pub(crate) fn orient2d(&self, a: u32, b: u32) -> Sign {
        let vertices = [a, b, self.vertex];
        if self.stored.is_empty() {
            return self.context.orient2d_computed(vertices);
        }
        let [u, v] = [a, b].map(|v| minus(self.stored[v as usize], self.place));
        self.context.orient2d_of(vertices, u, v)
    }

    /// Returns the context's `incircle` with the vertex as d.
    #[inline]
    pub(crate) fn incircle(&self, [a, b, c]: [u32; 3]) -> Sign {
        let vertices = [a, b, c, self.vertex];
        if self.stored.is_empty() {
            return self.context.incircle_computed(vertices);
        }
        let differences = [a, b, c].map(|v| minus(self.stored[v as usize], self.place));
        if W {
            return self.context.power_of(vertices, differences, [a, b, c].map(|v| self.weight_to(v)));
        }
        self.context.incircle_of(vertices, differences)
    }

    /// Returns whether the vertex, which is collinear with the different points a and b, lies
    /// strictly between them.
    pub(crate) fn is_between(&self, a: u32, b: u32) -> bool {
        let [a, p, b] = [a, self.vertex, b].map(|v| self.context.point(v));
        (a < p && p < b) || (b < p && p < a)
    }
}

impl<const W: bool> PredicateContext<'_, 2, W> {
    /// Returns the sign of det(b − a, c − a): positive if a, b, c turn counter-clockwise, the *y*
    /// axis pointing up.
    #[inline]
    pub fn orient2d(&self, a: u32, b: u32, c: u32) -> Sign {
        self.at(c).orient2d(a, b)
    }

    #[inline(never)]
    fn orient2d_computed(&self, vertices: [u32; 3]) -> Sign {
        let [pa, pb, pc] = vertices.map(|v| self.computed(v));
        self.orient2d_of(vertices, minus(pa, pc), minus(pb, pc))
    }

    /// Returns the sign, from the differences to the last vertex.
    #[inline(always)]
    fn orient2d_of(&self, vertices: [u32; 3], u: [f64; 2], v: [f64; 2]) -> Sign {
        let det = u[0] * v[1] - u[1] * v[0];
        if det.abs() > self.orientation_bound {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.orient2d_unfiltered(vertices, u, v)
    }

    #[inline(never)]
    fn orient2d_unfiltered(&self, vertices: [u32; 3], u: [f64; 2], v: [f64; 2]) -> Sign {
        let (left, right) = (u[0] * v[1], u[1] * v[0]);
        let det = left - right;
        if det.abs() > ERROR_BOUNDS[2].orientation * (left.abs() + right.abs()) + UNDERFLOW {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.orient2d_exact(vertices)
    }

    fn orient2d_exact(&self, vertices: [u32; 3]) -> Sign {
        match &self.exact {
            ExactStage::Narrow => {
                self.count(|c| &mut c.integer);
                let [a, b, c] = vertices.map(|v| self.narrow(v));
                integer::orient2d_narrow(a, b, c)
            }
            ExactStage::Wide(wide) => match self.wide(wide, vertices) {
                Some([a, b, c]) => {
                    self.count(|c| &mut c.integer);
                    integer::orient2d_wide(a, b, c)
                }
                None => {
                    self.count(|c| &mut c.expansion);
                    let [a, b, c] = vertices.map(|v| self.point(v));
                    exact::orient2d(a, b, c)
                }
            },
        }
    }

    /// Returns the sign of the in-circle determinant: positive if d lies inside the circle through
    /// the counter-clockwise a, b, c. Ties are broken symbolically: never zero for four different
    /// vertices of which at least three are not collinear.
    #[inline]
    pub fn incircle(&self, [a, b, c]: [u32; 3], d: u32) -> Sign {
        self.at(d).incircle([a, b, c])
    }

    #[inline(never)]
    fn incircle_computed(&self, vertices: [u32; 4]) -> Sign {
        let [pa, pb, pc, pd] = vertices.map(|v| self.computed(v));
        self.incircle_of(vertices, [pa, pb, pc].map(|p| minus(p, pd)))
    }

    /// Returns the sign, from the differences to the last vertex.
    #[inline(always)]
    fn incircle_of(&self, vertices: [u32; 4], [a, b, c]: [[f64; 2]; 3]) -> Sign {
        let minor = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let lifts = [a, b, c].map(lift);
        let det = lifts[0] * minor(b, c) + lifts[1] * minor(c, a) + lifts[2] * minor(a, b);
        if det.abs() > self.in_sphere_bound || det.abs() > local_bound::<false>(greatest(lifts)) {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.incircle_unfiltered(vertices, [a, b, c], det)
    }

    #[inline(never)]
    fn incircle_unfiltered(&self, vertices: [u32; 4], differences: [[f64; 2]; 3], det: f64) -> Sign {
        if is_incircle_certain::<false>(det, differences, differences.map(lift)) {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.incircle_exact(vertices)
    }

    /// Returns the sign with weights, from the differences to the last vertex and to its weight.
    #[inline(always)]
    fn power_of(&self, vertices: [u32; 4], [a, b, c]: [[f64; 2]; 3], weights: [f64; 3]) -> Sign {
        let minor = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
        let squares = [a, b, c].map(lift);
        let lifts: [f64; 3] = std::array::from_fn(|k| squares[k] - weights[k]);
        let magnitudes: [f64; 3] = std::array::from_fn(|k| squares[k] + weights[k].abs());
        let det = lifts[0] * minor(b, c) + lifts[1] * minor(c, a) + lifts[2] * minor(a, b);
        if det.abs() > self.in_sphere_bound || det.abs() > local_bound::<true>(greatest(magnitudes)) {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.power_unfiltered(vertices, [a, b, c], magnitudes, det)
    }

    #[inline(never)]
    fn power_unfiltered(&self, vertices: [u32; 4], differences: [[f64; 2]; 3], magnitudes: [f64; 3], det: f64) -> Sign {
        if is_incircle_certain::<true>(det, differences, magnitudes) {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.incircle_exact(vertices)
    }

    /// Returns the sign by integers or expansions, and ties symbolically.
    #[inline(always)]
    fn incircle_exact(&self, vertices: [u32; 4]) -> Sign {
        let sign = match &self.exact {
            _ if W => self.power_sign(vertices, integer::power2d),
            ExactStage::Narrow => {
                self.count(|c| &mut c.integer);
                let [a, b, c, d] = vertices.map(|v| self.narrow(v));
                integer::incircle_narrow(a, b, c, d)
            }
            ExactStage::Wide(wide) => match self.wide(wide, vertices) {
                Some([a, b, c, d]) => {
                    self.count(|c| &mut c.integer);
                    match &wide.stretched {
                        None => integer::incircle_wide(a, b, c, d),
                        Some(stretched) => integer::incircle_stretched(a, b, c, d, stretched.shifts),
                    }
                }
                None => {
                    self.count(|c| &mut c.expansion);
                    let [a, b, c, d] = vertices.map(|v| self.point(v));
                    exact::incircle(a, b, c, d)
                }
            },
        };
        if sign != 0 {
            return sign;
        }
        self.count(|c| &mut c.symbolic);
        symbolic::break_tie(vertices.map(|v| self.rank(v)), |k| {
            let [a, b, c] = symbolic::without(vertices, k);
            self.orient2d(a, b, c)
        })
    }
}

/// Returns whether the value of an in-circle determinant of these differences and the magnitudes of lifts has its sign.
#[inline(always)]
fn is_incircle_certain<const W: bool>(det: f64, [a, b, c]: [[f64; 2]; 3], [ma, mb, mc]: [f64; 3]) -> bool {
    let permanent = |p: [f64; 2], q: [f64; 2]| (p[0] * q[1]).abs() + (p[1] * q[0]).abs();
    let permanent = ma * permanent(b, c) + mb * permanent(c, a) + mc * permanent(a, b);
    det.abs() > in_sphere_error::<2, W>() * permanent + underflow::<W>()
}

/// Returns a bound of an in-circle determinant's error, from the greatest squared distance *L* of
/// its three points to the fourth: the permanent of two vectors is at most the product of their
/// lengths, so that of the determinant is at most 3·L². The last factor covers the roundings in the
/// bound itself. With weights, *L* is the greatest sum of a squared distance and the magnitude of a difference of
/// weights.
#[inline]
fn local_bound<const W: bool>(greatest_lift: f64) -> f64 {
    let factor = const { 3.0 * in_sphere_error::<2, W>() * (1.0 + 64.0 * EPSILON) };
    factor * (greatest_lift * greatest_lift) + underflow::<W>()
}

/// Returns the squared distance from the origin.
#[inline]
fn lift(p: [f64; 2]) -> f64 {
    p[0] * p[0] + p[1] * p[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        input::lattice::Lattice,
        predicates::filter::{PredicateContext2, Scale},
    };
    use proptest::prelude::*;

    /// Checks that every sign of a `PredicateContext2` for the first four points agrees with the
    /// exact predicates on `f64`.
    fn agree(points: &[[f64; 2]]) -> Result<(), TestCaseError> {
        let lattice = Lattice::fit(points.into());
        // An order that differs from the input's, for the ties.
        let indices: Vec<u32> = (0..points.len() as u32).rev().collect();
        let vertices = PredicateContext2::new(points.into(), &lattice, indices);
        let p = |v: u32| points[vertices.input_index(v) as usize];
        let sign = exact::orient2d(p(0), p(1), p(2));
        prop_assert_eq!(vertices.orient2d(0, 1, 2), sign);
        prop_assert_eq!(vertices.orient2d(1, 0, 2), -sign);
        prop_assert_eq!(vertices.orient2d_exact([0, 1, 2]), sign);
        let four = [0, 1, 2, 3].map(|v| (vertices.input_index(v), p(v)));
        prop_assert_eq!(vertices.incircle([0, 1, 2], 3), gdel_reference::incircle_symbolic(four));
        Ok(())
    }

    fn near(exponent: std::ops::RangeInclusive<i32>) -> impl Strategy<Value = f64> + Clone {
        (-9i32..10, exponent, -1i32..2).prop_map(|(m, e, nudge)| {
            let x = f64::from(m) * 2f64.powi(e);
            if nudge == 0 || x == 0.0 { x } else { f64::from_bits(x.to_bits().wrapping_add_signed(nudge.into())) }
        })
    }

    fn four(coordinate: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = [[f64; 2]; 4]> {
        prop::array::uniform4(prop::array::uniform2(coordinate))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn small_grid(points in four((-3i32..4).prop_map(f64::from))) { agree(&points)?; }

        #[test]
        fn narrow(points in four((-(1i32 << 30)..1 << 30).prop_map(f64::from))) { agree(&points)?; }

        #[test]
        fn corners_of_the_narrow_lattice(points in four(prop::sample::select(vec![0.0, 1.0, 2147483646.0, 2147483647.0]))) {
            agree(&points)?;
        }

        #[test]
        fn corners_of_the_wide_lattice(points in four(prop::sample::select(vec![0.0, 1.0, 4e18, 4.611686018427386e18]))) {
            agree(&points)?;
        }

        #[test]
        fn nudged(points in four(near(0..=0))) { agree(&points)?; }

        #[test]
        fn axes_of_different_ranges(
            points in prop::array::uniform4(prop::array::uniform2(-4i32..5)),
            scales in prop::array::uniform2(prop::sample::select(vec![1.0, 1e-3, 1e-5, 1e6, 1e12, 1e40])),
        ) {
            agree(&points.map(|p| std::array::from_fn::<f64, 2, _>(|axis| f64::from(p[axis]) * scales[axis])))?;
        }

        #[test]
        fn mixed_exponents(points in four(near(-40..=4))) { agree(&points)?; }

        #[test]
        fn any_finite(points in four(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO)) {
            agree(&points)?;
        }

        #[test]
        fn cocircular(points in prop::array::uniform4((0usize..1 << 20).prop_map(|i| {
            // Integer points at 65 from the origin.
            let corners = [[0, 65], [16, 63], [25, 60], [33, 56], [39, 52]];
            let mut p = corners[i % 5].map(f64::from);
            p.rotate_left(i / 5 % 2);
            for (axis, x) in p.iter_mut().enumerate() {
                if i >> (5 + axis) & 1 == 1 { *x = -*x; }
            }
            p
        })), scale in -1100i32..900, nudge: bool) {
            let mut points = points.map(|p| p.map(|x| Scale::new(scale).apply(x)));
            if nudge { points[2][0] = points[2][0].next_up(); }
            agree(&points)?;
        }
    }
}
