//! The edges of a 3D mesh in the filtration, which in 2D are the facets.

use super::{
    super::{
        complex::Complex,
        voronoi::{THIRD, VoronoiShapes, place},
    },
    values::Radii,
};
use crate::{
    geometry::{Euclidean, is_obtuse},
    index::NONE,
    mesh::Csr,
};

/// The edges, each with the squares of the radii from which on it is something: see
/// [`Interval`](super::Interval).
#[derive(Debug, Clone, Default)]
pub struct Edges {
    pub(super) edges: Vec<[u32; 2]>,
    /// The squared radius of the smallest sphere through both vertices; infinite if the sphere
    /// contains another vertex.
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
    fn edges(radii: &Radii<D, N>, simplices: &[f64], facets: &[f64]) -> Edges;
}

impl AlphaEdges<2, 3> for Euclidean {
    fn edges(_: &Radii<2, 3>, _: &[f64], _: &[f64]) -> Edges {
        Edges::default()
    }
}

impl AlphaEdges<3, 4> for Euclidean {
    fn edges(radii: &Radii<3, 4>, simplices: &[f64], facets: &[f64]) -> Edges {
        let complex = &radii.mesh.complex;
        let vertices = complex.points().len();
        let places = facet_places(complex);
        // Only in a broken mesh a facet is not listed.
        let own = |t: usize, k: usize| facets.get(places[t][k] as usize).copied().unwrap_or(f64::INFINITY);
        let mut edges = Edges::with_capacity((vertices + facets.len()).saturating_sub(complex.simplices.len()));
        // The last vertex from which each vertex was reached, and the edge between both.
        let mut reached = vec![(NONE, 0u32); vertices];
        let stars = Csr::stars(&complex.simplices, vertices);
        for v in 0..vertices as u32 {
            for &t in stars.of(v) {
                let (simplex, neighbors) = complex.row(t as usize);
                let corners = complex.corners_of(&simplex);
                let i = place(&simplex, v);
                // The edges to higher vertices, one bit for each: nothing could predict a branch for
                // each.
                let mut higher = 0u32;
                for (j, &w) in simplex.iter().enumerate() {
                    higher |= u32::from(w > v) << j;
                }
                while higher != 0 {
                    let j = higher.trailing_zeros() as usize & 3;
                    higher &= higher - 1;
                    let (from, edge) = &mut reached[simplex[j] as usize];
                    if *from != v {
                        (*from, *edge) = (v, edges.edges.len() as u32);
                        edges.push([v, simplex[j]], radii.edge([v, simplex[j]]), t);
                    }
                    let e = *edge as usize;
                    // (i, j, k, l) is an even permutation, so that around the edge each facet is
                    // opposite l of one tetrahedron, and each vertex is its k; but for the last ones
                    // of a ring that is not closed. Only in a broken mesh i is j.
                    let k = THIRD[i][j] & 3;
                    let l = 6usize.wrapping_sub(i + j + k) & 3;
                    let mut regular = smallest(simplices[t as usize], own(t as usize, l));
                    let mut is_attached = is_obtuse(corners[k], corners[i], corners[j]);
                    edges.interior[e] = largest(edges.interior[e], simplices[t as usize]);
                    if neighbors[k] == NONE {
                        regular = smallest(regular, own(t as usize, k));
                        is_attached |= is_obtuse(corners[l], corners[i], corners[j]);
                    }
                    if neighbors[k] == NONE || neighbors[l] == NONE {
                        edges.interior[e] = largest(edges.interior[e], f64::INFINITY);
                    }
                    edges.regular[e] = smallest(edges.regular[e], regular);
                    if is_attached {
                        edges.own[e] = f64::INFINITY;
                    }
                }
            }
        }
        edges
    }
}

impl Edges {
    fn with_capacity(count: usize) -> Self {
        Edges {
            edges: Vec::with_capacity(count),
            own: Vec::with_capacity(count),
            regular: Vec::with_capacity(count),
            interior: Vec::with_capacity(count),
            simplex: Vec::with_capacity(count),
        }
    }

    /// Appends an edge of a simplex, with its own squared radius, as if nothing were around it.
    pub(super) fn push(&mut self, edge: [u32; 2], own: f64, simplex: u32) {
        self.edges.push(edge);
        self.own.push(own);
        self.regular.push(f64::INFINITY);
        self.interior.push(0.0);
        self.simplex.push(simplex);
    }
}

/// Returns the smaller of two squared radii, and what is not known if one is not.
#[inline(always)]
pub(super) fn smallest(a: f64, b: f64) -> f64 {
    // Numbers that are not negative are in the order of their bits, and `UNKNOWN` is negative.
    f64::from_bits((a.to_bits() as i64).min(b.to_bits() as i64) as u64)
}

/// Returns the larger of two squared radii, and what is not known if one is not.
#[inline(always)]
pub(super) fn largest(a: f64, b: f64) -> f64 {
    f64::from_bits(a.to_bits().max(b.to_bits()))
}

/// Returns for each simplex the places of its facets in the list that has each facet with the
/// simplex of the lower index.
fn facet_places<const D: usize, const N: usize>(complex: &Complex<'_, D, N>) -> Vec<[u32; N]> {
    let mut places = vec![[NONE; N]; complex.simplices.len()];
    let mut count = 0;
    for t in 0..places.len() {
        for k in (0..N).filter(|&k| is_listed(complex, t, k)) {
            places[t][k] = count;
            if let Some(across) = complex.across(t, k)
                && let Some(place) = places[across].get_mut(complex.facet_towards(across, t))
            {
                *place = count;
            }
            count += 1;
        }
    }
    places
}

/// Returns whether facet `k` of simplex `t` is listed with it: whether it is not the facet of a
/// simplex with a lower index.
pub(super) fn is_listed<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, t: usize, k: usize) -> bool {
    complex.across(t, k).is_none_or(|across| t < across)
}
