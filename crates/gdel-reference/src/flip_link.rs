//! Neighbours after simultaneous flips, and the next active list.

use gdel::internals::dimension::Dimension;
use gdel::internals::gpu::layout::{Active, CHECK, DONE};

use crate::State;
use crate::dim::ReferenceDim;

/// Joins the new simplices to those around them, and lists the simplices to check next. One
/// invocation per entry of the active list.
///
/// An outer neighbour that did not change is updated; one that did left a message, which is
/// followed. So each facet is written once.
pub fn flip_link<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    let iteration = state.counters.link_iteration;
    if state.is_idle(iteration) {
        return;
    }
    let half = (iteration & 1) as usize;
    let bids = state.link_bids();
    let mark = bids.changed_mark();
    for i in 0..state.counters.active_len[half] as usize {
        let Active { tet: t, outcome } = state.active[half][i];
        if outcome & DONE == 0 {
            // The flip that changed this simplex lists it.
            if state.status[t as usize].vote != mark {
                let flags = &mut state.status[t as usize].flags;
                *flags = *flags & !0xff | outcome & 0xff;
                if outcome & CHECK != 0 {
                    state.append(1 - half, t);
                }
            }
        } else {
            let (inner, outer) = Dimension::<D>::made_by(outcome);
            let others: Vec<u32> = inner.iter().map(|&k| state.across(t, k).0).collect();
            for t in std::iter::once(t).chain(others) {
                for face in outer.clone() {
                    state.join(mark, t, face);
                }
                state.append(1 - half, t);
            }
            Dimension::<D>::count_flip(&mut state.own, &mut state.counters, outcome);
        }
    }
    state.counters.iteration = iteration + 1;
    state.counters.bid_base = bids.next_base();
}

impl<const D: usize> State<D>
where
    Dimension<D>: ReferenceDim<D>,
{
    fn join(&mut self, mark: u32, t: u32, face: usize) {
        let (u, theirs) = self.across(t, face);
        if self.status[u as usize].vote == mark {
            self.neighbors[t as usize][face] = self.messages[u as usize][theirs];
        } else {
            self.neighbors[u as usize][theirs] = 4 * t + face as u32;
        }
    }
}
