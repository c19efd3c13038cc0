//! The first triangles, and which of them each point lies in.

use crate::d2::gpu::layout::PLANE_BLOCK;
use crate::gpu::layout::{NONE, Waiting};

use crate::reference::d2::State;
use crate::reference::d2::split::child_of;
use crate::reference::d2::state::{replaced, words};

/// The triangles that a run starts with: a positively oriented one and the three infinite ones around it.
///
/// The first slot of infinity holds `first`, the k-th after it the one beyond its edge k: the edge's ends and infinity.
pub fn start(state: &mut State, first: [u32; 3]) {
    state.first = first;
    let infinite = state.params.infinite;
    let base = PLANE_BLOCK * infinite;
    let outer = |k: usize| base + 1 + k as u32;
    state.triangles[base as usize] = words(first);
    state.neighbors[base as usize] = words([0, 1, 2].map(|k| 4 * outer(k) + 2));
    for k in 0..3 {
        let (next, previous) = ((k + 1) % 3, (k + 2) % 3);
        let slot = outer(k) as usize;
        state.triangles[slot] = words([first[previous], first[next], infinite]);
        state.neighbors[slot] = words([4 * outer(previous) + 1, 4 * outer(next), 4 * base + k as u32]);
    }
    state.counters.inserted = 3;
}

/// Lists all points and locates them in the first triangles, with 3 orientations each. One thread a point.
///
/// Seen from the kernel point, the three edges of the first triangle divide all directions.
pub fn locate(state: &mut State) {
    let first = state.first;
    let infinite = state.params.infinite;
    for point in 0..infinite {
        let t = if first.contains(&point) || state.merged[point as usize] {
            NONE
        } else {
            // The kernel point, not infinity, whose number it has.
            let k = child_of(first, infinite, point, |three| state.orient_finite(three));
            let beyond = state.orient_finite(replaced(first, k, point)) < 0;
            PLANE_BLOCK * infinite + if beyond { 1 + k as u32 } else { 0 }
        };
        state.waiting[point as usize] = Waiting { point, tet: t };
    }
}
