//! Which new tetrahedra share a facet: each directed edge of a cavity's boundary belongs to one facet, its reverse to
//! the adjacent one.

use crate::d3::insert::Facet;
use std::collections::HashMap;

/// Boundaries of more vertices than this use a hash table instead of the matrix.
const MATRIX: usize = 64;

/// Finds the facets on both sides of every edge of a closed surface.
pub(crate) struct EdgeMap {
    /// Where each mesh vertex stands in `vertices`, if it does: `vertices[place[v]] == v`. So nothing needs clearing.
    place: Vec<u32>,
    vertices: Vec<u32>,
    /// The places of each facet's corners.
    places: Vec<[u32; 3]>,
    /// Entry (i, j) belongs to the directed edge from the i-th to the j-th vertex of the boundary. A closed surface has
    /// every edge that is looked up, so nothing needs clearing here either.
    matrix: Box<[u32; MATRIX * MATRIX]>,
    table: HashMap<(u32, u32), u32, std::hash::BuildHasherDefault<EdgeHasher>>,
}

/// Multiplies and rotates: edges are no adversaries.
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

/// Where the matrix has the edge; the mask, which changes nothing, spares the bounds check.
fn cell(from: u32, to: u32) -> usize {
    (from as usize * MATRIX + to as usize) & (MATRIX * MATRIX - 1)
}

impl EdgeMap {
    /// For meshes of `vertices` vertices, the infinite one included.
    pub(crate) fn new(vertices: usize) -> Self {
        EdgeMap {
            place: vec![0; vertices],
            vertices: Vec::with_capacity(MATRIX),
            places: Vec::new(),
            matrix: Box::new([0; MATRIX * MATRIX]),
            table: HashMap::default(),
        }
    }

    fn place_of(&mut self, v: u32) -> u32 {
        let place = self.place[v as usize];
        if self.vertices.get(place as usize) == Some(&v) {
            return place;
        }
        let place = self.vertices.len() as u32;
        self.place[v as usize] = place;
        self.vertices.push(v);
        place
    }

    /// Calls `link(f, [a, b, c])` for each facet of a closed surface: a, b and c are the names of what lies across the
    /// edges opposite its corners 0, 1 and 2, where `name(f, k)` is the name of facet `f` as seen across the edge opposite
    /// corner `k`.
    pub(crate) fn link_all(
        &mut self,
        facets: &[Facet],
        name: impl Fn(usize, usize) -> u32,
        mut link: impl FnMut(usize, [u32; 3]),
    ) {
        // A triangulated sphere of F facets has F/2 + 2 vertices.
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
