//! The edges of a 3D mesh in the filtration, which in 2D are the facets.

use super::{
    super::{complex::Complex, voronoi::VoronoiShapes},
    values::Radii,
};
use crate::geometry::{Euclidean, is_obtuse};

/// The edges, each with the squares of the radii from which on it is something: see [`Interval`](super::Interval).
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
    /// Returns the edges that are no facets, from the squared radii of the simplices and the facets.
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
        let mut ring = Vec::new();
        for t in 0..complex.simplices.len() {
            for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
                if found[t] >> EDGE[i][j] & 1 == 1 {
                    continue;
                }
                let [v, a] = [i, j].map(|corner| complex.simplices[t][corner]);
                let [p, q] = [complex.point(v), complex.point(a)];
                let is_closed = <Euclidean as VoronoiShapes<3, 4>>::ring(complex, v, a, t, &mut ring);
                let mut is_attached = false;
                let mut regular = f64::INFINITY;
                let mut interior = if is_closed { 0.0 } else { f64::INFINITY };
                for (place, &u) in ring.iter().enumerate() {
                    let u = u as usize;
                    let Some([i, j, k, l]) = corners(complex, u, v, a) else { continue };
                    found[u] |= 1 << EDGE[i][j];
                    interior = largest(interior, simplices[u]);
                    regular = smallest(regular, simplices[u]);
                    // The facet to the next tetrahedron, and that before the first one of an open ring.
                    let before = (place == 0 && !is_closed).then_some((l, k));
                    for (opposite, third) in [Some((k, l)), before].into_iter().flatten() {
                        is_attached |= is_obtuse(complex.point(complex.simplices[u][third]), p, q);
                        regular = smallest(regular, facets[index.of(complex, u, opposite)]);
                    }
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

/// Returns the places of `v` and `a` in a tetrahedron, and of the others so that all four are an even permutation.
fn corners(complex: &Complex<'_, 3, 4>, t: usize, v: u32, a: u32) -> Option<[usize; 4]> {
    let place = |v: u32| complex.simplices[t].iter().position(|&w| w == v);
    let (i, j) = (place(v)?, place(a)?);
    let k = *super::super::voronoi::THIRD[i].get(j)?;
    Some([i, j, k, 6 - i - j - k])
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
    /// The place of the first facet that is listed with each simplex, or would be.
    first: Vec<u32>,
}

impl FacetIndex {
    fn new<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Self {
        let mut count = 0;
        let first = |t: usize| {
            let first = count;
            count += (0..N).filter(|&k| is_listed(complex, t, k)).count() as u32;
            first
        };
        FacetIndex { first: (0..complex.simplices.len()).map(first).collect() }
    }

    fn of<const D: usize, const N: usize>(&self, complex: &Complex<'_, D, N>, t: usize, k: usize) -> usize {
        let (t, k) = match complex.across(t, k) {
            Some(across) if across < t => (across, complex.facet_towards(across, t)),
            _ => (t, k),
        };
        self.first[t] as usize + (0..k).filter(|&l| is_listed(complex, t, l)).count()
    }
}

/// Returns whether facet `k` of simplex `t` is listed with it: whether it is not the facet of a simplex with a lower index.
pub(super) fn is_listed<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, t: usize, k: usize) -> bool {
    complex.across(t, k).is_none_or(|across| t < across)
}
