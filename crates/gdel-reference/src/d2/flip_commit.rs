//! Carrying out an edge flip (§5.6).

use gdel::internals::d2::gpu::layout::EdgeFlip;
use gdel::{
    NONE,
    internals::gpu::layout::{Active, DONE, FACET_SHIFT, KIND_SHIFT},
};

use crate::State;
use crate::state::{replaced, slot};

/// Carries out the flip that entry `i` of the active list proposes, if it has won.
pub(super) fn commit(state: &mut State<2>, i: usize) {
    let half = state.half();
    let Active { tet: t, outcome } = state.active[half][i];
    if outcome >> KIND_SHIFT & 3 == 0 {
        return;
    }
    let k = (outcome >> FACET_SHIFT & 3) as usize;
    let (u, f) = state.across(t, k);
    if !state.has_won(i, &[t, u]) {
        return;
    }
    let Some(node) = state.node_for(&[t, u]) else { return };
    // t is (d, a, b) and u is (e, b, a), counted from the corners opposite the edge.
    let [ka, kb, fb, fa] = [(k + 1) % 3, (k + 2) % 3, (f + 1) % 3, (f + 2) % 3];
    let (old_t, old_u) = (state.corners(t), state.corners(u));
    let (near_t, near_u) = (state.neighbors[t as usize], state.neighbors[u as usize]);
    let [d, a, b, e] = [old_t[k], old_t[ka], old_t[kb], old_u[f]];
    state.record(node, EdgeFlip { edge: [e, d], triangles: [t, u], next: [NONE; 2] }, &[t, u]);
    for (place, t) in [t, u].into_iter().enumerate() {
        state.mark_changed(t, 0b110, node, place);
    }
    state.simplices[t as usize] = slot([a, e, d]);
    state.simplices[u as usize] = slot([b, d, e]);
    state.neighbors[t as usize] = slot([4 * u, near_t[kb], near_u[fb]]);
    state.neighbors[u as usize] = slot([4 * t, near_u[fa], near_t[ka]]);
    state.messages[t as usize] = slot(replaced(replaced([NONE; 3], kb, 4 * t + 1), ka, 4 * u + 2));
    state.messages[u as usize] = slot(replaced(replaced([NONE; 3], fb, 4 * t + 2), fa, 4 * u + 1));
    state.active[half][i].outcome = DONE;
}
