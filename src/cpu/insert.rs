//! Bowyer–Watson: find the tetrahedra whose circumspheres hold the new point, and fill their cavity from the point.
//!
//! The outside of the hull is triangulated too, with *ghost* tetrahedra that join its facets to one infinite vertex, so
//! that no facet is special. The predicates never tie, so the cavity is star-shaped and no new tetrahedron is flat.

use super::adjacency::EdgeMap;
use crate::{
    Error, Options,
    mesh::{FACETS, NONE},
    predicates::vertices::Vertices,
};

/// Tetrahedra are numbered below 2³⁰, since a neighbour is packed with its facet into 32 bits.
const MOST_TETRAHEDRA: usize = 1 << 30;
/// The most points that the engine takes: none of the usual inputs has 8 tetrahedra a point.
pub(super) const MOST_POINTS: usize = MOST_TETRAHEDRA / 8;
/// Tetrahedra of a uniform distribution per point: 6.77, and some ghosts.
const EXPECTED_TETRAHEDRA: usize = 7;
/// How often progress is reported, in points.
const REPORT: usize = 1 << 12;

/// What the insertion of the current point has found out about a tetrahedron: the two highest bits of its first vertex,
/// so that no other cache line need be fetched for them.
mod state {
    pub(super) const MASK: u32 = 3 << 30;
    pub(super) const UNKNOWN: u32 = 0;
    /// The circumsphere holds the point.
    pub(super) const CONFLICT: u32 = 1 << 30;
    /// It does not, but a neighbour's does.
    pub(super) const BEYOND: u32 = 2 << 30;
    /// The slot is unused.
    pub(super) const FREE: u32 = 3 << 30;
}

/// A growing triangulation.
pub(super) struct Inserted {
    /// Vertices, positively oriented, with a [`state`] in the first. A ghost has the infinite vertex last, and is oriented as if that lay outside.
    tetrahedra: Vec<[u32; 4]>,
    /// Across the facet opposite vertex *k*: 4·(tetrahedron) + (facet seen from there).
    neighbors: Vec<[u32; 4]>,
    /// The infinite vertex: the number of vertices.
    infinite: u32,
}

/// A facet of a cavity.
#[derive(Clone, Copy)]
pub(super) struct Facet {
    /// Counter-clockwise as seen from outside of the cavity; an infinite vertex comes last.
    pub(super) corners: [u32; 3],
    /// What lies beyond: 4·(tetrahedron) + (facet seen from there).
    beyond: u32,
}

/// Lists that every insertion uses anew.
struct Scratch {
    conflict: Vec<u32>,
    boundary: Vec<Facet>,
    /// The slots of the new tetrahedra.
    filled: Vec<u32>,
    free: Vec<u32>,
    edges: EdgeMap,
}

/// Triangulates all vertices, of which the first four are positively oriented.
pub(super) fn insert_all(vertices: &Vertices<'_>, options: &Options) -> Result<Inserted, Error> {
    let n = vertices.len();
    let mut mesh = Inserted::initial(n as u32);
    let expected = n * EXPECTED_TETRAHEDRA;
    mesh.reserve(expected)?;
    let mut scratch = Scratch {
        conflict: Vec::new(),
        boundary: Vec::new(),
        filled: Vec::new(),
        free: Vec::new(),
        edges: EdgeMap::new(n + 1),
    };
    let mut last = 0;
    for p in 4..n {
        if p % REPORT == 0 {
            options.report("insert", p as f64 / n as f64)?;
        }
        let start = mesh.locate(vertices, p as u32, last);
        last = mesh.insert(vertices, p as u32, start, &mut scratch)?;
    }
    for slot in scratch.free {
        mesh.tetrahedra[slot as usize][0] = state::FREE;
    }
    Ok(mesh)
}

impl Inserted {
    /// One tetrahedron of the vertices 0 to 3, and the four ghosts on its facets.
    fn initial(infinite: u32) -> Self {
        let mut mesh = Inserted { tetrahedra: vec![[0, 1, 2, 3]], neighbors: vec![[0; 4]], infinite };
        for (k, facet) in FACETS.iter().enumerate() {
            let [a, b, c] = facet.map(|v| v as u32);
            mesh.tetrahedra.push([a, b, c, infinite]);
            mesh.neighbors.push([0; 4]);
            mesh.join(k as u32, 4 * (k as u32 + 1) + 3);
        }
        // Ghosts i and j share the facet opposite i's corner j and j's corner i.
        for i in 0..4u32 {
            for j in 0..i {
                let facet = |ghost: u32, corner: u32| {
                    let place = mesh.tetrahedra[ghost as usize + 1].iter().position(|&v| v == corner);
                    4 * (ghost + 1) + place.map_or(0, |k| k as u32)
                };
                let (f, g) = (facet(i, j), facet(j, i));
                mesh.join(f, g);
            }
        }
        mesh
    }

    fn reserve(&mut self, tetrahedra: usize) -> Result<(), Error> {
        let more = tetrahedra.saturating_sub(self.tetrahedra.len());
        self.tetrahedra
            .try_reserve_exact(more)
            .and_then(|()| self.neighbors.try_reserve_exact(more))
            .map_err(|_| Error::OutOfMemory { tetrahedra })
    }

    fn join(&mut self, f: u32, g: u32) {
        self.neighbors[f as usize / 4][f as usize % 4] = g;
        self.neighbors[g as usize / 4][g as usize % 4] = f;
    }

    fn vertices(&self, t: u32) -> [u32; 4] {
        let [a, b, c, d] = self.tetrahedra[t as usize];
        [a & !state::MASK, b, c, d]
    }

    fn state(&self, t: u32) -> u32 {
        self.tetrahedra[t as usize][0] & state::MASK
    }

    fn set_state(&mut self, t: u32, state: u32) {
        let first = &mut self.tetrahedra[t as usize][0];
        *first = *first & !state::MASK | state;
    }

    fn is_ghost(&self, t: u32) -> bool {
        self.tetrahedra[t as usize][3] == self.infinite
    }

    /// A tetrahedron that holds vertex `p`, or a ghost whose facet sees it: a walk that crosses facets towards `p` from
    /// tetrahedron `start`. It ends, since the power distance to `p` falls with every step.
    fn locate(&self, vertices: &Vertices<'_>, p: u32, start: u32) -> u32 {
        let mut t = if self.is_ghost(start) { self.neighbors[start as usize][3] >> 2 } else { start };
        let mut came_through = 4;
        'walk: loop {
            let v = self.vertices(t);
            for (k, facet) in FACETS.iter().enumerate() {
                if k == came_through {
                    continue;
                }
                let [a, b, c] = facet.map(|i| v[i]);
                if vertices.orient3d(a, b, c, p) > 0 {
                    let across = self.neighbors[t as usize][k];
                    t = across >> 2;
                    came_through = across as usize & 3;
                    if self.is_ghost(t) {
                        return t;
                    }
                    continue 'walk;
                }
            }
            return t;
        }
    }

    /// Whether the circumsphere of `t` holds vertex `p`. That of a ghost is the half-space beyond its facet and, in the
    /// facet's plane, its circumdisc, which the circumsphere on the other side of the facet cuts out of the plane.
    #[inline]
    fn in_conflict(&self, vertices: &Vertices<'_>, t: u32, p: u32) -> bool {
        let v = self.vertices(t);
        if v[3] != self.infinite {
            return vertices.insphere(v, p) > 0;
        }
        match vertices.orient3d(v[0], v[1], v[2], p) {
            0 => vertices.insphere(self.vertices(self.neighbors[t as usize][3] >> 2), p) > 0,
            side => side > 0,
        }
    }

    /// Inserts vertex `p`, which is in conflict with tetrahedron `start`; gives a tetrahedron at `p`.
    fn insert(&mut self, vertices: &Vertices<'_>, p: u32, start: u32, scratch: &mut Scratch) -> Result<u32, Error> {
        self.find_cavity(vertices, p, start, scratch);
        let Scratch { conflict, boundary, filled, free, edges } = scratch;
        free.append(conflict);
        filled.clear();
        for &Facet { corners: [a, b, c], beyond } in boundary.iter() {
            let new = match free.pop() {
                Some(slot) => slot,
                None => self.push()?,
            };
            filled.push(new);
            self.tetrahedra[new as usize] = [p, a, b, c];
            self.set_state(beyond >> 2, state::UNKNOWN);
            self.neighbors[beyond as usize / 4][beyond as usize % 4] = 4 * new;
        }
        edges.link_all(
            boundary,
            |f, corner| 4 * filled[f] + 1 + corner as u32,
            |f, [a, b, c]| self.neighbors[filled[f] as usize] = [boundary[f].beyond, a, b, c],
        );
        Ok(filled[filled.len() - 1])
    }

    /// Marks and lists the tetrahedra in conflict with `p`, and the facets around them, breadth-first.
    fn find_cavity(&mut self, vertices: &Vertices<'_>, p: u32, start: u32, scratch: &mut Scratch) {
        let Scratch { conflict, boundary, .. } = scratch;
        boundary.clear();
        conflict.push(start);
        self.set_state(start, state::CONFLICT);
        let mut next = 0;
        while let Some(&t) = conflict.get(next) {
            next += 1;
            let corners = self.vertices(t);
            for (facet, beyond) in FACETS.iter().zip(self.neighbors[t as usize]) {
                let other = beyond >> 2;
                match self.state(other) {
                    state::CONFLICT => continue,
                    state::UNKNOWN if self.in_conflict(vertices, other, p) => {
                        self.set_state(other, state::CONFLICT);
                        conflict.push(other);
                        continue;
                    }
                    state::UNKNOWN => self.set_state(other, state::BEYOND),
                    _ => {}
                }
                let [a, b, c] = facet.map(|i| corners[i]);
                let corners = match self.infinite {
                    i if i == a => [b, c, a],
                    i if i == b => [c, a, b],
                    _ => [a, b, c],
                };
                boundary.push(Facet { corners, beyond });
            }
        }
    }

    fn push(&mut self) -> Result<u32, Error> {
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

    /// Tetrahedra and neighbours without ghosts and unused slots, in the arrays where they lie; vertex *v* becomes
    /// `names[v]`.
    pub(super) fn into_mesh(mut self, names: Vec<u32>) -> (Vec<[u32; 4]>, Vec<[i32; 4]>) {
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
        let Inserted { mut tetrahedra, mut neighbors, .. } = self;
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
