//! Values outside the hull.

use super::{Interpolator, Outside, StolenMeasures};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet, vector},
};
use rustc_hash::FxHashSet;

impl<const D: usize, const N: usize> Interpolator<'_, D, N>
where
    Euclidean: StolenMeasures<D, N>,
{
    /// Appends the weights at a query outside the hull, which facet `k` of simplex `t` sees; none where
    /// there is a constant.
    pub(super) fn weights_outside(
        &self,
        query: [f64; D],
        (t, k): (usize, usize),
        weights: &mut Vec<(u32, f64)>,
    ) -> Result<(), Error> {
        let locator = self.locator;
        let simplices = &locator.complex.simplices;
        match self.outside {
            Outside::Value(_) => {}
            Outside::Nearest => {
                weights.push((locator.nearest_to(query, simplices[t][0])?, 1.0));
            }
            Outside::Linear => {
                let ((t, k), shares) = locator.nearest_facet(query, (t, k));
                let vertices = facet(&simplices[t], k);
                let corners = facet(&locator.complex.corners(t), k);
                // From the nearest place to the query.
                let ways = shares.iter().zip(corners);
                let way = ways.fold([0.0; D], |way, (&share, corner)| {
                    vector::plus(way, vector::times(share, vector::minus(query, corner)))
                });
                weights.extend(vertices.into_iter().zip(shares));
                for (v, share) in vertices.into_iter().zip(shares).filter(|&(_, share)| share > 0.0) {
                    self.add_gradient(v, t, vector::times(share, way), weights);
                }
                weights.sort_unstable_by_key(|&(v, _)| v);
                weights.dedup_by(|(v, more), (before, weight)| {
                    let is_same = v == before;
                    *weight += if is_same { *more } else { 0.0 };
                    is_same
                });
            }
        }
        Ok(())
    }

    /// Appends the weights of the change of value along a way, by the gradient at vertex `v` of simplex
    /// `t`.
    ///
    /// In a simplex, the share of a vertex falls along the outward normal of the facet opposite it; in
    /// units of the volume, the gradient is that normal. So their sums are those of the mean, and no
    /// simplex, however flat, makes them large.
    fn add_gradient(&self, v: u32, t: usize, way: [f64; D], weights: &mut Vec<(u32, f64)>) {
        let complex = &self.locator.complex;
        let scaled = |p| vector::times(self.locator.scale, p);
        let way = scaled(way);
        let (mut around, mut seen) = (vec![t], FxHashSet::from_iter([t]));
        let (start, mut volume) = (weights.len(), 0.0);
        while let Some(t) = around.pop() {
            let simplex = complex.simplices[t];
            let corners = complex.corners(t).map(scaled);
            let mut edges = [[0.0; D]; D];
            for (edge, &corner) in edges.iter_mut().zip(&corners[1..]) {
                *edge = vector::minus(corner, corners[0]);
            }
            volume += Euclidean::determinant(&edges).abs();
            for (k, &vertex) in simplex.iter().enumerate() {
                let normal = <Euclidean as Geometry<D, N>>::facet_normal(&facet(&corners, k));
                weights.push((vertex, -vector::dot(normal, way)));
                let next = if vertex == v { None } else { complex.across(t, k) };
                around.extend(next.filter(|&next| seen.insert(next)));
            }
        }
        for (_, weight) in &mut weights[start..] {
            *weight /= volume;
        }
    }
}
