//! Adjacencies among new tetrahedra: each directed edge of a cavity's boundary belongs to one
//! facet, and its reverse to the adjacent facet.

use crate::slots::Places;
use std::collections::HashMap;

/// Boundaries of more vertices than this use a hash table instead of the matrix, which has 64²
/// entries, or 16 KiB: it fits into a level-1 cache.
const MATRIX: usize = 64;

/// A facet of a cavity.
#[derive(Clone, Copy)]
pub(crate) struct Facet {
    /// Counter-clockwise as seen from outside the cavity; an infinite vertex comes last. What links
    /// facets replaces them.
    pub(crate) corners: [u32; 3],
    /// The tetrahedron outside the cavity: 4·(tetrahedron) + (facet as it is numbered there).
    pub(crate) beyond: u32,
}

/// Finds the facets on both sides of every edge of a closed surface.
pub(crate) struct EdgeMap<P> {
    /// The place of each mesh vertex in `vertices`, valid only if the vertex there is the same. So
    /// nothing needs clearing.
    place: P,
    /// The vertices of the boundary, so many.
    vertices: [u32; MATRIX],
    count: usize,
    /// Entry (i, j) belongs to the directed edge from the *i*-th to the *j*-th vertex of the
    /// boundary. Every edge that is looked up has been entered, because the surface is closed, so
    /// nothing needs clearing here either.
    matrix: Box<[u32; MATRIX * MATRIX]>,
    /// The same map from directed edges, for larger boundaries.
    table: HashMap<(u32, u32), u32, std::hash::BuildHasherDefault<EdgeHasher>>,
}

/// Hashes by a multiplication and a rotation per vertex. Edges are not chosen by an adversary.
#[derive(Default)]
struct EdgeHasher(u64);

impl std::hash::Hasher for EdgeHasher {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&b| self.write_u32(b.into()));
    }
    fn write_u32(&mut self, x: u32) {
        self.0 = (self.0 ^ u64::from(x)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }
}

/// Returns the matrix entry of an edge. The mask has no effect except that it spares the bounds
/// check.
fn cell(from: u32, to: u32) -> usize {
    (from as usize * MATRIX + to as usize) & (MATRIX * MATRIX - 1)
}

impl<P: Places> EdgeMap<P> {
    /// Creates a map with a table of the mesh's vertices, the infinite one included.
    pub(crate) fn new(place: P) -> Self {
        EdgeMap {
            place,
            vertices: [0; MATRIX],
            count: 0,
            matrix: Box::new([0; MATRIX * MATRIX]),
            table: HashMap::default(),
        }
    }

    /// Returns the place of `v` in `vertices`, where it is appended if it is new. The masks have no
    /// effect except that they spare the bounds checks.
    #[inline]
    fn place_of(&mut self, v: u32) -> u32 {
        let place = self.place.place(v);
        if (place as usize) < self.count && self.vertices[place as usize % MATRIX] == v {
            return place;
        }
        let place = self.count as u32;
        self.place.set_place(v, place);
        self.vertices[self.count % MATRIX] = v;
        self.count += 1;
        place
    }

    /// Calls `link(t, neighbors)` for the tetrahedron `t` on each facet of a closed surface, as
    /// listed in `tetrahedra`. Its first vertex is the same for all, and the others are the corners
    /// of the facet; so its neighbours are first what is beyond the facet, then those across the
    /// edges opposite the corners.
    pub(crate) fn link_all(
        &mut self,
        facets: &mut [Facet],
        tetrahedra: impl Iterator<Item = u32> + Clone,
        mut link: impl FnMut(u32, [u32; 4]),
    ) {
        // A triangulated sphere of *F* facets has *F*/2 + 2 vertices.
        if facets.len() / 2 + 2 <= MATRIX {
            self.count = 0;
            for (facet, t) in facets.iter_mut().zip(tetrahedra.clone()) {
                let [a, b, c] = facet.corners;
                let [i, j, k] = [self.place_of(a), self.place_of(b), self.place_of(c)];
                self.matrix[cell(j, k)] = 4 * t + 1;
                self.matrix[cell(k, i)] = 4 * t + 2;
                self.matrix[cell(i, j)] = 4 * t + 3;
                facet.corners = [i, j, k];
            }
            for (&Facet { corners: [i, j, k], beyond }, t) in facets.iter().zip(tetrahedra) {
                link(t, [beyond, self.matrix[cell(k, j)], self.matrix[cell(i, k)], self.matrix[cell(j, i)]]);
            }
        } else {
            self.table.clear();
            for (&Facet { corners: [a, b, c], .. }, t) in facets.iter().zip(tetrahedra.clone()) {
                self.table.extend([((b, c), 4 * t + 1), ((c, a), 4 * t + 2), ((a, b), 4 * t + 3)]);
            }
            for (&Facet { corners: [a, b, c], beyond }, t) in facets.iter().zip(tetrahedra) {
                // Only what is no triangulation has edges without another side.
                let across = |edge| self.table.get(&edge).copied().unwrap_or(0);
                link(t, [beyond, across((c, b)), across((a, c)), across((b, a))]);
            }
        }
    }
}
