//! Waiting points follow the history of the round's flips (§4.1).

use crate::gpu::layout::{NONE, Waiting};

use crate::reference::d2::State;

/// Moves each waiting point to the triangle that it lies in after the flips. One thread a waiting point.
pub fn relocate(state: &mut State) {
    let first_node = state.counters.first_node;
    for i in 0..state.waiting.len() {
        let Waiting { point: p, tet: mut t } = state.waiting[i];
        if t == NONE {
            continue;
        }
        let start = state.status[t as usize].first;
        let mut next = if start >= first_node { start } else { NONE };
        while next != NONE {
            let node = &state.history[(next - first_node) as usize];
            let [a, b] = node.edge;
            let k = if state.orient([a, b, p]) > 0 { 0 } else { 1 };
            t = node.triangles[k];
            next = node.next[k];
        }
        state.waiting[i].tet = t;
    }
}
