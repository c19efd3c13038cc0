//! The vertices that star splaying has to mend (§3.2.1).

use crate::d3::mesh::FACETS;
use crate::gpu::layout::SUSPECT_SHIFT;

use crate::reference::d3::State;

/// Marks the vertices of the facets that are not locally Delaunay. One thread a slot.
///
/// Only facets that a flip iteration found so and could not flip need another look: what lies around them may have
/// changed since.
pub fn mark_failed(state: &mut State) {
    for t in 0..state.tets.len() {
        if !state.is_used(t) {
            continue;
        }
        for (k, corners) in FACETS.iter().enumerate() {
            if state.status[t].flags >> SUSPECT_SHIFT >> k & 1 == 0 {
                continue;
            }
            let across = state.neighbors[t][k];
            let e = state.tets[(across >> 2) as usize][(across & 3) as usize];
            if state.inside(state.tets[t], e) {
                // Both sides may be suspect: the one with the lower number counts.
                let other = (across >> 2) as usize;
                if other > t || state.status[other].flags >> SUSPECT_SHIFT >> (across & 3) & 1 == 0 {
                    state.counters.not_locally_delaunay += 1;
                }
                for &corner in corners {
                    let v = state.tets[t][corner];
                    if v != state.params.infinite {
                        state.failed[v as usize] = 1;
                    }
                }
            }
        }
    }
}
