//! What it costs that a facet belongs to the surface.
//!
//! A facet is cheap if its smallest sphere is large compared with the circumspheres on both sides
//! (Labatut, Pons and Keriven, *Robust and efficient surface reconstruction from range data*, 2009):
//! near a well sampled surface those are the facets on it.

use super::{super::complex::Complex, spheres::Spheres};
use crate::{
    geometry::{Euclidean, Geometry, facet, vector},
    parallel::{self, Threads},
};

/// What one vote weighs, and the most that half a facet costs less the least. Capacities are integers,
/// so that the least cut does not depend on the last bits of the spheres.
pub(super) const UNIT: i32 = 1000;

/// Returns the cost of each facet as its simplex sees it, from 1 to 2,000: 1 − cos φ, where φ is the
/// angle between the facet and the circumsphere. The cost of a facet is the larger one of both sides.
pub(super) fn costs<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, spheres: &Spheres<D>) -> Vec<[u16; N]>
where
    Euclidean: Geometry<D, N>,
{
    let mut costs = vec![[0; N]; complex.simplices.len()];
    parallel::for_chunks(Threads::All, &mut costs, |start, chunk| {
        for (costs, t) in chunk.iter_mut().zip(start..) {
            let corners = complex.corners(t);
            for (k, cost) in costs.iter_mut().enumerate() {
                let corners: [[f64; D]; D] = facet(&corners, k);
                let outward = Euclidean::facet_normal(&corners);
                let to_facet = vector::minus(corners[0], spheres.centers[t]);
                let cosine = vector::dot(to_facet, outward) / (vector::norm(outward) * spheres.radii[t]);
                // NaN where a facet's normal is too small to have a direction.
                *cost = vector::rounded(f64::from(UNIT) * (1.0 - cosine)).clamp(1.0, 2.0 * f64::from(UNIT)) as u16;
            }
        }
    });
    costs
}
