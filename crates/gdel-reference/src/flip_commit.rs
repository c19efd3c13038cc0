//! Carrying out the flips that won all of their simplices.

use gdel::internals::dimension::Dimension;
use gdel::internals::gpu::dim::Flip;
use gdel::{
    NONE,
    internals::gpu::layout::{HELD_SHIFT, HISTORY_FULL, Status},
};

use crate::State;
use crate::dim::ReferenceDim;
use crate::kernels::Kernels;

/// Carries out the proposed flips that won. One invocation per entry of the active list.
///
/// A flip owns its simplices, so it overwrites them in place; the outer facets of the new ones keep
/// their old neighbours until `flip_link`, and each old simplex gets
/// a message that says where its outer facets went. A flip that finds no slot, or no room in the
/// history, is put off: it stays in the active list.
pub fn flip_commit<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: Kernels<D>,
{
    let iteration = state.counters.iteration;
    state.counters.link_iteration = iteration;
    state.counters.link_bid_base = state.counters.bid_base;
    if state.is_idle(iteration) {
        return;
    }
    state.counters.active_len[((iteration + 1) & 1) as usize] = 0;
    for i in 0..state.counters.active_len[state.half()] as usize {
        Dimension::<D>::commit(state, i);
    }
}

impl<const D: usize> State<D>
where
    Dimension<D>: ReferenceDim<D>,
{
    /// Returns whether entry `i` of the active list won these simplices.
    pub(super) fn has_won(&self, i: usize, simplices: &[u32]) -> bool {
        let bid = self.bids().bid(i);
        simplices.iter().all(|&t| self.status[t as usize].vote == bid)
    }

    /// Returns a number in the history for a flip of `old`: [`NONE`] where no waiting point can lie
    /// in them, `None` when the history is full.
    pub(super) fn node_for(&mut self, old: &[u32]) -> Option<u32> {
        if !old.iter().any(|&t| self.is_held(t)) {
            return Some(NONE);
        }
        let node = self.counters.next_node;
        if node >= self.params.history {
            self.counters.overflow |= HISTORY_FULL;
            return None;
        }
        self.counters.next_node += 1;
        Some(node)
    }

    /// Writes a node of the history, unless it is [`NONE`], and makes those before it point to it.
    /// (Algorithm 2 does this from the last flip to the first after the fact; since a flip owns its
    /// simplices, it can be done at once.)
    pub(super) fn record(&mut self, node: u32, flip: Flip<D>, old: &[u32]) {
        if node == NONE {
            return;
        }
        self.history[node as usize] = flip;
        for &t in old {
            let last = self.status[t as usize].last;
            if !self.is_held(t) {
                continue;
            }
            if last == 0 {
                self.status[t as usize].first = node + 1;
            } else {
                let before = &mut self.history[(last >> 2) as usize - 1];
                Dimension::<D>::next_nodes(before)[(last & 3) as usize] = node;
            }
        }
    }

    /// Marks a slot as changed in this flip iteration, with the facets to check of the simplex that
    /// it has now: simplex `place` of the flip with this node.
    pub(super) fn mark_changed(&mut self, t: u32, check: u32, node: u32, place: usize) {
        let held = if node == NONE { 0 } else { self.counters.round << HELD_SHIFT };
        let last = if node == NONE { 0 } else { (node + 1) << 2 | place as u32 };
        let vote = self.bids().changed_mark();
        let first = self.status[t as usize].first;
        self.status[t as usize] = Status { flags: held | check, vote, last, first };
    }
}
