//! Which flip each active tetrahedron proposes (§3.1, §4.2).

use crate::d3::mesh::FACETS;
use crate::gpu::layout::{CHECK, EDGE_SHIFT, FACET_SHIFT, FLIP_23, FLIP_32, KIND_SHIFT, SUSPECT_SHIFT};

use crate::reference::d3::State;

/// Checks the facets of each active tetrahedron until one can be flipped, and bids for the tetrahedra that this flip
/// would change. One thread an entry of the active list.
pub fn flip_check(state: &mut State) {
    if state.is_idle(state.counters.iteration) {
        return;
    }
    let half = state.half();
    let entries = state.counters.active_len[half] as usize;
    state.counters.visits += entries as u32;
    state.counters.iterations += 1;
    for i in 0..entries {
        let t = state.active[half][i].tet;
        let (outcome, changes) = proposal(state, t);
        state.active[half][i].outcome = outcome;
        let bid = state.bid(i);
        for tet in changes {
            let vote = &mut state.status[tet as usize].vote;
            *vote = bid.max(*vote);
        }
    }
}

/// The outcome for a tetrahedron, and the tetrahedra that its proposed flip would change.
fn proposal(state: &State, t: u32) -> (u32, Vec<u32>) {
    let flags = state.status[t as usize].flags;
    let mut check = flags & CHECK;
    let mut suspect = flags >> SUSPECT_SHIFT & CHECK & !check;
    let tet = state.tets[t as usize];
    for k in 0..4usize {
        if check >> k & 1 == 0 {
            continue;
        }
        let (u, face) = (state.neighbors[t as usize][k] >> 2, state.neighbors[t as usize][k] & 3);
        let theirs = u < t && state.status[u as usize].flags >> face & 1 != 0;
        let e = state.tets[u as usize][face as usize];
        if theirs || !state.inside(tet, e) {
            check &= !(1 << k);
            continue;
        }
        let corners = FACETS[k];
        let x = corners.map(|c| tet[c]);
        let negative: Vec<usize> = (0..3).filter(|&i| state.orient([x[i], x[(i + 1) % 3], tet[k], e]) < 0).collect();
        let found = |kind: u32, edge: usize| {
            let flip = kind << KIND_SHIFT | (k as u32) << FACET_SHIFT | (edge as u32) << EDGE_SHIFT;
            flip | suspect << SUSPECT_SHIFT | check
        };
        match negative[..] {
            [] => return (found(FLIP_23, 0), vec![t, u]),
            [i] => {
                let opposite = (i + 2) % 3;
                let w = state.neighbors[t as usize][corners[opposite]] >> 2;
                let there = state.tets[u as usize].iter().position(|&v| v == x[opposite]);
                let there = there.expect("neighbours share a facet");
                if state.neighbors[u as usize][there] >> 2 == w {
                    return (found(FLIP_32, i), vec![t, u, w]);
                }
            }
            _ => {}
        }
        check &= !(1 << k);
        suspect |= 1 << k;
    }
    (suspect << SUSPECT_SHIFT | check, Vec::new())
}
