//! Which facets of the hull each Voronoi cell meets: the Voronoi diagram restricted to the hull's
//! boundary.
//!
//! The diagram divides a facet of the hull into convex pieces. The first one is that of a corner of
//! the facet; behind an edge of a piece that lies on a bisector is the piece of another vertex (Yan
//! et al. 2009). A cell is clipped by exactly the facets that it meets: the others cannot cut
//! anything off that these leave, because cell and hull are convex.

use super::{super::Locator, polytope::Polygon};
use crate::{
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    mesh::Csr,
    parallel::{self, Threads},
};
use rustc_hash::FxHashSet;

/// The number of facets that is worth handing to another thread.
const GRAIN: usize = 1 << 8;

/// Returns for each vertex the facets of the hull that its cell meets, as places in the list that
/// comes with them: (simplex, opposite vertex).
pub(super) fn hull_facets_of_cells<const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
) -> (Csr, Vec<(usize, usize)>)
where
    Euclidean: Geometry<D, N>,
{
    let complex = &locator.complex;
    let neighbors = locator.vertex_neighbors();
    let facets: Vec<(usize, usize)> = complex
        .neighbors
        .iter()
        .enumerate()
        .flat_map(|(t, across)| (0..N).filter(|&k| across[k] == NONE).map(move |k| (t, k)))
        .collect();
    let meetings = parallel::map_grains(Threads::All, facets.len(), GRAIN, |range| {
        let mut meetings = Vec::new();
        let mut piece = Polygon::default();
        let (mut pending, mut seen) = (Vec::new(), FxHashSet::default());
        for f in range {
            let (t, k) = facets[f];
            let vertices = facet(&complex.simplices[t], k);
            let corners = vertices.map(|v| complex.point(v));
            seen.clear();
            seen.extend(vertices);
            pending.extend(vertices);
            while let Some(v) = pending.pop() {
                let site = complex.point(v);
                piece.start(&corners.map(|p| vector::minus(p, site)), NONE);
                for &w in neighbors.of(v) {
                    let to = vector::minus(complex.point(w), site);
                    piece.halve(to, 0.5 * vector::squared_norm(to), w);
                }
                if !piece.is_empty() {
                    meetings.push([v, f as u32]);
                    pending.extend(piece.names().filter(|&w| w != NONE && seen.insert(w)));
                }
            }
        }
        meetings
    });
    let mut meetings = meetings.concat();
    parallel::sort(Threads::All, &mut meetings);
    let mut of_cells = Csr::default();
    let mut rest = meetings.as_slice();
    for v in 0..complex.points().len() as u32 {
        let (own, others) = rest.split_at(rest.partition_point(|&[w, _]| w == v));
        of_cells.push(own.iter().map(|&[_, f]| f));
        rest = others;
    }
    (of_cells, facets)
}
