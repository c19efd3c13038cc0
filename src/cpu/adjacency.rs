//! Which new tetrahedra share a facet: each directed edge of a cavity's boundary belongs to one facet, its reverse to
//! the adjacent one.

use std::collections::HashMap;

/// Boundaries of more vertices than this use a hash table instead of the matrix.
const MATRIX: usize = 64;

/// Finds the facets on both sides of every edge of a closed surface.
pub(super) struct EdgeMap {
    /// Where each mesh vertex stands in `vertices`, if it does: `vertices[place[v]] == v`. So nothing needs clearing.
    place: Vec<u32>,
    vertices: Vec<u32>,
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
fn cell(from: usize, to: usize) -> usize {
    (from * MATRIX + to) & (MATRIX * MATRIX - 1)
}

impl EdgeMap {
    /// For meshes of `vertices` vertices, the infinite one included.
    pub(super) fn new(vertices: usize) -> Self {
        EdgeMap {
            place: vec![0; vertices],
            vertices: Vec::with_capacity(MATRIX),
            matrix: Box::new([0; MATRIX * MATRIX]),
            table: HashMap::default(),
        }
    }

    fn place_of(&mut self, v: u32) -> usize {
        let place = self.place[v as usize] as usize;
        if self.vertices.get(place) == Some(&v) {
            return place;
        }
        let place = self.vertices.len();
        self.place[v as usize] = place as u32;
        self.vertices.push(v);
        place
    }

    /// Calls `link(f, g)` once for each edge of the closed surface of `facets`: `f` and `g` are the names that `name`
    /// gives to the two directed edges, `name(facet, k)` being that opposite corner `k`.
    pub(super) fn link_all(
        &mut self,
        facets: &[[u32; 3]],
        name: impl Fn(usize, usize) -> u32,
        mut link: impl FnMut(u32, u32),
    ) {
        // A triangulated sphere of F facets has F/2 + 2 vertices.
        if facets.len() / 2 + 2 <= MATRIX {
            self.vertices.clear();
            for (f, facet) in facets.iter().enumerate() {
                let [i, j, k] = facet.map(|v| self.place_of(v));
                for (corner, from, to) in [(0, j, k), (1, k, i), (2, i, j)] {
                    self.matrix[cell(from, to)] = name(f, corner);
                }
            }
            for (f, facet) in facets.iter().enumerate() {
                let [i, j, k] = facet.map(|v| self.place[v as usize] as usize);
                for (corner, from, to) in [(0, j, k), (1, k, i), (2, i, j)] {
                    if from < to {
                        link(name(f, corner), self.matrix[cell(to, from)]);
                    }
                }
            }
        } else {
            self.table.clear();
            for (f, &[a, b, c]) in facets.iter().enumerate() {
                for (corner, from, to) in [(0, b, c), (1, c, a), (2, a, b)] {
                    match self.table.remove(&(to, from)) {
                        Some(other) => link(name(f, corner), other),
                        None => {
                            self.table.insert((from, to), name(f, corner));
                        }
                    }
                }
            }
        }
    }
}
