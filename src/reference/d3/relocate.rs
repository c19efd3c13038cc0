//! Waiting points follow the history of the round's flips (§4.1).

use crate::gpu::layout::{FLIP_23, FlipNode, NONE, Waiting};

use crate::reference::d3::State;

/// Moves each waiting point to the tetrahedron that it lies in after the flips. One thread a waiting point.
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
            let k = side(state, node, p);
            t = node.tets[k];
            next = node.next[k];
        }
        state.waiting[i].tet = t;
    }
}

/// Which of the tetrahedra that a flip made holds `p`, by one or two orientations.
fn side(state: &State, node: &FlipNode, p: u32) -> usize {
    let [x0, x1, x2, d, e] = node.vertices;
    if node.kind == FLIP_23 {
        let beyond = |x: u32| state.orient([x, p, d, e]) > 0;
        match beyond(x0) {
            true if beyond(x1) => 1,
            true => 0,
            false if beyond(x2) => 2,
            false => 1,
        }
    } else if state.orient([x0, x1, x2, p]) > 0 {
        0
    } else {
        1
    }
}
