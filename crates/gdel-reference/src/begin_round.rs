//! The beginning of an insertion round.

use gdel::internals::dimension::Dimension;
use gdel::{
    NONE,
    internals::gpu::layout::{GROWTH_FROM, GROWTH_SHARE, LOGGED, Params, Pick, TWICE_GROWTH},
};

use crate::State;
use crate::dim::ReferenceDim;

/// Begins an insertion round. Decides whether the list of waiting points is compacted, and whether
/// a mesh whose points have moved is too damaged to be repaired by flips. One invocation.
pub fn begin_round<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    let waiting = state.params.infinite - state.counters.inserted - state.counters.merged;
    let counters = &mut state.counters;
    let Params { moved_simplices, moved_inverted, moved_violated, .. } = state.params;
    if moved_simplices != 0 && (counters.inverted > moved_inverted || counters.violated > moved_violated) {
        counters.active_len[counters.iteration as usize & 1] = 0;
    }
    let [before, ..] = counters.log[(counters.round as usize + LOGGED - 1) % LOGGED];
    let added = counters.inserted.wrapping_sub(before);
    if state.params.pick != Pick::Adaptive as u32 {
        counters.criterion = state.params.pick;
    } else if before >= GROWTH_FROM && counters.inserted <= state.params.infinite / GROWTH_SHARE {
        let is_even = before <= added / TWICE_GROWTH * 2 && !counters.is_exact();
        counters.criterion = if is_even { Pick::Centroid } else { Pick::Circumcenter } as u32;
    }
    let progress = counters.progress();
    counters.log[counters.round as usize % LOGGED] = progress;
    counters.round += 1;
    counters.next_node = 0;
    let few = counters.min_active(&state.params, counters.inserted);
    counters.min_active = match (waiting, state.params.insert_all) {
        (0, _) => 0,
        (_, 0) => few,
        _ => NONE,
    };
    counters.overflow = 0;
    counters.kept = 0;
    counters.entries_before = 0;
    if waiting < counters.entries / 4 * 3 {
        counters.entries_before = std::mem::replace(&mut counters.entries, waiting);
        counters.waiting_half ^= 1;
    }
}
