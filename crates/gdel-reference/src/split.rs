//! Inserting the picked points (§3.1), and relocating those in the split simplices.

use gdel::internals::dimension::Dimension;
use gdel::internals::gpu::dim::Dim;
use gdel::{
    NONE,
    internals::gpu::layout::{CHECK, HELD_SHIFT, Status, Waiting},
};

use crate::State;
use crate::dim::{OwnState, ReferenceDim};
use crate::state::{replaced, slot};

/// Returns the slot of child `k` of simplex `t`, split at point `p`: the one with `p` in place of
/// vertex `k`. The slots of `p` are empty before.
fn child_slot<const D: usize>(t: u32, p: u32, k: u32) -> u32
where
    Dimension<D>: ReferenceDim<D>,
{
    if k == 0 { t } else { Dimension::<D>::SLOTS_PER_POINT * p + k - 1 }
}

/// Returns the point that splits a simplex, or [`NONE`].
fn splitting_point<const D: usize>(state: &State<D>, t: u32) -> u32
where
    Dimension<D>: ReferenceDim<D>,
{
    state.messages[t as usize][1].wrapping_sub(1)
}

/// Splits each simplex that picked a point. One invocation per waiting point.
///
/// Inside, all facets are locally Delaunay because the point lies inside the circumsphere; the
/// outer ones are to be checked.
pub fn split<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    for i in 0..state.waiting.len() {
        let Waiting { point: p, tet: t } = state.waiting[i];
        if t == NONE || splitting_point(state, t) != p {
            continue;
        }
        // No other invocation writes these: a neighbour that is split too leaves them alone.
        let (vertices, outer) = (state.corners(t), state.neighbors[t as usize]);
        let was_active = state.status[t as usize].flags & CHECK != 0;
        for k in 0..=D as u32 {
            let child = child_slot::<D>(t, p, k);
            state.simplices[child as usize] = slot(replaced(vertices, k as usize, p));
            let (u, face) = (outer[k as usize] >> 2, outer[k as usize] & 3);
            let q = splitting_point(state, u);
            let across = if q == NONE { outer[k as usize] } else { 4 * child_slot::<D>(u, q, face) + face };
            let neighbor = |j: u32| if j == k { across } else { 4 * child_slot::<D>(t, p, j) + k };
            state.neighbors[child as usize] = std::array::from_fn(|j| if j <= D { neighbor(j as u32) } else { 0 });
            if q == NONE {
                state.neighbors[u as usize][face as usize] = 4 * child + k;
            }
            // The vote is left alone: only its iteration makes it valid.
            let status = &mut state.status[child as usize];
            *status = Status { flags: 1 << k, vote: status.vote, ..Status::default() };
            if k > 0 || !was_active {
                state.append(state.half(), child);
            }
        }
        state.own.occupy(p, D as u32, state.counters.round);
        state.counters.inserted += 1;
    }
}

/// Moves the waiting points of split simplices into the children. One invocation per waiting point.
pub fn relocate_split<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
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
        let [vertex, ..] = state.simplices[child_slot::<D>(t, p, 1) as usize];
        let corners = replaced(state.corners(t), 0, vertex);
        let k = Dimension::<D>::child_of(corners, p, q, |corners| state.orient(corners));
        let child = child_slot::<D>(t, p, k as u32);
        state.waiting[i].tet = child;
        let flags = &mut state.status[child as usize].flags;
        *flags |= state.counters.round << HELD_SHIFT;
    }
}
