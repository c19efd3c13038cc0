//! The next active list where there are very many active tetrahedra.

use crate::gpu::layout::CHECK;

use crate::reference::State;

/// Lists the tetrahedra to check next in the order of their slots, where there are very many
/// (§4.2). One invocation per slot.
pub fn flip_compact(state: &mut State<3>) {
    let iteration = state.counters.link_iteration;
    if !state.compacts(iteration) {
        return;
    }
    for t in 0..state.status.len() {
        if state.status[t].flags & CHECK != 0 {
            state.append((iteration as usize + 1) & 1, t as u32);
        }
    }
}
