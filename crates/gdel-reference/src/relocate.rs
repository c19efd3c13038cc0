//! Waiting points follow the history of the round's flips (§4.1).

use gdel::internals::dimension::Dimension;
use gdel::{NONE, internals::gpu::layout::Waiting};

use crate::State;
use crate::dim::ReferenceDim;

/// Moves each waiting point to the simplex that it lies in after the flips. One invocation per
/// waiting point.
pub fn relocate<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    for i in 0..state.waiting.len() {
        let Waiting { point: p, tet: mut t } = state.waiting[i];
        if t == NONE {
            continue;
        }
        // `NONE` if there is no first node.
        let mut next = state.status[t as usize].first.wrapping_sub(1);
        while next != NONE {
            let flip = &state.history[next as usize];
            (t, next) = Dimension::<D>::descend(flip, p, |corners| state.orient(corners));
        }
        state.waiting[i].tet = t;
    }
}
