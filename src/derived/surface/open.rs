//! Surfaces with a boundary: without the facets that only close the gaps between the points.
//!
//! Such a facet is much longer than the sampling around it allows, so that it spans an empty ball that
//! is much larger than those of its neighbours; or it is a facet of the hull beyond which the evidence
//! does not see the outside.

use super::{
    super::{sets::DisjointSets, sorted::Sorted},
    boundary::Boundary,
    evidence::{Beyond, Hints},
    neighbors::{Tree, median},
};
use crate::{
    geometry::{Euclidean, Geometry, facet, vector},
    index::NONE,
    parallel::{self, Threads},
};
use rustc_hash::FxHashSet;

/// What becomes of the facets of a [`Surface`](crate::Surface) that only close gaps between the points.
///
/// # Examples
///
/// ```
/// let mut options: gdel::SurfaceOptions = Default::default();
/// options.open = gdel::Open::Auto;
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Open {
    /// They stay: the surface is closed, as a print, a volume and a collider need it.
    #[default]
    Never,
    /// They are left out if they are more than a tenth of the area, as in terrain, a wall or one side of
    /// a statue. The surface then has a boundary. The few that close the holes of a scanned solid stay.
    Auto,
}

/// The surface is open if at least this share of its area closes gaps.
const OPEN_SHARE: f64 = 0.1;

/// The number of neighbours that the sampling around a vertex is measured by.
const NEIGHBORS: usize = 6;

/// A facet closes a gap if it is so many times longer than its vertices are far from their neighbours.
const FACTOR: f64 = 4.0;

/// Facets are looked at one by one only if they are so many times longer than usual.
const LEAST_FACTOR: f64 = 3.0;

/// The number of vertices that is worth handing to another thread.
const GRAIN: usize = 1 << 10;

/// The facets that close gaps.
#[derive(Debug)]
pub(super) struct Gaps {
    pub(super) is_gap: Vec<bool>,
    /// Whether they are a large share of the surface.
    pub(super) is_open: bool,
}

impl Gaps {
    /// Finds the facets of a surface that close gaps: the long ones, and those that are unseen.
    pub(super) fn find<const D: usize, const N: usize>(
        boundary: &Boundary<D>,
        vertices: &[[f64; D]],
        unseen: &Unseen<D>,
    ) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let facets = &boundary.facets;
        let corners = |facet: &[u32; D]| facet.map(|v| vertices[v as usize]);
        let mut lengths: Vec<f64> = parallel::joined(parallel::map_ranges(Threads::All, facets.len(), |range| {
            facets[range].iter().map(|facet| longest(&corners(facet))).collect()
        }));
        let usual = median(&mut lengths.clone()).unwrap_or(0.0);
        // Most surfaces are closed, and have hardly a facet to look at.
        lengths.iter_mut().filter(|length| **length <= LEAST_FACTOR * usual).for_each(|length| *length = 0.0);
        let mut is_asked = vec![false; vertices.len()];
        for (facet, _) in facets.iter().zip(&lengths).filter(|&(_, &length)| length > 0.0) {
            facet.iter().for_each(|&v| is_asked[v as usize] = true);
        }
        let spacings = spacings(vertices, &is_asked);
        let is_gap: Vec<bool> = facets
            .iter()
            .zip(&lengths)
            .map(|(facet, &length)| {
                let spacing = facet.iter().map(|&v| spacings[v as usize]).fold(0.0, f64::max);
                let is_unseen = || unseen.facets.contains(&sorted(facet.map(|v| boundary.sources[v as usize])));
                length > FACTOR * spacing && length > 0.0 || !unseen.facets.is_empty() && is_unseen()
            })
            .collect();
        let sum = |of: &dyn Fn(usize) -> bool| {
            let areas = (0..).zip(facets).filter(|&(f, _)| of(f)).map(|(_, facet)| area(&corners(facet)));
            areas.fold(0.0, |sum, area| sum + area)
        };
        let open = unseen.hidden + sum(&|f| is_gap[f]);
        Gaps { is_gap, is_open: open > 0.0 && open >= OPEN_SHARE * (unseen.hidden + sum(&|_| true)) }
    }
}

/// What is on the hull where the outside is not beyond.
#[derive(Debug, Default)]
pub(super) struct Unseen<const D: usize> {
    /// The facets, by the names of their vertices in ascending order.
    facets: FxHashSet<[u32; D]>,
    /// The area of those with the outside within, which the boundary of the solid does not have.
    hidden: f64,
}

impl<const D: usize> Unseen<D> {
    pub(super) fn new<const N: usize>(mesh: &Sorted<D, N>, is_inside: &[bool], hints: &Hints<D>) -> Self
    where
        Euclidean: Geometry<D, N>,
    {
        let complex = &mesh.complex;
        let mut unseen = Unseen { facets: FxHashSet::default(), hidden: 0.0 };
        for (t, &is_inside) in is_inside.iter().enumerate() {
            for k in (0..N).filter(|&k| complex.across(t, k).is_none()) {
                let vertices: [u32; D] = facet(&complex.simplices[t], k);
                match hints.beyond_facet_of(complex, vertices) {
                    Beyond::Inside if !is_inside => unseen.hidden += area(&vertices.map(|v| complex.point(v))),
                    Beyond::Inside | Beyond::Unknown => _ = unseen.facets.insert(sorted(mesh.given(vertices))),
                    Beyond::Outside => {}
                }
            }
        }
        unseen
    }
}

/// Returns the area of a facet, up to a factor.
fn area<const D: usize, const N: usize>(corners: &[[f64; D]; D]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    vector::norm(Euclidean::facet_normal(corners))
}

/// Returns the vertices of a facet in ascending order.
fn sorted<const D: usize>(mut facet: [u32; D]) -> [u32; D] {
    facet.sort_unstable();
    facet
}

/// Returns the length of the longest edge of a facet.
fn longest<const D: usize>(corners: &[[f64; D]; D]) -> f64 {
    let squared = |k: usize| vector::squared_norm(vector::minus(corners[k], corners[(k + 1) % D]));
    (0..D).map(squared).fold(0.0, f64::max).sqrt()
}

/// Returns how far each vertex that is asked for is from its neighbours.
fn spacings<const D: usize>(vertices: &[[f64; D]], is_asked: &[bool]) -> Vec<f64> {
    if !is_asked.contains(&true) {
        return vec![0.0; vertices.len()];
    }
    let tree = Tree::new(vertices);
    let parts = parallel::map_grains(Threads::All, vertices.len(), GRAIN, |range| {
        let mut near = Vec::new();
        range
            .map(|v| {
                if !is_asked[v] {
                    return 0.0;
                }
                // The vertex itself is among them.
                tree.nearest(vertices[v], NEIGHBORS + 1, &mut near);
                near.last().map_or(0.0, |&(squared, _)| squared.sqrt())
            })
            .collect::<Vec<f64>>()
    });
    parallel::joined(parts)
}

/// Removes facets, and the vertices that no other facet has. Vertices at which only corners still touch
/// are split, as in [`Boundary::new`]. `vertices` has the positions, and `sources` of the boundary one
/// entry for each.
pub(super) fn remove<const D: usize>(boundary: &mut Boundary<D>, vertices: &mut Vec<[f64; D]>, is_gap: &[bool]) {
    let mut numbers = vec![NONE; boundary.facets.len()];
    let kept: Vec<usize> = (0..is_gap.len()).filter(|&f| !is_gap[f]).collect();
    for (number, &f) in (0..).zip(&kept) {
        numbers[f] = number;
    }
    let renumbered = |mate: u32| match numbers.get(mate as usize / D) {
        Some(&number) if number != NONE => number * D as u32 + mate % D as u32,
        _ => NONE,
    };
    boundary.mates = kept.iter().map(|&f| boundary.mates[f].map(renumbered)).collect();
    boundary.facets = kept.iter().map(|&f| boundary.facets[f]).collect();
    let (sources, positions) = (std::mem::take(&mut boundary.sources), std::mem::take(vertices));
    // Numbers the cycles of facets around the old vertices, which then are in their places.
    boundary.split_vertices();
    *vertices = boundary.sources.iter().map(|&v| positions[v as usize]).collect();
    boundary.sources.iter_mut().for_each(|v| *v = sources[*v as usize]);
}

/// Returns the number of curves that bound the facets, in 2D that of open curves, and the number of their edges.
pub(super) fn rims<const D: usize>(boundary: &Boundary<D>, vertices: usize) -> [usize; 2] {
    let rim = boundary.mates.iter().enumerate().flat_map(|(f, mates)| {
        let open = (0..D).filter(|&k| mates[k] == NONE);
        open.map(move |k| (f, k))
    });
    if D == 2 {
        let ends = rim.count();
        return [ends / 2, ends];
    }
    let mut sets = DisjointSets::new(vertices);
    let (mut curves, mut edges) = (0, 0);
    for (f, k) in rim {
        let facet = boundary.facets[f];
        edges += 1;
        curves += usize::from(!sets.unite(facet[(k + 1) % D], facet[(k + 2) % D]));
    }
    [curves, edges]
}
