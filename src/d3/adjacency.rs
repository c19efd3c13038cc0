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
    /// Counter-clockwise as seen from outside the cavity; an infinite vertex comes last.
    pub(crate) corners: [u32; 3],
    /// The tetrahedron outside the cavity: 4·(tetrahedron) + (facet as it is numbered there).
    pub(crate) beyond: u32,
}

/// Finds the facets on both sides of every edge of a closed surface.
pub(crate) struct EdgeMap<P> {
    /// The place of each mesh vertex in `vertices`, valid only if the vertex there is the same. So
    /// nothing needs clearing.
    place: P,
    /// The vertices of the boundary.
    vertices: Vec<u32>,
    /// The places of each facet's corners.
    places: Vec<[u32; 3]>,
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
            vertices: Vec::with_capacity(MATRIX),
            places: Vec::new(),
            matrix: Box::new([0; MATRIX * MATRIX]),
            table: HashMap::default(),
        }
    }

    /// Returns the place of `v` in `vertices`, where it is appended if it is new.
    fn place_of(&mut self, v: u32) -> u32 {
        let place = self.place.place(v);
        if self.vertices.get(place as usize) == Some(&v) {
            return place;
        }
        let place = self.vertices.len() as u32;
        self.place.set_place(v, place);
        self.vertices.push(v);
        place
    }

    /// Calls `link(f, [a, b, c])` for each facet `f` of a closed surface, where a, b and c are the
    /// names of what lies across the edges opposite its corners 0, 1 and 2.
    ///
    /// `name(f, k)` is the name of facet `f` as seen across its edge opposite corner `k`.
    pub(crate) fn link_all(
        &mut self,
        facets: &[Facet],
        name: impl Fn(usize, usize) -> u32,
        mut link: impl FnMut(usize, [u32; 3]),
    ) {
        // A triangulated sphere of *F* facets has *F*/2 + 2 vertices.
        if facets.len() / 2 + 2 <= MATRIX {
            self.vertices.clear();
            self.places.clear();
            for (f, facet) in facets.iter().enumerate() {
                let [a, b, c] = facet.corners;
                let [i, j, k] = [self.place_of(a), self.place_of(b), self.place_of(c)];
                self.places.push([i, j, k]);
                self.matrix[cell(j, k)] = name(f, 0);
                self.matrix[cell(k, i)] = name(f, 1);
                self.matrix[cell(i, j)] = name(f, 2);
            }
            for (f, &[i, j, k]) in self.places.iter().enumerate() {
                link(f, [self.matrix[cell(k, j)], self.matrix[cell(i, k)], self.matrix[cell(j, i)]]);
            }
        } else {
            self.table.clear();
            for (f, facet) in facets.iter().enumerate() {
                let [a, b, c] = facet.corners;
                self.table.extend([((b, c), name(f, 0)), ((c, a), name(f, 1)), ((a, b), name(f, 2))]);
            }
            for (f, facet) in facets.iter().enumerate() {
                let [a, b, c] = facet.corners;
                link(f, [(c, b), (a, c), (b, a)].map(|edge| self.table[&edge]));
            }
        }
    }
}
