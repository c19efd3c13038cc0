//! The first simplices, and which of them each point lies in.

use crate::dimension::Dimension;
use crate::gpu::dim::Corners;
use crate::gpu::layout::{NONE, Waiting};

use crate::reference::State;
use crate::reference::dim::{OwnState, ReferenceDim};
use crate::reference::state::{replaced, slot};

/// Writes the simplices that Phase 1 starts with: a positively oriented one and the infinite ones
/// around it.
///
/// The first slot of infinity holds `first`, and slot 1 + k after it the one beyond its facet k:
/// the facet's corners and infinity.
pub fn start<const D: usize>(state: &mut State<D>, first: Corners<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    state.first = first;
    let infinite = state.params.infinite;
    let base = Dimension::<D>::SLOTS_PER_POINT * infinite;
    let outer = |k: usize| base + 1 + k as u32;
    let around: Vec<u32> = (0..=D).map(|k| 4 * outer(k) + D as u32).collect();
    state.simplices[base as usize] = slot(first);
    state.neighbors[base as usize] = slot(around);
    for k in 0..=D {
        let corners = Dimension::<D>::facet(k);
        let mut vertices: Vec<u32> = corners.iter().map(|&c| first.as_ref()[c]).collect();
        vertices.push(infinite);
        // Beyond the ridge opposite a corner, the infinite simplex of the facet opposite that
        // corner.
        let beyond = |&corner: &usize| {
            let face = Dimension::<D>::facet(corner).iter().position(|&c| c == k);
            4 * outer(corner) + face.expect("facets share all corners but two") as u32
        };
        let mut neighbors: Vec<u32> = corners.iter().map(beyond).collect();
        neighbors.push(4 * base + k as u32);
        state.simplices[outer(k) as usize] = slot(vertices);
        state.neighbors[outer(k) as usize] = slot(neighbors);
    }
    state.own.occupy(infinite, D as u32 + 2);
    state.counters.inserted = D as u32 + 1;
}

/// Lists all points and locates them in the first simplices, with D + 1 orientations each. One
/// invocation per point.
///
/// Seen from the interior point, the facets of the first simplex divide all directions.
pub fn locate<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    let first = state.first;
    let infinite = state.params.infinite;
    state.counters.merged = state.merged.iter().filter(|&&merged| merged).count() as u32;
    let base = Dimension::<D>::SLOTS_PER_POINT * infinite;
    for point in 0..infinite {
        let tet = if first.as_ref().contains(&point) || state.merged[point as usize] {
            NONE
        } else {
            // The interior point, not infinity, whose number it has.
            let orient = |corners| state.orient_finite(corners);
            let k = Dimension::<D>::child_of(first, infinite, point, orient);
            if orient(replaced(first, k, point)) < 0 { base + 1 + k as u32 } else { base }
        };
        state.waiting[point as usize] = Waiting { point, tet };
    }
}
