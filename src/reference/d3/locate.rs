//! The first tetrahedra, and which of them each point lies in.

use crate::d3::mesh::FACETS;
use crate::gpu::layout::{BLOCK, NONE, Waiting};

use crate::reference::d3::State;
use crate::reference::d3::predicates;
use crate::reference::d3::split::child_of;
use crate::reference::d3::state::replaced;

/// The tetrahedra that Phase 1 starts with: a positively oriented one and the four infinite ones around it, in the block
/// of infinity.
///
/// Slot 0 of the block holds `first`, slot 1 + k the one beyond its facet k: the facet's corners and infinity.
pub fn start(state: &mut State, first: [u32; 4]) {
    state.first = first;
    let infinite = state.params.infinite;
    let base = infinite * BLOCK;
    let outer = |k: usize| base + 1 + k as u32;
    let slot = base as usize;
    state.tets[slot] = first;
    state.neighbors[slot] = std::array::from_fn(|k| 4 * outer(k) + 3);
    for (k, corners) in FACETS.iter().enumerate() {
        let slot = outer(k) as usize;
        state.tets[slot] = [first[corners[0]], first[corners[1]], first[corners[2]], infinite];
        state.neighbors[slot] = std::array::from_fn(|i| match i {
            3 => 4 * base + k as u32,
            // Beyond the edge opposite corner i, the infinite tetrahedron of the facet opposite that corner.
            _ => {
                let beyond = corners[i];
                let face = FACETS[beyond].iter().position(|&c| c == k).expect("facets share all corners but two");
                4 * outer(beyond) + face as u32
            }
        });
    }
    state.free[infinite as usize] &= !0x1f;
    state.counters.inserted = 4;
}

/// Lists all points and locates them in the first tetrahedra, with 4 orientations each. One thread a point.
///
/// Seen from the kernel point, the four facets of the first tetrahedron divide all directions.
pub fn locate(state: &mut State) {
    let first = state.first;
    let base = state.params.infinite * BLOCK;
    for point in 0..state.params.infinite {
        // The kernel point, not infinity, whose number it has: the predicate, not `State::orient`.
        let orient = |four: [u32; 4]| predicates::orient3d(state.width, four.map(|v| state.points[v as usize]));
        let tet = if first.contains(&point) || state.merged[point as usize] {
            NONE
        } else {
            let k = child_of(first, state.params.infinite, point, orient);
            if orient(replaced(first, k, point)) < 0 { base + 1 + k as u32 } else { base }
        };
        state.waiting[point as usize] = Waiting { point, tet };
    }
}
