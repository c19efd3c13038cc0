//! 1-to-4 splits, and the points inside.

use crate::gpu::layout::{Active, BLOCK, CHECK, HELD_SHIFT, NONE, Status, Waiting};
use crate::predicates::Sign;

use crate::reference::d3::State;
use crate::reference::d3::state::replaced;

/// The slot of child `k` of tetrahedron `t`, split at point `p`: the one with `p` in place of vertex `k`. The block of
/// `p` is empty before.
pub fn child_slot(t: u32, p: u32, k: u32) -> u32 {
    if k == 0 { t } else { p * BLOCK + k - 1 }
}

/// The point that tetrahedron `t` is split at, or [`NONE`].
fn splitting_point(state: &State, t: u32) -> u32 {
    state.messages[t as usize][1].wrapping_sub(1)
}

/// Splits each tetrahedron that picked a point. One thread a waiting point.
///
/// Inside, all facets are locally Delaunay because the point lies inside the circumsphere; the four outer ones are to
/// be checked.
pub fn split(state: &mut State) {
    for i in 0..state.waiting.len() {
        let Waiting { point: p, tet: t } = state.waiting[i];
        if t == NONE || splitting_point(state, t) != p {
            continue;
        }
        // No other thread writes these: a neighbour that is split too leaves them alone.
        let (vertices, outer) = (state.tets[t as usize], state.neighbors[t as usize]);
        let was_active = state.status[t as usize].flags & CHECK != 0;
        for k in 0..4u32 {
            let slot = child_slot(t, p, k);
            state.tets[slot as usize] = replaced(vertices, k as usize, p);
            let (u, face) = (outer[k as usize] >> 2, outer[k as usize] & 3);
            let q = splitting_point(state, u);
            let across = if q == NONE { outer[k as usize] } else { 4 * child_slot(u, q, face) + face };
            state.neighbors[slot as usize] = std::array::from_fn(|j| match j as u32 {
                j if j == k => across,
                j => 4 * child_slot(t, p, j) + k,
            });
            if q == NONE {
                state.neighbors[u as usize][face as usize] = 4 * slot + k;
            }
            // The vote is left alone: only its iteration makes it valid.
            state.status[slot as usize] = Status { flags: 1 << k, ..state.status[slot as usize] };
            if k > 0 || !was_active {
                let half = state.half();
                let at = state.counters.active_len[half];
                state.active[half][at as usize] = Active { tet: slot, outcome: 0 };
                state.counters.active_len[half] += 1;
            }
        }
        state.free[p as usize] &= !0b111;
        state.counters.inserted += 1;
    }
}

/// Which child of `vertices`, split at `p`, holds `q`: 3 orientations.
///
/// The plane of p, v₀, v₁ and that of p, v₂, v₃ leave two children whose directions from p meet; a third plane divides
/// them.
pub fn child_of(vertices: [u32; 4], p: u32, q: u32, orient: impl Fn([u32; 4]) -> Sign) -> usize {
    let on_side_of = |i: usize, j: usize| orient(replaced(replaced(vertices, i, q), j, p)) > 0;
    let a = if on_side_of(3, 2) { 3 } else { 2 };
    let b = if on_side_of(0, 1) { 0 } else { 1 };
    if on_side_of(1 - b, 5 - a) { 5 - a } else { 1 - b }
}

/// Moves the waiting points of split tetrahedra into the children. One thread a waiting point.
pub fn relocate_split(state: &mut State) {
    for i in 0..state.waiting.len() {
        let Waiting { point: q, tet: t } = state.waiting[i];
        if t == NONE {
            continue;
        }
        let p = splitting_point(state, t);
        if p == q {
            state.waiting[i].tet = NONE;
            continue;
        }
        // Child 0 is in slot t and has p for its vertex 0. Its face 1 leads to child 1, which has the vertex.
        let child_1 = state.tets[child_slot(t, p, 1) as usize];
        let vertices = replaced(state.tets[t as usize], 0, child_1[0]);
        let k = child_of(vertices, p, q, |four| state.orient(four));
        let slot = child_slot(t, p, k as u32);
        state.waiting[i].tet = slot;
        let flags = &mut state.status[slot as usize].flags;
        *flags |= state.counters.round << HELD_SHIFT;
    }
}
