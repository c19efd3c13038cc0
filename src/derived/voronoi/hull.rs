//! Which facets of the hull each Voronoi cell meets: the Voronoi diagram restricted to the hull's
//! boundary.
//!
//! The diagram divides a facet of the hull into convex pieces. The first one is that of a site nearest to a corner of
//! the facet, which without weights is the corner itself; behind an edge of a piece that lies on a bisector is the
//! piece of another vertex (Yan et al. 2009). A cell is clipped by exactly the facets that it meets: the others cannot
//! cut anything off that these leave, because cell and hull are convex.

use super::{super::Locator, polytope::Polygon, weights::Weights};
use crate::{
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    mesh::Csr,
    parallel::{self, Threads},
};
use rustc_hash::FxHashSet;

/// The number of facets that is worth handing to another thread.
const GRAIN: usize = 1 << 8;

/// Returns for each vertex on the hull all that are nearest to it, and nothing for the other points.
pub(super) fn nearest_to_corners<const D: usize, const N: usize>(locator: &Locator<'_, D, N>, on_hull: &[bool]) -> Csr
where
    Euclidean: Geometry<D, N>,
{
    let neighbors = locator.vertex_neighbors();
    let mut nearest = Csr::default();
    for (v, &on_hull) in (0..).zip(on_hull) {
        let of_corner = on_hull.then(|| {
            let corner = locator.complex.point(v);
            locator.all_nearest(neighbors, corner, locator.nearest_from(neighbors, corner, v))
        });
        nearest.push(of_corner.into_iter().flatten());
    }
    nearest
}

/// Returns for each vertex the facets of the hull that its cell meets, as places in the list that
/// comes with them: (simplex, opposite vertex). With weights, the sites nearest to the corners are given.
pub(super) fn hull_facets_of_cells<const D: usize, const N: usize>(
    locator: &Locator<'_, D, N>,
    weights: &Weights<'_>,
    nearest: Option<&Csr>,
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
            match nearest {
                None => pending.extend(vertices),
                Some(nearest) => pending.extend(vertices.iter().flat_map(|&v| nearest.of(v))),
            }
            pending.retain(|&v| seen.insert(v));
            let mut first = pending.len();
            while let Some(v) = pending.pop() {
                let is_first = pending.len() < first;
                first = first.min(pending.len());
                let site = complex.point(v);
                piece.start(&corners.map(|p| vector::minus(p, site)), NONE);
                for &w in neighbors.of(v) {
                    let to = vector::minus(complex.point(w), site);
                    piece.halve(to, weights.bisector(v, w, to), w);
                }
                if !piece.is_empty() {
                    meetings.push([v, f as u32]);
                    pending.extend(piece.names().filter(|&w| w != NONE && seen.insert(w)));
                } else if is_first {
                    // Rounding has left nothing of the corner that is nearest to this site.
                    pending.extend(neighbors.of(v).iter().copied().filter(|&w| seen.insert(w)));
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
