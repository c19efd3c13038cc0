//! Neighbours after simultaneous flips, and the next active list.

use crate::gpu::layout::{Active, BLOCK, CHECK, DONE, FLIP_23, SLOT_SHIFT};

use crate::reference::d3::State;

/// Joins the new tetrahedra to those around them, and lists the tetrahedra to check next, unless [`flip_compact`] does. One
/// thread an entry of the active list.
///
/// An outer neighbour that did not change is told; one that did left a message, which is followed. So each facet is
/// written once.
pub fn flip_link(state: &mut State) {
    let iteration = state.counters.link_iteration;
    if state.is_idle(iteration) {
        return;
    }
    let half = (iteration & 1) as usize;
    let mark = state.changed_mark(iteration);
    for i in 0..state.counters.active_len[half] as usize {
        let Active { tet: t, outcome } = state.active[half][i];
        if outcome & DONE == 0 {
            // The flip that changed this tetrahedron lists it.
            if state.status[t as usize].vote != mark {
                let flags = &mut state.status[t as usize].flags;
                *flags = *flags & !0xff | outcome & 0xff;
                if outcome & CHECK != 0 {
                    append(state, 1 - half, t);
                }
            }
        } else if outcome & 3 == FLIP_23 {
            let inner = state.neighbors[t as usize];
            for tet in [t, inner[0] >> 2, inner[1] >> 2] {
                for face in 2..4 {
                    join(state, mark, tet, face);
                }
                append(state, 1 - half, tet);
            }
            state.counters.flips_23 += 1;
        } else {
            for tet in [t, state.neighbors[t as usize][3] >> 2] {
                for face in 0..3 {
                    join(state, mark, tet, face);
                }
                append(state, 1 - half, tet);
            }
            let slot = (outcome & !DONE) >> SLOT_SHIFT;
            state.free[(slot / BLOCK) as usize] |= 1 << (slot % BLOCK);
            state.counters.flips_32 += 1;
        }
    }
    state.counters.iteration = iteration + 1;
    if compacts(state, iteration) {
        state.counters.active_len[1 - half] = 0;
    }
}

/// Lists the tetrahedra to check next in the order of their slots, where there are very many (§4.2). One thread a slot.
pub fn flip_compact(state: &mut State) {
    let iteration = state.counters.link_iteration;
    if !compacts(state, iteration) {
        return;
    }
    for t in 0..state.status.len() {
        if state.status[t].flags & CHECK != 0 {
            append(state, (iteration as usize + 1) & 1, t as u32);
        }
    }
}

/// Whether so many tetrahedra were active in an iteration that the next ones are found by looking at all slots.
fn compacts(state: &State, iteration: u32) -> bool {
    !state.is_idle(iteration) && state.counters.active_len[(iteration & 1) as usize] >= state.params.compact_from
}

fn join(state: &mut State, mark: u32, t: u32, face: u32) {
    let across = state.neighbors[t as usize][face as usize];
    let (u, theirs) = ((across >> 2) as usize, (across & 3) as usize);
    if state.status[u].vote == mark {
        state.neighbors[t as usize][face as usize] = state.messages[u][theirs];
    } else {
        state.neighbors[u][theirs] = 4 * t + face;
    }
}

fn append(state: &mut State, half: usize, tet: u32) {
    let at = &mut state.counters.active_len[half];
    state.active[half][*at as usize] = Active { tet, outcome: 0 };
    *at += 1;
}
