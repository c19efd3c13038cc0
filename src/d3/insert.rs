//! Bowyer–Watson insertion (1981): find the tetrahedra whose circumspheres contain the new point,
//! and fill their cavity with tetrahedra at the point.
//!
//! The outside of the hull is triangulated too, by *ghosts*, tetrahedra that join the facets of the
//! hull to one infinite vertex, so that no facet is special. The in-sphere test breaks its ties
//! symbolically and never returns zero, so the cavity is star-shaped, and no new tetrahedron is
//! flat.
//!
//! With weights the test is the power test, and everything stays true except that vertices may lie inside the cavity:
//! they become hidden. A point that is not in conflict with the tetrahedron that contains it is hidden, too.

use crate::{
    cpu::Insert,
    d3::{
        adjacency::{CAVITY_FACETS, CavityVertices, EdgeMap, Facet, FacetPlaces},
        mesh::FACETS,
        triangulation::{MAX_TETRAHEDRA, state},
    },
    error::Error,
    predicates::filter::{PredicateContext, PredicatesAt},
    slots::MarkedSlots,
};
use std::array;

/// The maximum number of points: none of the usual inputs has 8 tetrahedra per point.
pub(crate) const MAX_POINTS: usize = MAX_TETRAHEDRA / 8;

/// Lists that insertions reuse.
pub struct Scratch<P> {
    /// The tetrahedra in conflict.
    conflict: Vec<u32>,
    /// The facets of the cavity.
    boundary: Vec<Facet>,
    /// The tetrahedra that are marked as not in conflict.
    beyond: Vec<u32>,
    /// The facets of a batch beyond which there are tetrahedra in conflict.
    found: [u32; BATCH],
    /// Unused slots; the last are for the new tetrahedra.
    free: Vec<u32>,
    vertices: CavityVertices<P>,
    edges: EdgeMap,
}

/// The number of facets of a cavity that are tested before the results are used. Whether the
/// tetrahedron beyond a facet is in conflict cannot be predicted, and a mispredicted branch would
/// discard what the processor has begun with the next facets.
const BATCH: usize = 32;

/// A walk among tetrahedra that other threads change ends after this many: it may go in circles.
const MAX_STEPS: usize = 1 << 14;

impl<S: MarkedSlots<4>> Insert<3> for S {
    type Scratch = Scratch<S::Places>;

    const REPORT: usize = 1 << 12;

    fn scratch(&self) -> Self::Scratch {
        Scratch {
            conflict: Vec::new(),
            boundary: Vec::new(),
            beyond: Vec::new(),
            found: [0; BATCH],
            free: Vec::new(),
            vertices: CavityVertices::new(self.places()),
            edges: EdgeMap::new(),
        }
    }

    fn locate<const W: bool>(&self, vertices: &PredicateContext<'_, 3, W>, p: u32, start: u32) -> u32 {
        let is_ghost = corners(self, start)[3] == self.infinite();
        let mut t = if is_ghost { self.neighbors(start)[3] >> 2 } else { start };
        let here = vertices.at(p);
        let mut came_through = 4;
        let mut steps = 0;
        loop {
            let v = corners(self, t);
            if v[3] == self.infinite() || (S::SHARED && steps == MAX_STEPS) {
                return t;
            }
            steps += 1;
            // All facets at once: a branch for each would often be predicted wrongly.
            let k = here.facet_towards(v).unwrap_or_else(|| {
                let is_beyond = |[a, b, c]: [usize; 3]| here.orient3d(v[a], v[b], v[c]) > 0;
                (0..4).find(|&k| k != came_through && is_beyond(FACETS[k])).unwrap_or(4)
            });
            if k == 4 || k == came_through {
                return t;
            }
            let across = self.neighbors(t)[k];
            t = across >> 2;
            came_through = across as usize & 3;
        }
    }

    fn insert<const W: bool>(
        &mut self,
        vertices: &PredicateContext<'_, 3, W>,
        p: u32,
        start: u32,
        scratch: &mut Self::Scratch,
    ) -> Result<Option<u32>, Error> {
        if S::SHARED && !can_begin(self, p, start) {
            return Ok(None);
        }
        let here = vertices.at(p);
        if (S::SHARED || W) && !in_conflict(self, &here, start) {
            // The point is hidden, unless another thread has misled the walk.
            return Ok((W && (!S::SHARED || contains(self, &here, start))).then_some(start));
        }
        if !find_cavity(self, &here, start, scratch) || !self.has_room(scratch.boundary.len()) {
            undo_marks(self, scratch);
            return Ok(None);
        }
        let Scratch { conflict, boundary, beyond, free, vertices, edges, .. } = scratch;
        beyond.drain(..).for_each(|t| mark(self, t, state::UNKNOWN));
        free.append(conflict);
        while free.len() < boundary.len() {
            free.push(self.push()?);
        }
        let rest = free.len() - boundary.len();
        edges.fill(self, p, boundary, &free[rest..], vertices);
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
#[inline(always)]
pub(crate) fn in_conflict<const W: bool>(
    slots: &impl MarkedSlots<4>,
    here: &PredicatesAt<'_, '_, 3, W>,
    t: u32,
) -> bool {
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
/// change has led. Returns whether `start` exists.
fn can_begin(slots: &mut impl MarkedSlots<4>, p: u32, start: u32) -> bool {
    let seen = slots.simplex(start);
    seen[0] & state::MASK == state::UNKNOWN
        && seen[0] != seen[1]
        && slots.claim(p)
        && seen.iter().all(|&v| slots.claim(v))
        && slots.simplex(start) == seen
}

/// Returns whether `t` is a tetrahedron that contains the vertex `here`.
fn contains<const W: bool>(slots: &impl MarkedSlots<4>, here: &PredicatesAt<'_, '_, 3, W>, t: u32) -> bool {
    let v = corners(slots, t);
    v[3] != slots.infinite() && FACETS.iter().all(|&[a, b, c]| here.orient3d(v[a], v[b], v[c]) <= 0)
}

/// Marks and lists the tetrahedra in conflict with the vertex `here`, and the facets around them,
/// breadth-first. Returns whether all their vertices could be claimed.
#[inline(never)]
fn find_cavity<S: MarkedSlots<4>, const W: bool>(
    slots: &mut S,
    here: &PredicatesAt<'_, '_, 3, W>,
    start: u32,
    scratch: &mut Scratch<S::Places>,
) -> bool {
    let Scratch { conflict, boundary, beyond, found, vertices, .. } = scratch;
    boundary.clear();
    vertices.clear();
    for v in corners(slots, start) {
        vertices.give_place(v, here);
    }
    boundary.extend(facets(slots, start, vertices));
    conflict.push(start);
    mark(slots, start, state::CONFLICT);
    // The facets before `next` have been looked at, and those before `kept` are the cavity's so far.
    let (mut next, mut kept) = (0, 0);
    while next < boundary.len() {
        let end = boundary.len().min(next + BATCH);
        let mut count = 0;
        for i in next..end {
            let facet = boundary[i];
            let (other, k) = (facet.beyond >> 2, facet.beyond as usize & 3);
            let [first, apex] = slots.first_and(other, k);
            let state = first & state::MASK;
            if state == state::CONFLICT {
                continue;
            }
            let mut is_in_conflict = false;
            if state == state::UNKNOWN {
                let (det, is_certain) = here.insphere_of_rows(vertices.rows(facet.places), apex & !state::MASK);
                is_in_conflict = det > 0.0;
                if !is_certain {
                    // What takes long to decide is decided once: it is not left to the end of the batch.
                    is_in_conflict = test_again(slots, here, det, facet, vertices, beyond);
                    if is_in_conflict {
                        if !take_in(slots, here, facet.beyond, (conflict, boundary, vertices)) {
                            return false;
                        }
                        continue;
                    }
                }
            }
            // It goes into both lists, of which one gets longer.
            (boundary[kept], found[count % BATCH]) = (facet, facet.beyond);
            kept += usize::from(!is_in_conflict);
            count += usize::from(is_in_conflict);
        }
        next = end;
        for &facet in found.iter().take(count) {
            // It may have been found through two facets.
            let [first, _] = slots.first_and(facet >> 2, 0);
            if first & state::MASK != state::CONFLICT && !take_in(slots, here, facet, (conflict, boundary, vertices)) {
                return false;
            }
        }
    }
    boundary.truncate(kept);
    true
}

/// Takes the tetrahedron beyond a facet, which is in conflict with the vertex `here`, into the cavity.
/// Returns whether its vertex could be claimed.
#[inline(always)]
fn take_in<S: MarkedSlots<4>, const W: bool>(
    slots: &mut S,
    here: &PredicatesAt<'_, '_, 3, W>,
    facet: u32,
    (conflict, boundary, vertices): (&mut Vec<u32>, &mut Vec<Facet>, &mut CavityVertices<S::Places>),
) -> bool {
    let (t, k) = (facet >> 2, facet as usize & 3);
    let [_, apex] = slots.first_and(t, k);
    let apex = apex & !state::MASK;
    if S::SHARED && !slots.claim(apex) {
        return false;
    }
    mark(slots, t, state::CONFLICT);
    conflict.push(t);
    vertices.give_place(apex, here);
    // The facet that leads back is not one of the cavity.
    boundary.extend(facets(slots, t, vertices));
    boundary.swap_remove(boundary.len() - 4 + k);
    true
}

/// Returns the facets of tetrahedron `t`, whose vertices have places.
#[inline]
fn facets<S: MarkedSlots<4>>(slots: &S, t: u32, vertices: &CavityVertices<S::Places>) -> [Facet; 4] {
    let (places, around) = (corners(slots, t).map(|v| vertices.place_of(v)), slots.neighbors(t));
    array::from_fn(|k| Facet { beyond: around[k], places: FacetPlaces::new(CAVITY_FACETS[k].map(|i| places[i])) })
}

/// Returns whether what is beyond a facet is in conflict with the vertex `here`, from the value `det`
/// of its in-sphere determinant, which does not decide. If not, marks it, lest this is asked again.
#[inline(never)]
fn test_again<S: MarkedSlots<4>, const W: bool>(
    slots: &mut S,
    here: &PredicatesAt<'_, '_, 3, W>,
    det: f64,
    facet: Facet,
    vertices: &CavityVertices<S::Places>,
    beyond: &mut Vec<u32>,
) -> bool {
    let (other, k) = (facet.beyond >> 2, facet.beyond as usize & 3);
    // A vertex is infinite, or a row is missing.
    let is_in_conflict = if det.is_nan() {
        in_conflict(slots, here, other)
    } else {
        here.insphere_again(det, vertices.rows(facet.places), corners(slots, other), k) > 0
    };
    if !is_in_conflict {
        mark(slots, other, state::BEYOND);
        beyond.push(other);
    }
    is_in_conflict
}

/// Removes the marks of a cavity that is not filled.
#[cold]
fn undo_marks<S: MarkedSlots<4>>(slots: &mut S, scratch: &mut Scratch<S::Places>) {
    for t in scratch.conflict.drain(..).chain(scratch.beyond.drain(..)) {
        mark(slots, t, state::UNKNOWN);
    }
}
