//! Exact flips (Lawson 1977; Joe 1991) bring a triangulation whose vertices have moved near the
//! Delaunay triangulation.
//!
//! Two tetrahedra whose common facet is not locally Delaunay become three around a new edge, or
//! three around an edge become two, if all of them are positively oriented, before and after. Every
//! flip lowers the triangulation as it is lifted to R⁴, so flipping ends; not always with the
//! Delaunay triangulation, since flips get stuck in 3D. Ghosts are tetrahedra like any others, so
//! flips change the hull, too.

use crate::{
    d3::{
        mesh::FACETS,
        splay::predicates::StarPredicates,
        triangulation::{Triangulation3, state},
    },
    error::Error,
    slots::Slots,
};

/// The number of flips between two reports of progress.
const REPORT: u64 = 1 << 12;

/// Flips facets until those that are not locally Delaunay cannot be flipped. Returns the number of
/// flips, and these facets.
///
/// `pending` has all facets that are not locally Delaunay; the tetrahedra in `inverted` are left as
/// they are, with their facets. `report` is called from time to time with the number of flips; an
/// error from it ends the work.
///
/// # Errors
///
/// Returns the errors of `report`, [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub(crate) fn flip(
    mesh: &mut Triangulation3,
    predicates: &StarPredicates<'_>,
    mut pending: Vec<u32>,
    inverted: &[u32],
    report: &dyn Fn(u64) -> Result<(), Error>,
) -> Result<(u64, Vec<u32>), Error> {
    let mut is_inverted = vec![false; mesh.tetrahedra.len()];
    inverted.iter().for_each(|&t| is_inverted[t as usize] = true);
    let mut flipping = Flipping { mesh, predicates, is_inverted, free: Vec::new() };
    let mut stuck = Vec::new();
    let mut flips = 0;
    while let Some(facet) = pending.pop() {
        if !flipping.is_open(facet) {
            continue;
        }
        match flipping.possible(facet) {
            Some(flip) => {
                if flips % REPORT == 0 {
                    report(flips)?;
                }
                flips += 1;
                for slot in flipping.flip(facet, flip)? {
                    pending.extend(4 * slot..4 * slot + 4);
                }
            }
            None => stuck.push(facet),
        }
    }
    stuck.retain(|&facet| flipping.is_open(facet));
    Ok((flips, stuck))
}

/// A flip of the tetrahedra (d, a, b, c) and (e, a, c, b), of which *a*, *b*, *c* are numbered from
/// 0.
#[derive(Clone, Copy)]
enum Flip {
    /// Into three around the edge from d to e.
    TwoToThree,
    /// Of these and the third one around the edge opposite this corner of their facet.
    ThreeToTwo(usize),
}

/// A triangulation that is flipped.
struct Flipping<'a, 'p> {
    mesh: &'a mut Triangulation3,
    predicates: &'a StarPredicates<'p>,
    /// The tetrahedra that take no part.
    is_inverted: Vec<bool>,
    /// Unused slots.
    free: Vec<u32>,
}

impl Flipping<'_, '_> {
    /// Returns whether a facet is there, between tetrahedra that take part, and not locally
    /// Delaunay.
    fn is_open(&self, facet: u32) -> bool {
        let (t, across) = (facet >> 2, self.across(facet));
        let u = across >> 2;
        let takes_part = |t: u32| self.mesh.state(t) != state::FREE && !self.is_inverted[t as usize];
        takes_part(t)
            && takes_part(u)
            && self.predicates.conflict(self.mesh.vertices(t), self.mesh.vertices(u)[across as usize % 4]) > 0
    }

    fn across(&self, facet: u32) -> u32 {
        self.mesh.neighbors[facet as usize / 4][facet as usize % 4]
    }

    /// Returns d, e, and the corners a, b, c of their facet, such that (d, a, b, c) is positively
    /// oriented.
    fn around(&self, facet: u32) -> (u32, u32, [u32; 3]) {
        let across = self.across(facet);
        let (v, w) = (self.mesh.vertices(facet >> 2), self.mesh.vertices(across >> 2));
        let k = facet as usize % 4;
        (v[k], w[across as usize % 4], FACETS[k].map(|i| v[i]))
    }

    /// Returns what is across the facet of tetrahedron `t` opposite its vertex `v`.
    fn beyond(&self, t: u32, v: u32) -> u32 {
        self.across(self.opposite(t, v))
    }

    /// Returns the facet of tetrahedron `t` opposite its vertex `v`.
    fn opposite(&self, t: u32, v: u32) -> u32 {
        let corners = self.mesh.vertices(t);
        4 * t + (0..3).find(|&k| corners[k as usize] == v).unwrap_or(3)
    }

    /// Returns the flip that removes a facet, if there is one.
    fn possible(&self, facet: u32) -> Option<Flip> {
        let (d, e, corners) = self.around(facet);
        let sign = |z: usize| self.predicates.orient([d, corners[(z + 1) % 3], corners[(z + 2) % 3], e]);
        let signs = [0, 1, 2].map(sign);
        if signs.iter().all(|&sign| sign > 0) {
            return Some(Flip::TwoToThree);
        }
        let z = signs.iter().position(|&sign| sign < 0)?;
        if signs[(z + 1) % 3] <= 0 || signs[(z + 2) % 3] <= 0 {
            return None;
        }
        // The third tetrahedron is the same seen from both.
        let (t, u) = (facet >> 2, self.across(facet) >> 2);
        let [w, other] = [t, u].map(|t| self.beyond(t, corners[z]) >> 2);
        (w == other && w != t && w != u && !self.is_inverted[w as usize]).then_some(Flip::ThreeToTwo(z))
    }

    /// Flips. Returns the slots of the new tetrahedra.
    fn flip(&mut self, facet: u32, flip: Flip) -> Result<Vec<u32>, Error> {
        let (t, u) = (facet >> 2, self.across(facet) >> 2);
        let (d, e, corners) = self.around(facet);
        // What is across the facets opposite a, b and c, on the sides of d and of e.
        let [by_d, by_e] = [t, u].map(|t| corners.map(|v| self.beyond(t, v)));
        match flip {
            Flip::TwoToThree => {
                let slots = [t, u, self.take()?];
                for (z, slot) in slots.into_iter().enumerate() {
                    self.set(slot, [d, corners[(z + 1) % 3], corners[(z + 2) % 3], e]);
                }
                for (z, slot) in slots.into_iter().enumerate() {
                    self.join(slot, e, by_d[z]);
                    self.join(slot, d, by_e[z]);
                    let x = (z + 1) % 3;
                    let inner = self.opposite(slots[x], corners[z]);
                    self.join(slot, corners[x], inner);
                }
                Ok(slots.into())
            }
            Flip::ThreeToTwo(z) => {
                let (x, y) = ((z + 1) % 3, (z + 2) % 3);
                let w = by_d[z] >> 2;
                let by_w = corners.map(|v| if v == corners[z] { 0 } else { self.beyond(w, v) });
                let slots = [t, u];
                self.set(t, [d, corners[y], corners[z], e]);
                self.set(u, [d, corners[z], corners[x], e]);
                for (slot, gone) in [(t, x), (u, y)] {
                    self.join(slot, e, by_d[gone]);
                    self.join(slot, d, by_e[gone]);
                    self.join(slot, corners[z], by_w[gone]);
                }
                let inner = self.opposite(u, corners[x]);
                self.join(t, corners[y], inner);
                self.mesh.set_state(w, state::FREE);
                self.free.push(w);
                Ok(slots.into())
            }
        }
    }

    /// Returns an unused slot.
    fn take(&mut self) -> Result<u32, Error> {
        if let Some(slot) = self.free.pop() {
            return Ok(slot);
        }
        self.is_inverted.push(false);
        self.mesh.push()
    }

    /// Sets the vertices of a tetrahedron, of which the infinite one comes last.
    fn set(&mut self, slot: u32, mut v: [u32; 4]) {
        if let Some(k) = (0..3).find(|&k| v[k] == self.mesh.infinite) {
            // Two exchanges keep the orientation.
            v.swap(k, 3);
            v.swap((k + 1) % 3, (k + 2) % 3);
        }
        self.mesh.tetrahedra[slot as usize] = v;
    }

    /// Makes the facet of `slot` opposite its vertex `v` and `across` neighbours.
    fn join(&mut self, slot: u32, v: u32, across: u32) {
        let facet = self.opposite(slot, v);
        self.mesh.join(facet, across);
    }
}
