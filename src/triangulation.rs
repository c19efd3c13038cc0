//! Tetrahedra and their neighbours while they are being made, the outside of the hull included.

use crate::{Error, mesh::NONE, predicates::vertices::Vertices};

/// Tetrahedra are numbered below 2³⁰, since a neighbour is packed with its facet into 32 bits.
pub(crate) const MOST_TETRAHEDRA: usize = 1 << 30;

/// What an algorithm has found out about a tetrahedron: the two highest bits of its first vertex, so that no other cache
/// line need be fetched for them.
pub(crate) mod state {
    pub(crate) const MASK: u32 = 3 << 30;
    pub(crate) const UNKNOWN: u32 = 0;
    /// The circumsphere holds the point that is being inserted.
    pub(crate) const CONFLICT: u32 = 1 << 30;
    /// It does not, but a neighbour's does.
    pub(crate) const BEYOND: u32 = 2 << 30;
    /// The slot is unused.
    pub(crate) const FREE: u32 = 3 << 30;
}

/// A triangulation of space: tetrahedra, and *ghosts*, which join the facets of the hull to one infinite vertex.
///
/// Every tetrahedron has four neighbours, and facet *k* is the one opposite its vertex *k*.
#[derive(Debug, Clone)]
pub struct Triangulation {
    /// Vertices, positively oriented, with a [`state`] in the first. A ghost has the infinite vertex last, and is
    /// oriented as if that lay outside.
    pub(crate) tetrahedra: Vec<[u32; 4]>,
    /// Across the facet opposite vertex *k*: 4·(tetrahedron) + (facet seen from there).
    pub(crate) neighbors: Vec<[u32; 4]>,
    /// The infinite vertex: the number of vertices.
    pub(crate) infinite: u32,
}

impl Triangulation {
    /// A triangulation from its arrays, which are not checked. `infinite`, the number of vertices, is the infinite vertex.
    /// Tetrahedra are positively oriented, ghosts as if the infinite vertex lay outside the hull. Entry *k* of `neighbors`
    /// is across the facet opposite vertex *k*, packed as 4·(tetrahedron) + (facet as it is numbered there). Vertices of
    /// ghosts change places, so that the infinite one comes last.
    pub fn new(tetrahedra: Vec<[u32; 4]>, neighbors: Vec<[u32; 4]>, infinite: u32) -> Self {
        let mut mesh = Triangulation { tetrahedra, neighbors, infinite };
        for t in 0..mesh.tetrahedra.len() {
            let Some(k) = mesh.tetrahedra[t][..3].iter().position(|&v| v == infinite) else { continue };
            for four in [&mut mesh.tetrahedra[t], &mut mesh.neighbors[t]] {
                // Two exchanges keep the orientation.
                four.swap(k, 3);
                four.swap((k + 1) % 3, (k + 2) % 3);
            }
            for (k, across) in mesh.neighbors[t].into_iter().enumerate() {
                mesh.neighbors[across as usize / 4][across as usize % 4] = (4 * t + k) as u32;
            }
        }
        mesh
    }

    /// The vertices of each tetrahedron; those of unused slots mean nothing.
    pub fn tetrahedra(&self) -> &[[u32; 4]] {
        &self.tetrahedra
    }

    /// The neighbours of each tetrahedron.
    pub fn neighbors(&self) -> &[[u32; 4]] {
        &self.neighbors
    }

    /// The finite tetrahedra that are flat or inverted.
    pub fn flat_or_inverted(&self, vertices: &Vertices<'_>) -> Vec<u32> {
        let used = (0..self.tetrahedra.len() as u32).filter(|&t| self.state(t) != state::FREE && !self.is_ghost(t));
        used.filter(|&t| {
            let [a, b, c, d] = self.vertices(t);
            vertices.orient3d(a, b, c, d) <= 0
        })
        .collect()
    }

    pub(crate) fn reserve(&mut self, tetrahedra: usize) -> Result<(), Error> {
        let more = tetrahedra.saturating_sub(self.tetrahedra.len());
        self.tetrahedra
            .try_reserve_exact(more)
            .and_then(|()| self.neighbors.try_reserve_exact(more))
            .map_err(|_| Error::OutOfMemory { tetrahedra })
    }

    /// A new slot.
    pub(crate) fn push(&mut self) -> Result<u32, Error> {
        let count = self.tetrahedra.len();
        if count == MOST_TETRAHEDRA {
            return Err(Error::TooManyTetrahedra { limit: MOST_TETRAHEDRA });
        }
        if count == self.tetrahedra.capacity() {
            self.reserve((count + count / 2).min(MOST_TETRAHEDRA))?;
        }
        self.tetrahedra.push([0; 4]);
        self.neighbors.push([0; 4]);
        Ok(count as u32)
    }

    pub(crate) fn join(&mut self, f: u32, g: u32) {
        self.neighbors[f as usize / 4][f as usize % 4] = g;
        self.neighbors[g as usize / 4][g as usize % 4] = f;
    }

    pub(crate) fn vertices(&self, t: u32) -> [u32; 4] {
        let [a, b, c, d] = self.tetrahedra[t as usize];
        [a & !state::MASK, b, c, d]
    }

    pub(crate) fn state(&self, t: u32) -> u32 {
        self.tetrahedra[t as usize][0] & state::MASK
    }

    pub(crate) fn set_state(&mut self, t: u32, state: u32) {
        let first = &mut self.tetrahedra[t as usize][0];
        *first = *first & !state::MASK | state;
    }

    pub(crate) fn is_ghost(&self, t: u32) -> bool {
        self.tetrahedra[t as usize][3] == self.infinite
    }

    /// Tetrahedra and neighbours without ghosts and unused slots, in the arrays where they lie; vertex *v* becomes
    /// `names[v]`.
    pub fn into_mesh(mut self, names: &[u32]) -> (Vec<[u32; 4]>, Vec<[i32; 4]>) {
        const OUTSIDE: u32 = u32::MAX;
        for t in 0..self.tetrahedra.len() as u32 {
            if self.state(t) != state::FREE && self.is_ghost(t) {
                let inside = self.neighbors[t as usize][3];
                self.neighbors[inside as usize / 4][inside as usize % 4] = OUTSIDE;
                self.set_state(t, state::FREE);
            }
        }
        let mut count = self.tetrahedra.len();
        let mut t = 0;
        while t < count {
            if self.state(t as u32) != state::FREE {
                t += 1;
                continue;
            }
            // The last tetrahedron moves into the gap, and its neighbours are told.
            count -= 1;
            if self.state(count as u32) != state::FREE {
                self.tetrahedra[t] = self.tetrahedra[count];
                self.neighbors[t] = self.neighbors[count];
                for k in 0..4 {
                    let across = self.neighbors[t][k];
                    if across != OUTSIDE {
                        self.neighbors[across as usize / 4][across as usize % 4] = 4 * t as u32 + k as u32;
                    }
                }
            }
        }
        let Triangulation { mut tetrahedra, mut neighbors, .. } = self;
        tetrahedra.truncate(count);
        neighbors.truncate(count);
        for v in tetrahedra.as_flattened_mut() {
            *v = names[*v as usize];
        }
        let mut neighbors: Vec<[i32; 4]> = bytemuck::cast_vec(neighbors);
        for n in neighbors.as_flattened_mut() {
            *n = if *n as u32 == OUTSIDE { NONE } else { (*n as u32 >> 2) as i32 };
        }
        (tetrahedra, neighbors)
    }
}
