//! What weights change in a diagram: bisectors and vertices.

use crate::{
    geometry::{Euclidean, Geometry, circumcenter, exact_power_center_offset, power_center_offset, vector},
    input::points::Points,
};
use std::borrow::Cow;

/// The weights of sites, whose coordinates have been multiplied by a power of two.
#[derive(Debug)]
pub(super) struct Weights<'a> {
    /// One per point, as they were given; none without weights.
    pub(super) given: Cow<'a, [f64]>,
    /// The power of two.
    pub(super) scale: f64,
}

impl Weights<'_> {
    pub(super) fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// Returns the weight of `v` minus that of `w`, times the square of the power of two; infinite beyond the range of
    /// `f64`. It is subtracted first: weights that are far above the range may be equal.
    fn difference(&self, v: u32, w: u32) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        (self.given[v as usize] - self.given[w as usize]) * self.scale * self.scale
    }

    /// Returns the product of the points of the bisector of two sites, relative to `v`, with the vector from `v` to
    /// `w`.
    pub(super) fn bisector<const D: usize>(&self, v: u32, w: u32, to: [f64; D]) -> f64 {
        0.5 * (vector::squared_norm(to) + self.difference(v, w))
    }

    /// Returns the point with the same distance to all vertices of a simplex, with these scaled coordinates; `points`
    /// are as they were given.
    pub(super) fn center<const D: usize, const N: usize>(
        &self,
        simplex: &[u32; N],
        corners: &[[f64; D]; N],
        points: Points<'_, D>,
    ) -> [f64; D]
    where
        Euclidean: Geometry<D, N>,
    {
        if self.is_empty() {
            return circumcenter(corners);
        }
        let differences = std::array::from_fn(|k| self.difference(simplex[k + 1], simplex[0]));
        let offset = power_center_offset(corners, differences, || {
            let (given, weights) = self.of(simplex, points);
            exact_power_center_offset(&given, &weights, libm::ilogb(self.scale))
        });
        vector::plus(corners[0], offset)
    }

    /// Returns whether a vertex of a simplex next to this one has the same distance to the centre of this one as its
    /// vertices.
    pub(super) fn is_tied<const D: usize, const N: usize>(
        &self,
        simplex: &[u32; N],
        w: u32,
        points: Points<'_, D>,
    ) -> bool
    where
        Euclidean: Geometry<D, N>,
    {
        let (corners, weights) = self.of(simplex, points);
        let apex = points.get(w as usize);
        if self.is_empty() {
            return Euclidean::in_sphere(&corners, apex) == 0;
        }
        Euclidean::is_below(&corners, &weights, (apex, self.given[w as usize])) == 0
    }

    /// Returns the coordinates and weights of the vertices of a simplex.
    fn of<const D: usize, const N: usize>(
        &self,
        simplex: &[u32; N],
        points: Points<'_, D>,
    ) -> ([[f64; D]; N], [f64; N]) {
        let weight = |v: u32| self.given.get(v as usize).copied().unwrap_or(0.0);
        (simplex.map(|v| points.get(v as usize)), simplex.map(weight))
    }
}
