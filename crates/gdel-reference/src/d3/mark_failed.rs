//! The vertices that star splaying has to repair (§3.2.1).

use gdel::internals::d3::mesh::FACETS;
use gdel::internals::gpu::layout::SUSPECT_SHIFT;

use crate::State;

/// Marks the vertices of the facets that are not locally Delaunay. One invocation per slot.
///
/// Only facets that a flip iteration found but could not flip are checked: their neighbourhood may
/// have changed since.
pub fn mark_failed(state: &mut State<3>) {
    for t in 0..state.simplices.len() as u32 {
        if !state.is_used(t as usize) {
            continue;
        }
        let tet = state.corners(t);
        for (k, corners) in FACETS.iter().enumerate() {
            let suspect = |t: u32, k: usize| state.status[t as usize].flags >> SUSPECT_SHIFT >> k & 1 != 0;
            let (u, face) = state.across(t, k);
            if !suspect(t, k) || !state.inside(tet, state.corners(u)[face]) {
                continue;
            }
            // Both sides may be suspect: the one with the lower number counts.
            if u > t || !suspect(u, face) {
                state.counters.not_locally_delaunay += 1;
            }
            for v in corners.map(|c| tet[c]).into_iter().filter(|&v| v != state.params.infinite) {
                state.own.failed[v as usize] = 1;
            }
        }
    }
}
