//! Inserting the picked points (§3.1).

use crate::d2::gpu::layout::PLANE_BLOCK;
use crate::gpu::layout::{Active, CHECK, HELD_SHIFT, NONE, Status, Waiting};
use crate::predicates::Sign;

use crate::reference::d2::State;
use crate::reference::d2::state::{replaced, words};

/// The slot of child `k` of triangle `t`, split at `p`: the one with `p` in place of vertex `k`.
fn child_slot(t: u32, p: u32, k: u32) -> u32 {
    if k == 0 { t } else { PLANE_BLOCK * p + k - 1 }
}

/// The point that splits a triangle, or [`NONE`].
fn splitting_point(state: &State, t: u32) -> u32 {
    state.messages[t as usize][1].wrapping_sub(1)
}

/// Splits each triangle that picked a point. One thread a waiting point.
///
/// Inside, all edges are locally Delaunay because the point lies inside the circumcircle; the three outer ones are to be
/// checked.
pub fn split(state: &mut State) {
    for i in 0..state.waiting.len() {
        let Waiting { point: p, tet: t } = state.waiting[i];
        if t == NONE || splitting_point(state, t) != p {
            continue;
        }
        // No other thread writes these: a neighbour that is split too leaves them alone.
        let (vertices, outer) = (state.triangle(t), state.neighbors[t as usize]);
        let was_active = state.status[t as usize].flags & CHECK != 0;
        for k in 0..3u32 {
            let slot = child_slot(t, p, k);
            state.triangles[slot as usize] = words(replaced(vertices, k as usize, p));
            let (u, edge) = (outer[k as usize] >> 2, outer[k as usize] & 3);
            let q = splitting_point(state, u);
            let across = if q == NONE { outer[k as usize] } else { 4 * child_slot(u, q, edge) + edge };
            state.neighbors[slot as usize] =
                words([0, 1, 2].map(|j| if j == k { across } else { 4 * child_slot(t, p, j) + k }));
            if q == NONE {
                state.neighbors[u as usize][edge as usize] = 4 * slot + k;
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
        state.counters.inserted += 1;
    }
}

/// Which child of `vertices`, split at `p`, holds `q`: 2 orientations.
///
/// The rays from p to the corners divide the triangle. The line of the first ray leaves two children on a side, and the
/// ray between those decides.
pub fn child_of(vertices: [u32; 3], p: u32, q: u32, orient: impl Fn([u32; 3]) -> Sign) -> usize {
    let left_of = |ray: usize| orient([p, vertices[ray], q]) > 0;
    match left_of(0) {
        true if left_of(1) => 0,
        true => 2,
        false if left_of(2) => 1,
        false => 0,
    }
}

/// Moves the waiting points of split triangles into the children. One thread a waiting point.
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
        // Child 0 is in slot t and has p for its vertex 0; child 1 has that vertex.
        let child_1 = state.triangle(child_slot(t, p, 1));
        let vertices = replaced(state.triangle(t), 0, child_1[0]);
        let k = child_of(vertices, p, q, |three| state.orient(three));
        let slot = child_slot(t, p, k as u32);
        state.waiting[i].tet = slot;
        let flags = &mut state.status[slot as usize].flags;
        *flags |= state.counters.round << HELD_SHIFT;
    }
}
