//! Which edge flip a triangle proposes (§5.6).

use gdel::internals::d2::gpu::layout::FLIP_22;
use gdel::internals::gpu::layout::{CHECK, FACET_SHIFT, KIND_SHIFT};

use crate::State;

/// Returns the outcome for a triangle, and the two triangles that its proposed flip would change:
/// it flips the first edge that is not locally Delaunay.
pub(super) fn proposal(state: &State<2>, t: u32) -> (u32, Vec<u32>) {
    let mut check = state.status[t as usize].flags & CHECK;
    for k in 0..3 {
        if check >> k & 1 == 0 {
            continue;
        }
        let (u, edge) = state.across(t, k);
        let theirs = u < t && state.status[u as usize].flags >> edge & 1 != 0;
        if !theirs && state.inside(state.corners(t), state.corners(u)[edge]) {
            return (check | FLIP_22 << KIND_SHIFT | (k as u32) << FACET_SHIFT, vec![t, u]);
        }
        check &= !(1 << k);
    }
    (check, Vec::new())
}
