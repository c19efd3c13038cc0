//! Edge flips: proposed, carried out, linked (§5.6).

use crate::d2::gpu::layout::{EdgeFlip, FLIP_22};
use crate::gpu::layout::{Active, CHECK, DONE, FACET_SHIFT, HELD_SHIFT, HISTORY_FULL, KIND_SHIFT, NONE, Status};

use crate::reference::d2::State;
use crate::reference::d2::state::{replaced, words};

/// Checks the edges of each active triangle until one is not locally Delaunay, and bids for the two triangles that its
/// flip would change. One thread an entry of the active list.
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
        let mut check = state.status[t as usize].flags & CHECK;
        let mut flip = None;
        for k in 0..3 {
            if check >> k & 1 == 0 {
                continue;
            }
            let (u, edge) = state.across(t, k);
            let theirs = u < t && state.status[u as usize].flags >> edge & 1 != 0;
            if !theirs && state.inside(state.triangle(t), state.triangle(u)[edge]) {
                flip = Some((k as u32, u));
                break;
            }
            check &= !(1 << k);
        }
        state.active[half][i].outcome = check | flip.map_or(0, |(k, _)| FLIP_22 << KIND_SHIFT | k << FACET_SHIFT);
        if let Some((_, u)) = flip {
            let bid = state.bid(i);
            for changed in [t, u] {
                let vote = &mut state.status[changed as usize].vote;
                *vote = bid.max(*vote);
            }
        }
    }
}

/// Carries out the proposed flips that won. One thread an entry of the active list.
///
/// A flip owns its triangles, so it overwrites them in place; the outer edges of the new ones keep their old neighbours
/// until [`flip_link`], and each old triangle gets a message that says where its outer edges went. A flip that finds no
/// room in the history is put off: it stays in the active list.
pub fn flip_commit(state: &mut State) {
    let iteration = state.counters.iteration;
    state.counters.link_iteration = iteration;
    if state.is_idle(iteration) {
        return;
    }
    state.counters.active_len[((iteration + 1) & 1) as usize] = 0;
    let half = state.half();
    let mark = state.changed_mark(iteration);
    for i in 0..state.counters.active_len[half] as usize {
        let Active { tet: t, outcome } = state.active[half][i];
        if outcome >> KIND_SHIFT & 3 == 0 {
            continue;
        }
        let k = (outcome >> FACET_SHIFT & 3) as usize;
        let (u, f) = state.across(t, k);
        let bid = state.bid(i);
        if [t, u].iter().any(|&t| state.status[t as usize].vote != bid) {
            continue;
        }
        let Some(node) = node_for(state, t, u) else { continue };
        // t is (d, a, b) and u is (e, b, a), counted from the corners opposite the edge.
        let [ka, kb, fb, fa] = [(k + 1) % 3, (k + 2) % 3, (f + 1) % 3, (f + 2) % 3];
        let (old_t, old_u) = (state.triangle(t), state.triangle(u));
        let (near_t, near_u) = (state.neighbors[t as usize], state.neighbors[u as usize]);
        let [d, a, b, e] = [old_t[k], old_t[ka], old_t[kb], old_u[f]];
        if node != NONE {
            record(state, node, EdgeFlip { edge: [e, d], triangles: [t, u], next: [NONE; 2] });
        }
        for (place, slot) in [t, u].into_iter().enumerate() {
            let held = if node == NONE { 0 } else { state.counters.round << HELD_SHIFT };
            let last = if node == NONE { 0 } else { node << 2 | place as u32 };
            let first = state.status[slot as usize].first;
            state.status[slot as usize] = Status { flags: held | 0b110, vote: mark, last, first };
        }
        state.triangles[t as usize] = words([a, e, d]);
        state.triangles[u as usize] = words([b, d, e]);
        state.neighbors[t as usize] = words([4 * u, near_t[kb], near_u[fb]]);
        state.neighbors[u as usize] = words([4 * t, near_u[fa], near_t[ka]]);
        state.messages[t as usize] = words(replaced(replaced([NONE; 3], kb, 4 * t + 1), ka, 4 * u + 2));
        state.messages[u as usize] = words(replaced(replaced([NONE; 3], fb, 4 * t + 2), fa, 4 * u + 1));
        state.active[half][i].outcome = DONE | FLIP_22;
    }
}

/// A number in the history for a flip of two triangles: [`NONE`] where no waiting point can lie in them, nothing when the
/// history is full.
fn node_for(state: &mut State, t: u32, u: u32) -> Option<u32> {
    if !state.is_held(t) && !state.is_held(u) {
        return Some(NONE);
    }
    let node = state.counters.next_node;
    if node - state.counters.first_node >= state.params.history {
        state.counters.overflow |= HISTORY_FULL;
        return None;
    }
    state.counters.next_node += 1;
    Some(node)
}

/// Writes a node of the history, and makes those before it point to it.
fn record(state: &mut State, node: u32, flip: EdgeFlip) {
    let first = state.counters.first_node;
    state.history[(node - first) as usize] = flip;
    for t in flip.triangles {
        let last = state.status[t as usize].last;
        if !state.is_held(t) {
            continue;
        }
        if last >> 2 >= first {
            state.history[((last >> 2) - first) as usize].next[(last & 3) as usize] = node;
        } else {
            state.status[t as usize].first = node;
        }
    }
}

/// Joins the new triangles to those around them, and lists the triangles to check next. One thread an entry of the active
/// list.
///
/// An outer neighbour that did not change is told; one that did left a message, which is followed. So each edge is
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
            // The flip that changed this triangle lists it.
            if state.status[t as usize].vote != mark {
                let flags = &mut state.status[t as usize].flags;
                *flags = *flags & !CHECK | outcome & CHECK;
                if outcome & CHECK != 0 {
                    append(state, 1 - half, t);
                }
            }
        } else {
            for t in [t, state.across(t, 0).0] {
                join(state, mark, t, 1);
                join(state, mark, t, 2);
                append(state, 1 - half, t);
            }
            state.counters.flips_22 += 1;
        }
    }
    state.counters.iteration = iteration + 1;
}

fn join(state: &mut State, mark: u32, t: u32, edge: usize) {
    let (u, theirs) = state.across(t, edge);
    if state.status[u as usize].vote == mark {
        state.neighbors[t as usize][edge] = state.messages[u as usize][theirs];
    } else {
        state.neighbors[u as usize][theirs] = 4 * t + edge as u32;
    }
}

fn append(state: &mut State, half: usize, t: u32) {
    let at = &mut state.counters.active_len[half];
    state.active[half][*at as usize] = Active { tet: t, outcome: 0 };
    *at += 1;
}
