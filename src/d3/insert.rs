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
        triangulation::{MAX_TETRAHEDRA, state},
    },
    error::Error,
    predicates::filter::{PredicateContext3, PredicatesAt},
    slots::MarkedSlots,
};

/// The maximum number of points: none of the usual inputs has 8 tetrahedra per point.
pub(crate) const MAX_POINTS: usize = MAX_TETRAHEDRA / 8;

/// Lists that insertions reuse.
pub struct Scratch<P> {
    /// The tetrahedra in conflict.
    conflict: Vec<u32>,
    /// The facets of the cavity.
    boundary: Vec<Facet>,
    /// Unused slots; the last are for the new tetrahedra.
    free: Vec<u32>,
    edges: EdgeMap<P>,
}

/// The [`FACETS`] of a tetrahedron, beginning so that its last vertex, which may be infinite, comes
/// last.
const CAVITY_FACETS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]];

/// A walk among tetrahedra that other threads change ends after this many: it may go in circles.
const MAX_STEPS: usize = 1 << 14;

impl<S: MarkedSlots<4>> Insert<3> for S {
    type Scratch = Scratch<S::Places>;

    const REPORT: usize = 1 << 12;

    fn scratch(&self) -> Self::Scratch {
        Scratch { conflict: Vec::new(), boundary: Vec::new(), free: Vec::new(), edges: EdgeMap::new(self.places()) }
    }

    fn locate(&self, vertices: &PredicateContext3<'_>, p: u32, start: u32) -> u32 {
        let is_ghost = corners(self, start)[3] == self.infinite();
        let mut t = if is_ghost { self.neighbors(start)[3] >> 2 } else { start };
        let here = vertices.at(p);
        let mut came_through = 4;
        let mut steps = 0;
        'walk: loop {
            let v = corners(self, t);
            if v[3] == self.infinite() || (S::SHARED && steps == MAX_STEPS) {
                return t;
            }
            steps += 1;
            for (k, facet) in FACETS.iter().enumerate() {
                if k == came_through {
                    continue;
                }
                let [a, b, c] = facet.map(|i| v[i]);
                if here.orient3d(a, b, c) > 0 {
                    let across = self.neighbors(t)[k];
                    t = across >> 2;
                    came_through = across as usize & 3;
                    continue 'walk;
                }
            }
            return t;
        }
    }

    // In the package, two copies, for the CPU engine and for splaying, are too large. Natively each
    // is faster with its own.
    #[cfg_attr(target_arch = "wasm32", inline(never))]
    fn insert(
        &mut self,
        vertices: &PredicateContext3<'_>,
        p: u32,
        start: u32,
        scratch: &mut Self::Scratch,
    ) -> Result<Option<u32>, Error> {
        if S::SHARED && !can_begin(self, vertices, p, start) {
            return Ok(None);
        }
        if !find_cavity(self, &vertices.at(p), start, scratch) || !self.has_room(scratch.boundary.len()) {
            undo_marks(self, scratch);
            return Ok(None);
        }
        let Scratch { conflict, boundary, free, edges } = scratch;
        free.append(conflict);
        while free.len() < boundary.len() {
            free.push(self.push()?);
        }
        let rest = free.len() - boundary.len();
        let new = free[rest..].iter().copied();
        for (&Facet { corners: [a, b, c], beyond }, t) in boundary.iter().zip(new.clone()) {
            self.set_simplex(t, [p, a, b, c]);
            mark(self, beyond >> 2, state::UNKNOWN);
            self.set_neighbor(beyond, 4 * t);
        }
        edges.link_all(boundary, new, |t, neighbors| self.set_neighbors(t, neighbors));
        let last = free[free.len() - 1];
        free.truncate(rest);
        Ok(Some(last))
    }

    fn finish(&mut self, scratch: Self::Scratch) {
        for slot in scratch.free {
            self.discard(slot);
        }
    }
}

/// Returns the vertices of tetrahedron `t`.
fn corners(slots: &impl MarkedSlots<4>, t: u32) -> [u32; 4] {
    let [a, b, c, d] = slots.simplex(t);
    [a & !state::MASK, b, c, d]
}

/// Sets the state of tetrahedron `t`.
fn mark(slots: &mut impl MarkedSlots<4>, t: u32, state: u32) {
    slots.set_first(t, slots.first(t) & !state::MASK | state);
}

/// Returns whether the circumsphere of `t` contains the vertex `here`.
///
/// The circumsphere of a ghost is the half-space beyond its facet and, in the facet's plane, the
/// circumdisc of the facet: the part of the plane inside the circumsphere of the tetrahedron on the
/// other side of the facet.
#[inline]
pub(crate) fn in_conflict(slots: &impl MarkedSlots<4>, here: &PredicatesAt<'_, '_, 3>, t: u32) -> bool {
    let v = corners(slots, t);
    if v[3] != slots.infinite() {
        return here.insphere(v) > 0;
    }
    match here.orient3d(v[0], v[1], v[2]) {
        0 => here.insphere(corners(slots, slots.neighbors(t)[3] >> 2)) > 0,
        side => side > 0,
    }
}

/// Claims `p` and the vertices of `start`, to which a walk among tetrahedra that other threads
/// change has led. Returns whether `start` exists and is in conflict with `p`.
fn can_begin(slots: &mut impl MarkedSlots<4>, vertices: &PredicateContext3<'_>, p: u32, start: u32) -> bool {
    let seen = slots.simplex(start);
    seen[0] & state::MASK == state::UNKNOWN
        && seen[0] != seen[1]
        && slots.claim(p)
        && seen.iter().all(|&v| slots.claim(v))
        && slots.simplex(start) == seen
        && in_conflict(slots, &vertices.at(p), start)
}

/// Marks and lists the tetrahedra in conflict with the vertex `here`, and the facets around them,
/// breadth-first. Returns whether all their vertices could be claimed.
fn find_cavity<S: MarkedSlots<4>>(
    slots: &mut S,
    here: &PredicatesAt<'_, '_, 3>,
    start: u32,
    scratch: &mut Scratch<S::Places>,
) -> bool {
    let Scratch { conflict, boundary, .. } = scratch;
    boundary.clear();
    conflict.push(start);
    mark(slots, start, state::CONFLICT);
    let mut next = 0;
    while let Some(&t) = conflict.get(next) {
        next += 1;
        let corners_of_t = corners(slots, t);
        let around = slots.neighbors(t);
        for k in 0..4 {
            let beyond = around[k];
            let other = beyond >> 2;
            let first = slots.first(other);
            match first & state::MASK {
                state::CONFLICT => continue,
                state::UNKNOWN if in_conflict(slots, here, other) => {
                    if S::SHARED && !slots.claim(corners(slots, other)[beyond as usize & 3]) {
                        return false;
                    }
                    slots.set_first(other, first | state::CONFLICT);
                    conflict.push(other);
                    continue;
                }
                state::UNKNOWN => slots.set_first(other, first | state::BEYOND),
                _ => {}
            }
            // The mask has no effect except that it spares the bounds check.
            boundary.push(Facet { corners: CAVITY_FACETS[k].map(|i| corners_of_t[i & 3]), beyond });
        }
    }
    true
}

/// Removes the marks of a cavity that is not filled.
#[cold]
fn undo_marks<S: MarkedSlots<4>>(slots: &mut S, scratch: &mut Scratch<S::Places>) {
    for t in scratch.conflict.drain(..) {
        mark(slots, t, state::UNKNOWN);
    }
    for facet in &scratch.boundary {
        mark(slots, facet.beyond >> 2, state::UNKNOWN);
    }
}
