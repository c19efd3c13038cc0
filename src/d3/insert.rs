//! Bowyer–Watson insertion (1981): find the tetrahedra whose circumspheres contain the new point,
//! and fill their cavity with tetrahedra at the point.
//!
//! The outside of the hull is triangulated too, by *ghosts*, tetrahedra that join the facets of the
//! hull to one infinite vertex, so that no facet is special. The in-sphere test breaks its ties
//! symbolically and never returns zero, so the cavity is star-shaped, and no new tetrahedron is
//! flat.

use crate::{
    cpu::Insert,
    d3::{
        adjacency::{EdgeMap, Facet},
        mesh::FACETS,
        triangulation::{MAX_TETRAHEDRA, Triangulation3, state},
    },
    error::Error,
    predicates::filter::PredicateContext3,
    slots,
};

/// The maximum number of points: none of the usual inputs has 8 tetrahedra per point.
pub(crate) const MAX_POINTS: usize = MAX_TETRAHEDRA / 8;

/// Lists that insertions reuse.
pub struct Scratch {
    /// The tetrahedra in conflict.
    conflict: Vec<u32>,
    /// The facets of the cavity.
    boundary: Vec<Facet>,
    /// The slots of the new tetrahedra, one per facet of the cavity.
    filled: Vec<u32>,
    /// Unused slots.
    free: Vec<u32>,
    edges: EdgeMap,
}

impl Insert<3> for Triangulation3 {
    type Scratch = Scratch;

    /// 6.77 for a uniform distribution, and some ghosts.
    const SIMPLICES_PER_POINT: usize = 7;
    const REPORT: usize = 1 << 12;

    /// Creates one tetrahedron, and the ghosts on its four facets.
    fn initial(infinite: u32) -> Self {
        let mut mesh = Triangulation3 { tetrahedra: vec![[0, 1, 2, 3]], neighbors: vec![[0; 4]], infinite };
        for (k, facet) in FACETS.iter().enumerate() {
            let [a, b, c] = facet.map(|v| v as u32);
            mesh.tetrahedra.push([a, b, c, infinite]);
            mesh.neighbors.push([0; 4]);
            mesh.join(k as u32, 4 * (k as u32 + 1) + 3);
        }
        // Ghosts i and j share the facet opposite corner j of ghost i and corner i of ghost j.
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
        slots::reserve(&mut self.tetrahedra, &mut self.neighbors, tetrahedra)
    }

    fn scratch(vertices: usize) -> Scratch {
        Scratch {
            conflict: Vec::new(),
            boundary: Vec::new(),
            filled: Vec::new(),
            free: Vec::new(),
            edges: EdgeMap::new(vertices + 1),
        }
    }

    fn locate(&self, vertices: &PredicateContext3<'_>, p: u32, start: u32) -> u32 {
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

    fn insert(
        &mut self,
        vertices: &PredicateContext3<'_>,
        p: u32,
        start: u32,
        scratch: &mut Scratch,
    ) -> Result<u32, Error> {
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

    /// Marks the slots that are unused.
    fn finish(&mut self, scratch: Scratch) {
        for slot in scratch.free {
            self.set_state(slot, state::FREE);
        }
    }
}

impl Triangulation3 {
    /// Returns whether the circumsphere of `t` contains vertex `p`.
    ///
    /// The circumsphere of a ghost is the half-space beyond its facet and, in the facet's plane,
    /// the circumdisc of the facet: the part of the plane inside the circumsphere of the
    /// tetrahedron on the other side of the facet.
    #[inline]
    fn in_conflict(&self, vertices: &PredicateContext3<'_>, t: u32, p: u32) -> bool {
        let v = self.vertices(t);
        if v[3] != self.infinite {
            return vertices.insphere(v, p) > 0;
        }
        match vertices.orient3d(v[0], v[1], v[2], p) {
            0 => vertices.insphere(self.vertices(self.neighbors[t as usize][3] >> 2), p) > 0,
            side => side > 0,
        }
    }

    /// Marks and lists the tetrahedra in conflict with `p`, and the facets around them,
    /// breadth-first.
    fn find_cavity(&mut self, vertices: &PredicateContext3<'_>, p: u32, start: u32, scratch: &mut Scratch) {
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
}
