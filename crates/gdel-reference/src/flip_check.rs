//! Which flip each active simplex proposes (§3.1, §4.2).

use gdel::internals::dimension::Dimension;

use crate::State;
use crate::kernels::Kernels;

/// Checks the facets of each active simplex until one can be flipped, and bids for the simplices
/// that this flip would change. One invocation per entry of the active list.
pub fn flip_check<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: Kernels<D>,
{
    if state.is_idle(state.counters.iteration) {
        return;
    }
    let half = state.half();
    let entries = state.counters.active_len[half] as usize;
    state.counters.visits += entries as u32;
    state.counters.iterations += 1;
    let bids = state.bids();
    for i in 0..entries {
        let t = state.active[half][i].tet;
        let (outcome, changes) = Dimension::<D>::proposal(state, t);
        state.active[half][i].outcome = outcome;
        let bid = bids.bid(i);
        for changed in changes {
            let vote = &mut state.status[changed as usize].vote;
            *vote = bid.max(*vote);
        }
    }
}
