//! What weights change: the bounds of errors, and the exact stage.

use crate::predicates::filter::{
    EPSILON, ERROR_BOUNDS, ExactStage, PredicateContext, PredicatesAt, Scale, UNDERFLOW, WIDER, in_sphere_bound, minus,
};
use crate::{
    input::{lattice::Lattice, points::Points},
    parallel::{self, Threads},
    predicates::{Sign, exact},
};
use std::sync::Arc;

/// By dimension: the maximum roundoff of the in-sphere determinants with weights, as multiples of their
/// permanents. Beside [`ERROR_BOUNDS`], each product has one rounding more: that of the subtraction of a difference of weights. What contains that difference is rounded less often. The second-order
/// terms are bounded as above, with room.
const WEIGHTED_BOUNDS: [f64; 4] = [0.0, 0.0, (12.0 + 1024.0 * EPSILON) * EPSILON, (17.0 + 1024.0 * EPSILON) * EPSILON];

/// Added to every error bound with weights, 2⁻⁸⁰⁰: as [`UNDERFLOW`]. Later factors may be larger there, by the largest scaled weight.
const WEIGHTED_UNDERFLOW: f64 = f64::from_bits((1023 - 800) << 52);

/// Scaled weights above this, 2¹²⁵, are NaN, so that no filter decides.
const MAX_WEIGHT: f64 = f64::from_bits((1023 + 125) << 52);

/// Weights that are lattice integers of more bits than this are not taken as integers, so that sums with squared
/// distances fit into 127 bits.
pub(super) const WEIGHT_BITS: u32 = 125;

/// The weights of points; none without weights.
#[derive(Clone, Default)]
pub(super) struct Weights<'a> {
    /// One per point of the input.
    pub(super) input: &'a [f64],
    /// Those of the vertices, times the square of the coordinates' power of two.
    pub(super) scaled: Arc<Vec<f64>>,
}

/// Returns the maximum roundoff of an in-sphere determinant, as a multiple of its permanent.
pub(super) const fn in_sphere_error<const D: usize, const W: bool>() -> f64 {
    if W { WEIGHTED_BOUNDS[D] } else { ERROR_BOUNDS[D].in_sphere }
}

/// Returns what is added to the bounds of errors of in-sphere determinants.
pub(super) const fn underflow<const W: bool>() -> f64 {
    if W { WEIGHTED_UNDERFLOW } else { UNDERFLOW }
}

impl<'a, const D: usize> PredicateContext<'a, D, true> {
    /// Creates a context of weighted points, one finite weight for each, in which vertex *v* is point `indices[v]` of
    /// the input, by `threads`. The lattice must be [fitted](Lattice::fit_weighted) to both.
    pub(crate) fn weighted_by(
        threads: Threads,
        input: Points<'a, D>,
        weights: &'a [f64],
        lattice: &Lattice<D>,
        indices: Vec<u32>,
    ) -> Self {
        let mut context = PredicateContext::of_weighted(input, weights, lattice);
        context.store(threads, indices);
        context.store_weights(threads);
        context
    }

    /// Stores the weights of the vertices, and the bound that depends on them.
    fn store_weights(&mut self, threads: Threads) {
        // Times the square of the power of two that coordinates are multiplied by.
        let more = if let ExactStage::Narrow = self.exact { 0 } else { WIDER as i32 };
        let exponent = 2 * (self.lattice.exponent() - more);
        let scale = Scale::new(exponent);
        let is_in_range = exponent.abs() <= 2000;
        let scaled = |w: f64| {
            let scaled = scale.apply(w);
            if is_in_range && scaled.abs() <= MAX_WEIGHT { scaled } else { f64::NAN }
        };
        let mut weights: Vec<f64> = bytemuck::zeroed_vec(self.indices.len());
        parallel::for_chunks(threads, &mut weights, |start, chunk| {
            for (weight, &i) in chunk.iter_mut().zip(&self.indices[start..]) {
                *weight = scaled(self.weights.input[i as usize]);
            }
        });
        let all = weights.iter().fold([f64::INFINITY, f64::NEG_INFINITY, 0.0], |[low, high, zero], &w| {
            [if w < low { w } else { low }, if w > high { w } else { high }, zero + 0.0 * w]
        });
        let [low, high, zero] = all;
        let [low_corner, high_corner] = self.lattice.bounds().map(|corner| self.scaled(corner));
        let extents = minus(high_corner, low_corner);
        // NaN if a weight is.
        self.in_sphere_bound = in_sphere_bound::<D, true>(extents, high - low + zero);
        if self.in_sphere_bound.is_nan() {
            self.in_sphere_bound = f64::INFINITY;
        }
        self.weights.scaled = Arc::new(weights);
    }
}

impl<const D: usize, const W: bool> PredicatesAt<'_, '_, D, W> {
    /// Returns the difference of the scaled weights of `v` and of the vertex; 0 without weights.
    #[inline(always)]
    pub(super) fn weight_to(&self, v: u32) -> f64 {
        if !W {
            return 0.0;
        }
        let weights = self.context.weights.scaled.as_slice();
        weights[v as usize] - weights[self.vertex as usize]
    }
}

impl<const D: usize, const W: bool> PredicateContext<'_, D, W> {
    /// Returns the sign of the in-sphere or in-circle determinant of these vertices with their weights: by `integers` of
    /// fixed size, given the coordinates and the weights, or by those of any size. Ties remain.
    #[inline(never)]
    pub(super) fn power_sign<const N: usize>(
        &self,
        vertices: [u32; N],
        integers: fn([[i64; D]; N], [i128; N]) -> Sign,
    ) -> Sign {
        let positions = match &self.exact {
            ExactStage::Narrow => Some(vertices.map(|v| self.narrow(v))),
            ExactStage::Wide(wide) => self.wide(wide, vertices),
        };
        let weights = vertices.map(|v| self.weights.input[self.input_index(v) as usize]);
        match positions {
            Some(positions) => {
                self.count(|c| &mut c.integer);
                // None of them is rounded, or there would be no positions.
                integers(positions, weights.map(|w| self.lattice.weight(w, WEIGHT_BITS).unwrap_or(0)))
            }
            None => {
                self.count(|c| &mut c.expansion);
                exact::power_sign(vertices.map(|v| self.point(v)), weights)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::symbolic::{break_tie, without};
    use proptest::prelude::*;

    /// Returns a context of weighted points, in an order that differs from the input's, for the ties.
    fn context<'a, const D: usize>(points: &'a [[f64; D]], weights: &'a [f64]) -> PredicateContext<'a, D, true> {
        let lattice = Lattice::fit_weighted(Threads::One, Points::F64(points), weights).unwrap();
        let indices = (0..points.len() as u32).rev().collect();
        PredicateContext::weighted_by(Threads::One, Points::F64(points), weights, &lattice, indices)
    }

    /// Checks that every sign for the first five points agrees with the exact one.
    fn agree3(points: [[f64; 3]; 5], weights: [f64; 5]) -> Result<(), TestCaseError> {
        let vertices = context(&points, &weights);
        let names = [4, 3, 2, 1, 0];
        let expected = |[a, b, c, d, e]: [u32; 5]| {
            let all = [a, b, c, d, e].map(|v| names[v as usize] as usize);
            match exact::power_sign(all.map(|i| points[i]), all.map(|i| weights[i])) {
                0 => break_tie(all.map(|i| i as u32), |k| {
                    let [a, b, c, d] = without(all, k).map(|i: usize| points[i]);
                    exact::orient3d(a, b, c, d)
                }),
                sign => sign,
            }
        };
        for at in 0..5 {
            let here = vertices.at(at);
            let [a, b, c, d] = [1, 2, 3, 4].map(|k| (at + k) % 5);
            let sign = expected([a, b, c, d, at]);
            prop_assert_eq!(vertices.insphere([a, b, c, d], at), sign);
            prop_assert_eq!(vertices.insphere([b, a, c, d], at), -sign);
            let rows = [a, b, c].map(|v| here.row(v));
            let (det, is_certain) = here.insphere_of_rows(rows.each_ref(), d);
            let from_det = if det > 0.0 { 1 } else { -1 };
            prop_assert!(!is_certain || from_det == sign, "{det}, {sign}");
            prop_assert_eq!(here.insphere_again(det, rows.each_ref(), [a, b, c, d], 3), sign);
        }
        Ok(())
    }

    /// Checks that every sign for the first four points agrees with the exact one.
    fn agree2(points: [[f64; 2]; 4], weights: [f64; 4]) -> Result<(), TestCaseError> {
        let vertices = context(&points, &weights);
        let names = [3, 2, 1, 0];
        for at in 0..4 {
            let [a, b, c] = [1, 2, 3].map(|k| (at + k) % 4);
            let all = [a, b, c, at].map(|v| names[v as usize] as usize);
            let sign = match exact::power_sign(all.map(|i| points[i]), all.map(|i| weights[i])) {
                0 => break_tie(all.map(|i| i as u32), |k| {
                    let [a, b, c] = without(all, k).map(|i: usize| points[i]);
                    exact::orient2d(a, b, c)
                }),
                sign => sign,
            };
            prop_assert_eq!(vertices.incircle([a, b, c], at), sign);
            prop_assert_eq!(vertices.incircle([b, a, c], at), -sign);
        }
        Ok(())
    }

    /// Weights that nearly flatten the lifted points: |p|², off by some steps of rounding.
    fn flattening<const D: usize, const N: usize>(points: [[f64; D]; N], steps: [i64; N]) -> [f64; N] {
        std::array::from_fn(|i| {
            let square: f64 = points[i].iter().map(|x| x * x).sum();
            f64::from_bits((square + 1.0).to_bits().wrapping_add_signed(steps[i]))
        })
    }

    fn coordinate() -> impl Strategy<Value = f64> + Clone {
        prop_oneof![
            (-3i32..4).prop_map(f64::from),
            (-9i32..10, -1i64..2)
                .prop_map(|(x, nudge)| f64::from_bits((f64::from(x) + 0.1).to_bits().wrapping_add_signed(nudge))),
            -1.0..1.0f64,
        ]
    }

    fn weight() -> impl Strategy<Value = f64> + Clone {
        prop_oneof![
            (-3i32..4).prop_map(f64::from),
            -1.0..1.0f64,
            (-9i32..10, -1070i32..1020).prop_map(|(m, e)| libm::ldexp(m.into(), e))
        ]
    }

    fn any_finite() -> impl Strategy<Value = f64> + Clone {
        prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn usual_sizes(
            points in prop::array::uniform5(prop::array::uniform3(coordinate())),
            weights in prop::array::uniform5(weight()),
        ) {
            agree3(points, weights)?;
        }

        #[test]
        fn flat_when_lifted(
            points in prop::array::uniform5(prop::array::uniform3(coordinate())),
            steps in prop::array::uniform5(-2i64..3),
        ) {
            agree3(points, flattening(points, steps))?;
        }

        #[test]
        fn any_size(
            points in prop::array::uniform5(prop::array::uniform3(any_finite())),
            weights in prop::array::uniform5(any_finite()),
        ) {
            agree3(points, weights)?;
        }

        #[test]
        fn usual_sizes_in_2d(
            points in prop::array::uniform4(prop::array::uniform2(coordinate())),
            weights in prop::array::uniform4(weight()),
        ) {
            agree2(points, weights)?;
        }

        #[test]
        fn flat_when_lifted_in_2d(
            points in prop::array::uniform4(prop::array::uniform2(coordinate())),
            steps in prop::array::uniform4(-2i64..3),
        ) {
            agree2(points, flattening(points, steps))?;
        }

        #[test]
        fn any_size_in_2d(
            points in prop::array::uniform4(prop::array::uniform2(any_finite())),
            weights in prop::array::uniform4(any_finite()),
        ) {
            agree2(points, weights)?;
        }

        /// The largest coordinates and weights of the lattice's integers.
        #[test]
        fn corners_of_the_wide_lattice(
            points in prop::array::uniform5(prop::array::uniform3(prop::sample::select(vec![0.0, 1.0, 4e18, 4.611686018427386e18]))),
            weights in prop::array::uniform5(prop::sample::select(vec![0.0, 1.0, -1.0, 4.25e37, -4.25e37, 2.1e37, 9e18])),
        ) {
            agree3(points, weights)?;
        }
    }
}
