//! The simplices of the start, and which of them each point lies in.

use gdel::internals::dimension::Dimension;
use gdel::{
    NONE,
    internals::gpu::layout::{Active, CHECK, Status, Waiting},
};

use crate::State;
use crate::dim::{OwnState, ReferenceDim};
use crate::state::replaced;

/// Writes the simplices that Phase 1 starts with into the slots of their vertices, and lists them,
/// because all their facets are to be checked. One invocation per simplex.
pub fn start_mesh<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    let infinite = state.params.infinite;
    let count = state.start.simplices.len();
    for i in 0..count {
        let slot = state.start_slot(i as u32);
        let [corners, near] = state.start.simplices[i];
        let words = |word: &dyn Fn(u32) -> u32, words: [u32; 4]| {
            let mut result = [0; 4];
            (0..=D).for_each(|k| result[k] = word(words[k]));
            result
        };
        let vertex = |v: u32| if v == NONE { infinite } else { state.start_vertices[v as usize] };
        let across = |f: u32| 4 * state.start_slot(f >> 2) + (f & 3);
        (state.simplices[slot as usize], state.neighbors[slot as usize]) =
            (words(&vertex, corners), words(&across, near));
        let flags = CHECK & ((2 << D) - 1);
        state.status[slot as usize] = Status { flags, ..state.status[slot as usize] };
        state.active[0][i] = Active { tet: slot, outcome: 0 };
        state.own.occupy_slot(slot);
    }
    state.counters.active_len[0] = count as u32;
    state.counters.inserted = state.start_vertices.len() as u32;
    state.counters.merged = state.merged.iter().filter(|&&merged| merged).count() as u32;
}

/// Lists all points, and finds the simplex of the start that each lies in: the only one in which it
/// is on the inner side of every facet. One invocation per point.
pub fn locate<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    let slots: Vec<u32> = (0..state.start.simplices.len() as u32).map(|i| state.start_slot(i)).collect();
    for point in 0..state.params.infinite {
        let is_waiting = !state.merged[point as usize] && !state.start_vertices.contains(&point);
        let holds = |&t: &u32| (0..=D).all(|k| state.orient(replaced(state.corners(t), k, point)) > 0);
        let tet = if is_waiting { slots.iter().copied().find(holds).expect("they cover space") } else { NONE };
        state.waiting[point as usize] = Waiting { point, tet };
    }
}
