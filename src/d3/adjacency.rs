//! The vertices of a cavity, and adjacencies among the new tetrahedra in it: each directed edge of
//! its boundary belongs to one facet, and its reverse to the adjacent facet.

use crate::{
    d3::triangulation::state,
    index::BuildIndexHasher,
    predicates::filter::{PredicatesAt, Row},
    slots::{Places, Slots},
};
use std::collections::HashMap;

/// The [`FACETS`](crate::d3::mesh::FACETS) of a tetrahedron, beginning so that its last vertex, which may be infinite, comes
/// last.
pub(crate) const CAVITY_FACETS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]];

/// Cavities of more vertices than places have no more rows, and use a hash table instead of the
/// matrix, which has 64² entries, or 16 KiB: it fits into a level-1 cache.
const PLACES: usize = 1 << BITS;
const BITS: u32 = 6;
const EDGES: usize = PLACES * PLACES;
/// The place of all vertices for which there is no other.
const LAST: usize = PLACES - 1;

/// A facet of a cavity.
#[derive(Clone, Copy)]
pub(crate) struct Facet {
    /// The tetrahedron outside the cavity: 4·(tetrahedron) + (facet as it is numbered there).
    pub(crate) beyond: u32,
    /// The places of its corners, counter-clockwise as seen from outside the cavity; an infinite vertex
    /// comes last.
    pub(crate) places: FacetPlaces,
}

/// The places of a facet's corners, of [`BITS`] bits each: the first in the lowest.
#[derive(Clone, Copy)]
pub(crate) struct FacetPlaces(u32);

impl FacetPlaces {
    #[inline]
    pub(crate) fn new([a, b, c]: [u32; 3]) -> Self {
        FacetPlaces(a | b << BITS | c << (2 * BITS))
    }

    #[inline]
    fn get(self, k: u32) -> usize {
        (self.0 >> (k * BITS)) as usize % PLACES
    }

    /// Returns the places of (c, b, a).
    #[inline]
    fn reversed(self) -> Self {
        let middle = self.0 & (PLACES as u32 - 1) << BITS;
        FacetPlaces((self.0 >> (2 * BITS)) | middle | (self.0 % PLACES as u32) << (2 * BITS))
    }

    /// Returns numbers of the edges from a to b, b to c, and c to a.
    #[inline]
    fn edges(self) -> [usize; 3] {
        [self.0, self.0 >> BITS, self.0 >> (2 * BITS) | self.0 << BITS].map(|x| x as usize % EDGES)
    }
}

/// The vertices of a cavity, with their places and rows.
pub(crate) struct CavityVertices<P> {
    /// The place of each mesh vertex in `vertices`, valid only if the vertex there is the same. So
    /// nothing needs clearing.
    place: P,
    vertices: [u32; PLACES],
    rows: [Row; PLACES],
    count: usize,
    /// Whether there are more vertices than places.
    is_large: bool,
}

impl<P: Places> CavityVertices<P> {
    /// Creates the list with a table of the mesh's vertices, the infinite one included.
    pub(crate) fn new(place: P) -> Self {
        CavityVertices { place, vertices: [0; PLACES], rows: [Row::NONE; PLACES], count: 0, is_large: false }
    }

    pub(crate) fn clear(&mut self) {
        (self.count, self.is_large) = (0, false);
    }

    /// Returns the place of `v`, which has been given one; the last if there was none left. The masks
    /// here and elsewhere have no effect except that they spare the bounds checks.
    #[inline]
    pub(crate) fn place_of(&self, v: u32) -> u32 {
        self.place.place(v) % PLACES as u32
    }

    /// Gives `v`, which the caller has claimed, a place if it has none, and returns its place.
    ///
    /// Whether it has one cannot be predicted, and a wrong prediction takes longer than to write
    /// once more what is there. So there is no branch.
    #[inline]
    pub(crate) fn give_place<const W: bool>(&mut self, v: u32, here: &PredicatesAt<'_, '_, 3, W>) -> u32 {
        let known = self.place_of(v) as usize;
        let is_new = (known >= self.count) | (self.vertices[known % PLACES] != v);
        let place = if is_new { self.count } else { known };
        self.place.set_place(v, place as u32);
        if place == LAST {
            self.is_large = true;
        } else {
            self.vertices[place % PLACES] = v;
            self.rows[place % PLACES] = here.row(v);
            self.count += usize::from(is_new);
        }
        place as u32
    }

    /// Returns the rows of the vertices at these places.
    #[inline]
    pub(crate) fn rows(&self, places: FacetPlaces) -> [&Row; 3] {
        [0, 1, 2].map(|k| &self.rows[places.get(k)])
    }

    /// Returns the vertices at these places.
    #[inline]
    fn at(&self, places: FacetPlaces) -> [u32; 3] {
        [0, 1, 2].map(|k| self.vertices[places.get(k)])
    }
}

/// Finds the facets on both sides of every edge of a closed surface.
pub(crate) struct EdgeMap {
    /// Entry (i, j) belongs to the directed edge between the vertices with these places. Every edge
    /// that is looked up has been entered, because the surface is closed, so nothing needs clearing
    /// here either.
    matrix: Box<[u32; EDGES]>,
    /// The same map from directed edges, for larger cavities.
    table: HashMap<(u32, u32), u32, BuildIndexHasher>,
}

impl EdgeMap {
    pub(crate) fn new() -> Self {
        EdgeMap { matrix: Box::new([0; EDGES]), table: HashMap::default() }
    }

    /// Fills a cavity with tetrahedra of the vertex `p` and each of its `facets`, in the slots
    /// `new`.
    pub(crate) fn fill<P: Places>(
        &mut self,
        slots: &mut impl Slots<4>,
        p: u32,
        facets: &[Facet],
        new: &[u32],
        vertices: &CavityVertices<P>,
    ) {
        if vertices.is_large {
            return self.fill_large(slots, p, facets, new);
        }
        let matrix = &mut *self.matrix;
        for (&Facet { beyond, places }, &t) in facets.iter().zip(new) {
            let [a, b, c] = vertices.at(places);
            slots.set_simplex(t, [p, a, b, c]);
            slots.set_neighbor(beyond, 4 * t);
            let [ab, bc, ca] = places.edges();
            matrix[bc] = 4 * t + 1;
            matrix[ca] = 4 * t + 2;
            matrix[ab] = 4 * t + 3;
        }
        for (&Facet { beyond, places }, &t) in facets.iter().zip(new) {
            // From c to b, b to a, and a to c.
            let [beside_a, beside_c, beside_b] = places.reversed().edges().map(|edge| matrix[edge]);
            slots.set_neighbors(t, [beyond, beside_a, beside_b, beside_c]);
        }
    }

    /// The same where vertices share a place: the tetrahedra outside have the corners.
    #[cold]
    fn fill_large(&mut self, slots: &mut impl Slots<4>, p: u32, facets: &[Facet], new: &[u32]) {
        self.table.clear();
        for (&Facet { beyond, .. }, &t) in facets.iter().zip(new) {
            let [a, b, c] = corners_from_inside(slots, beyond);
            slots.set_simplex(t, [p, a, b, c]);
            slots.set_neighbor(beyond, 4 * t);
            self.table.extend([((b, c), 4 * t + 1), ((c, a), 4 * t + 2), ((a, b), 4 * t + 3)]);
        }
        for (&Facet { beyond, .. }, &t) in facets.iter().zip(new) {
            let [a, b, c] = corners_from_inside(slots, beyond);
            // Only what is no triangulation has edges without another side.
            let across = |edge| self.table.get(&edge).copied().unwrap_or(0);
            slots.set_neighbors(t, [beyond, across((c, b)), across((a, c)), across((b, a))]);
        }
    }
}

/// Returns the corners of a facet, counter-clockwise as seen from the tetrahedron that it belongs to;
/// an infinite vertex comes last.
fn corners_from_inside(slots: &impl Slots<4>, facet: u32) -> [u32; 3] {
    let mut v = slots.simplex(facet >> 2);
    v[0] &= !state::MASK;
    let [a, b, c] = CAVITY_FACETS[facet as usize & 3].map(|k| v[k]);
    [b, a, c]
}
