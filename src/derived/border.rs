//! Queries that are outside the convex hull by no more than coordinates are rounded.
//!
//! The box around such a query meets the hull: it reaches as far along each axis as [`REACH`] times
//! the largest coordinate of that axis, rounded to `f64`. Exact signs at the corners of the box
//! decide that, so that what counts as inside does not depend on the way of a walk.

use super::{
    Locator,
    locate::{Beyond, Place},
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    input::points::Points,
    predicates::exact,
};
use rustc_hash::FxHashSet;

/// The reach of the box around a query in double precision, relative to the largest coordinate: four
/// units in its last place. A rotation of points and queries moves them by up to three.
const REACH: f64 = 4.0 * f64::EPSILON;

/// The reach where points or queries are in single precision.
const SINGLE_REACH: f64 = 4.0 * f32::EPSILON as f64;

/// Returns how far the box around a query reaches along each axis, for points within `bounds`.
fn reach_of<const D: usize>([low, high]: [[f64; D]; 2], is_single: bool) -> [f64; D] {
    let share = if is_single { SINGLE_REACH } else { REACH };
    // There are no bounds without points.
    std::array::from_fn(|axis| (low[axis].abs().max(high[axis].abs()) * share).min(f64::MAX))
}

/// The box around a query.
pub(super) struct Around<const D: usize> {
    low: [f64; D],
    high: [f64; D],
}

impl<const D: usize> Around<D> {
    pub(super) fn new(query: [f64; D], reach: [f64; D]) -> Self {
        let corner =
            |sign: f64| std::array::from_fn(|axis| (query[axis] + sign * reach[axis]).clamp(f64::MIN, f64::MAX));
        Around { low: corner(-1.0), high: corner(1.0) }
    }

    pub(super) fn corners(&self) -> impl Iterator<Item = [f64; D]> + Clone {
        (0..1 << D).map(|bits: u32| {
            std::array::from_fn(|axis| if bits >> axis & 1 == 0 { self.low[axis] } else { self.high[axis] })
        })
    }

    /// Returns whether the box is on the outer side of a facet's plane, all of it.
    fn is_beyond<const N: usize>(&self, facet: &[[f64; D]; D]) -> bool
    where
        Euclidean: Geometry<D, N>,
    {
        self.corners().all(|corner| Euclidean::side(facet, corner) < 0)
    }

    /// Returns whether the box meets a facet whose plane it meets, or a segment as a triangle with two
    /// equal corners: no axis, nor in 3D the product of one with an edge, separates them.
    pub(super) fn meets(&self, facet: &[[f64; D]; D]) -> bool {
        let overlaps = |axis: usize| {
            facet.iter().any(|p| p[axis] <= self.high[axis]) && facet.iter().any(|p| p[axis] >= self.low[axis])
        };
        (0..D).all(overlaps) && (D == 2 || [[0, 1], [1, 2], [2, 0]].iter().all(|&axes| self.meets_along(facet, axes)))
    }

    /// Returns whether no edge of a triangle separates box and triangle as these axes see them.
    fn meets_along(&self, triangle: &[[f64; D]; D], axes: [usize; 2]) -> bool {
        let seen = |p: [f64; D]| axes.map(|axis| p[axis]);
        (0..D).all(|k| {
            let [from, to, third] = [k, k + 1, k + 2].map(|corner| seen(triangle[corner % D]));
            let side = exact::orient2d(from, to, third);
            let is_apart = |sign| self.corners().all(|corner| exact::orient2d(from, to, seen(corner)) == sign);
            !((side >= 0 && is_apart(-1)) || (side <= 0 && is_apart(1)))
        })
    }
}

impl<const D: usize, const N: usize> Locator<'_, D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Returns how far along each axis a query outside may be from the hull to count as inside.
    pub(super) fn reach(&self, queries: Points<'_, D>) -> Option<[f64; D]> {
        let is_single = [self.complex.points(), queries].iter().any(|points| matches!(points, Points::F32(_)));
        (!self.is_exact).then(|| reach_of(self.bounds, is_single))
    }

    /// Returns the place of a query outside the hull, which is beyond facet `k` of simplex `t`. Where the
    /// box around it meets the hull, that is a place of the box inside the hull or a facet that meets it.
    pub(super) fn place_near(
        &self,
        query: [f64; D],
        (t, k): (usize, usize),
        reach: [f64; D],
    ) -> Result<Place<D>, Error> {
        let beyond =
            |(t, k), near| Place { at: query, simplex: t, beyond: Some(Beyond { facet: k, near }), on_facet: false };
        let outside = beyond((t, k), false);
        let around = Around::new(query, reach);
        if around.is_beyond(&facet(&self.complex.corners(t), k)) {
            return Ok(outside);
        }
        for corner in around.corners() {
            let place = self.walk(corner, t)?;
            if place.beyond.is_none() {
                return Ok(place);
            }
        }
        // The hull may be thinner than the box. The facets that see the query hang together, and one
        // of them has the place of the hull that is nearest to it.
        let (mut pending, mut seen) = (vec![(t, k)], FxHashSet::from_iter([(t, k)]));
        let mut met: Option<([u32; D], (usize, usize))> = None;
        while let Some((t, k)) = pending.pop() {
            let corners = facet(&self.complex.corners(t), k);
            if Euclidean::side(&corners, query) >= 0 {
                continue;
            }
            if around.is_beyond(&corners) {
                return Ok(outside);
            }
            let vertices = facet(&self.complex.simplices[t], k);
            if around.meets(&corners) {
                let mut sorted = vertices;
                sorted.sort_unstable();
                let found = (sorted, (t, k));
                met = Some(met.map_or(found, |before| before.min(found)));
            }
            let next = vertices.into_iter().filter_map(|apex| self.complex.hull_neighbor((t, k), apex));
            pending.extend(next.filter(|&facet| seen.insert(facet)));
        }
        Ok(met.map_or(outside, |(_, facet)| beyond(facet, true)))
    }

    /// Returns the facet of the hull that is nearest to a query outside, with the shares of its vertices
    /// in the nearest place: found by steps to nearer facets from one that sees the query, up to rounding.
    pub(super) fn nearest_facet(&self, query: [f64; D], start: (usize, usize)) -> ((usize, usize), [f64; D]) {
        let nearest = |(t, k)| nearest_place(&facet(&self.complex.corners(t), k), query, self.scale);
        let (mut shares, mut least) = nearest(start);
        let mut best = start;
        let (mut pending, mut seen) = (vec![start], FxHashSet::from_iter([start]));
        while let Some((t, k)) = pending.pop() {
            for apex in facet(&self.complex.simplices[t], k) {
                let Some(next) = self.complex.hull_neighbor((t, k), apex).filter(|&next| seen.insert(next)) else {
                    continue;
                };
                let (other, distance) = nearest(next);
                if distance < least {
                    (best, shares, least) = (next, other, distance);
                    pending.clear();
                }
                // All around a vertex are as near.
                if distance == least {
                    pending.push(next);
                }
            }
        }
        (best, shares)
    }
}

/// Returns the shares of the corners of a facet in its place nearest to a query, and the square of the
/// distance times `scale`.
pub(super) fn nearest_place<const D: usize>(facet: &[[f64; D]; D], query: [f64; D], scale: f64) -> ([f64; D], f64) {
    let corners = facet.map(|p| vector::times(scale, vector::minus(p, query)));
    let distance = |shares: &[f64; D]| {
        let place = shares.iter().zip(corners).fold([0.0; D], |sum, (&s, p)| vector::plus(sum, vector::times(s, p)));
        vector::squared_norm(place)
    };
    let on_edge = |k: usize| {
        let (from, to) = (k, (k + 1) % D);
        let edge = vector::minus(corners[to], corners[from]);
        let part = -vector::dot(corners[from], edge) / vector::squared_norm(edge);
        let part = if part > 0.0 { part.min(1.0) } else { 0.0 };
        let mut shares = [0.0; D];
        (shares[from], shares[to]) = (1.0 - part, part);
        shares
    };
    let edges = (0..if D == 2 { 1 } else { D }).map(on_edge);
    let candidates = edges.chain((D == 3).then(|| shares_of_foot(&corners)).flatten());
    let all = candidates.map(|shares| (shares, distance(&shares)));
    all.min_by(|(_, a), (_, b)| a.total_cmp(b)).unwrap_or(([0.0; D], f64::NAN))
}

/// Returns the shares of the corners of a triangle in the foot of the perpendicular from the origin, if
/// that is inside the triangle.
fn shares_of_foot<const D: usize>(corners: &[[f64; D]; D]) -> Option<[f64; D]> {
    let [u, v] = [1, 2].map(|k| vector::minus(corners[k % D], corners[0]));
    let [a, b] = [u, v].map(|edge| -vector::dot(corners[0], edge));
    let [uu, uv, vv] = [vector::dot(u, u), vector::dot(u, v), vector::dot(v, v)];
    let determinant = uu * vv - uv * uv;
    let [s, t] = [(a * vv - b * uv) / determinant, (b * uu - a * uv) / determinant];
    let mut shares = [1.0 - s - t; D];
    (shares[1], shares[2 % D]) = (s, t);
    shares.iter().all(|&share| share >= 0.0).then_some(shares)
}

impl<const D: usize, const N: usize> super::complex::Complex<'_, D, N> {
    /// Returns the facet of the hull across the ridge of facet (t, k) opposite its vertex `apex`; `None`
    /// if the mesh is broken.
    pub(super) fn hull_neighbor(&self, (mut t, mut k): (usize, usize), apex: u32) -> Option<(usize, usize)> {
        // Turns around the ridge, from facet k of t through the others. The other facet at the ridge
        // is opposite `turn`.
        let mut turn = apex;
        for _ in 0..=self.simplices.len() {
            let leave = self.simplices[t].iter().position(|&v| v == turn)?;
            let next = self.neighbors[t][leave];
            if next == NONE {
                return Some((t, leave));
            }
            // The facet between them has the ridge and the vertex that was opposite the last facet.
            turn = self.simplices[t][k];
            k = self.facet_towards(next as usize, t);
            if k == N {
                return None;
            }
            t = next as usize;
        }
        None
    }
}
