//! The edges of a 3D mesh in the filtration, which in 2D are the facets.

use super::{
    super::{
        complex::Complex,
        voronoi::{THIRD, VoronoiShapes, place, ring},
    },
    values::Radii,
};
use crate::geometry::{Euclidean, is_obtuse};

/// The edges, each with the squares of the radii from which on it is something: see
/// [`Interval`](super::Interval).
#[derive(Debug, Clone, Default)]
pub struct Edges {
    pub(super) edges: Vec<[u32; 2]>,
    /// Of the smallest sphere through both vertices; infinite if that contains another vertex.
    pub(super) own: Vec<f64>,
    pub(super) regular: Vec<f64>,
    pub(super) interior: Vec<f64>,
    /// A simplex of each edge.
    pub(super) simplex: Vec<u32>,
}

/// What differs between the dimensions in alpha shapes.
#[doc(hidden)]
pub trait AlphaEdges<const D: usize, const N: usize>: VoronoiShapes<D, N> {
    /// Returns the edges that are no facets, from the squared radii of the simplices and the
    /// facets.
    fn edges(radii: &Radii<'_, D, N>, simplices: &[f64], facets: &[f64]) -> Edges;
}

impl AlphaEdges<2, 3> for Euclidean {
    fn edges(_: &Radii<'_, 2, 3>, _: &[f64], _: &[f64]) -> Edges {
        Edges::default()
    }
}

/// The place of the edge between two corners of a tetrahedron among its six.
const EDGE: [[u8; 4]; 4] = [[6, 0, 1, 2], [0, 6, 3, 4], [1, 3, 6, 5], [2, 4, 5, 6]];

impl AlphaEdges<3, 4> for Euclidean {
    fn edges(radii: &Radii<'_, 3, 4>, simplices: &[f64], facets: &[f64]) -> Edges {
        let complex = &radii.complex;
        let index = FacetIndex::new(complex);
        let mut edges = Edges::default();
        // The edges of each tetrahedron that have been found.
        let mut found = vec![0u8; complex.simplices.len()];
        // Only in a broken mesh a facet is not listed where it should be.
        let own = |place: usize| facets.get(place).copied().unwrap_or(f64::INFINITY);
        let mut around = Vec::new();
        for t in 0..complex.simplices.len() {
            for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                if found[t] >> EDGE[i][j] & 1 == 1 {
                    continue;
                }
                let [v, a] = [i, j].map(|corner| complex.simplices[t][corner]);
                let [p, q] = [complex.point(v), complex.point(a)];
                let is_closed = ring(complex, v, a, t, &mut around);
                let mut is_attached = false;
                let mut regular = f64::INFINITY;
                let mut interior = if is_closed { 0.0 } else { f64::INFINITY };
                // The facet to the next tetrahedron, as that one sees it when it is there.
                let mut facet_before: Option<(usize, usize)> = None;
                let corners_of = |u: usize| corners(&complex.simplices[u], v, a);
                if is_closed && let Some(&last) = around.last() {
                    let [_, _, k, _] = corners_of(last as usize);
                    facet_before = Some((last as usize, k));
                }
                for &u in &around {
                    let u = u as usize;
                    let [i, j, k, l] = corners_of(u);
                    found[u] |= 1 << EDGE[i][j];
                    interior = largest(interior, simplices[u]);
                    regular = smallest(regular, simplices[u]);
                    // The facet opposite l is that opposite k of the tetrahedron before, and listed
                    // with the lower index.
                    let place = match facet_before {
                        Some((before, k)) if before < u => index.of(before, k),
                        _ => index.of(u, l),
                    };
                    regular = smallest(regular, own(place));
                    is_attached |= is_obtuse(complex.point(complex.simplices[u][k]), p, q);
                    facet_before = Some((u, k));
                }
                // The last one of an open ring.
                if let (false, Some((u, k))) = (is_closed, facet_before) {
                    let [_, _, _, l] = corners_of(u);
                    regular = smallest(regular, own(index.of(u, k)));
                    is_attached |= is_obtuse(complex.point(complex.simplices[u][l]), p, q);
                }
                edges.edges.push([v.min(a), v.max(a)]);
                edges.own.push(if is_attached { f64::INFINITY } else { radii.edge([v, a]) });
                edges.regular.push(regular);
                edges.interior.push(interior);
                edges.simplex.push(t as u32);
            }
        }
        edges
    }
}

/// Returns the places of `v` and `a` in a tetrahedron, and of the others so that all four are an
/// even permutation.
fn corners(simplex: &[u32; 4], v: u32, a: u32) -> [usize; 4] {
    let (i, j) = (place(simplex, v), place(simplex, a));
    // Only in a broken mesh both are the same.
    let k = THIRD[i][j] & 3;
    [i, j, k, 6usize.wrapping_sub(i + j + k) & 3]
}

/// Returns the smaller number, and NaN if one is NaN.
pub(super) fn smallest(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// Returns the larger number, and NaN if one is NaN.
pub(super) fn largest(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// The places of the facets in the list that has each facet with the simplex of the lower index.
struct FacetIndex {
    /// For each simplex, the place of the first facet that is listed with it, or would be, times
    /// 16, and a bit for each of its facets that is.
    first: Vec<u64>,
}

impl FacetIndex {
    fn new<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Self {
        let mut count = 0;
        let first = |t: usize| {
            let listed: u64 = (0..N).map(|k| u64::from(is_listed(complex, t, k)) << k).sum();
            let first = count << 4 | listed;
            count += u64::from(listed.count_ones());
            first
        };
        FacetIndex { first: (0..complex.simplices.len()).map(first).collect() }
    }

    /// Returns the place of facet `k` of simplex `t`, which is listed with it.
    fn of(&self, t: usize, k: usize) -> usize {
        let first = self.first[t];
        let before = first & 15 & ((1 << k) - 1);
        ((first >> 4) + u64::from(before.count_ones())) as usize
    }
}

/// Returns whether facet `k` of simplex `t` is listed with it: whether it is not the facet of a
/// simplex with a lower index.
pub(super) fn is_listed<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, t: usize, k: usize) -> bool {
    complex.across(t, k).is_none_or(|across| t < across)
}
