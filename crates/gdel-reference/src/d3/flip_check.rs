//! Which flip a tetrahedron proposes (§3.1, §4.2).

use gdel::internals::d3::mesh::FACETS;
use gdel::internals::gpu::layout::{CHECK, EDGE_SHIFT, FACET_SHIFT, FLIP_23, FLIP_32, KIND_SHIFT, SUSPECT_SHIFT};

use crate::State;

/// Returns the outcome for a tetrahedron, and the tetrahedra that its proposed flip would change:
/// it proposes to flip the first facet that is not locally Delaunay and can be flipped.
pub(super) fn proposal(state: &State<3>, t: u32) -> (u32, Vec<u32>) {
    let flags = state.status[t as usize].flags;
    let mut check = flags & CHECK;
    let mut suspect = flags >> SUSPECT_SHIFT & CHECK & !check;
    let tet = state.corners(t);
    for k in 0..4 {
        if check >> k & 1 == 0 {
            continue;
        }
        let (u, face) = state.across(t, k);
        let theirs = u < t && state.status[u as usize].flags >> face & 1 != 0;
        let e = state.corners(u)[face];
        if theirs || !state.inside(tet, e) {
            check &= !(1 << k);
            continue;
        }
        let corners = FACETS[k];
        let x = corners.map(|c| tet[c]);
        let negative: Vec<usize> = (0..3).filter(|&i| state.orient([x[i], x[(i + 1) % 3], tet[k], e]) < 0).collect();
        let found = |kind: u32, edge: usize| {
            let flip = kind << KIND_SHIFT | (k as u32) << FACET_SHIFT | (edge as u32) << EDGE_SHIFT;
            flip | suspect << SUSPECT_SHIFT | check
        };
        match negative[..] {
            [] => return (found(FLIP_23, 0), vec![t, u]),
            [i] => {
                let opposite = (i + 2) % 3;
                let (w, _) = state.across(t, corners[opposite]);
                let there = state.corners(u).iter().position(|&v| v == x[opposite]);
                let there = there.expect("neighbours share a facet");
                if state.across(u, there).0 == w {
                    return (found(FLIP_32, i), vec![t, u, w]);
                }
            }
            _ => {}
        }
        check &= !(1 << k);
        suspect |= 1 << k;
    }
    (suspect << SUSPECT_SHIFT | check, Vec::new())
}
