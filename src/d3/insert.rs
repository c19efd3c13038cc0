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
        adjacency::{CavityVertices, EdgeMap, Facet, FacetPlaces},
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
    /// The tetrahedra that are marked as not in conflict.
    beyond: Vec<u32>,
    /// Unused slots; the last are for the new tetrahedra.
    free: Vec<u32>,
    vertices: CavityVertices<P>,
    edges: EdgeMap,
}

/// The [`FACETS`] of a tetrahedron, beginning so that its last vertex, which may be infinite, comes
/// last.
const CAVITY_FACETS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]];

/// Where the corners of facet *k* of a tetrahedron are among its vertices, if they are (a, b, c),
/// counter-clockwise as seen from the other side: by whether vertex *k* + 1 (mod 4) is a, b or c. The
/// fourth row has no meaning.
const ORDERS: [[[u8; 3]; 4]; 4] = {
    let mut orders = [[[0; 3]; 4]; 4];
    let mut k = 0;
    while k < 4 {
        // From the other side, the facet is as clockwise as in FACETS[k] it is counter-clockwise.
        let [x, mut y, mut z] = [(k + 1) as u8 % 4, (k + 2) as u8 % 4, (k + 3) as u8 % 4];
        if k % 2 == 0 {
            (y, z) = (z, y);
        }
        orders[k] = [[x, y, z], [z, x, y], [y, z, x], [0; 3]];
        k += 1;
    }
    orders
};

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
            free: Vec::new(),
            vertices: CavityVertices::new(self.places()),
            edges: EdgeMap::new(),
        }
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
        let Scratch { conflict, boundary, beyond, free, vertices, edges, .. } = scratch;
        beyond.drain(..).for_each(|t| mark(self, t, state::UNKNOWN));
        free.append(conflict);
        while free.len() < boundary.len() {
            free.push(self.push()?);
        }
        let rest = free.len() - boundary.len();
        edges.fill(self, p, boundary, &free[rest..], vertices.is_large());
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
#[cfg_attr(not(target_arch = "wasm32"), inline(always))]
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
#[inline(never)]
fn find_cavity<S: MarkedSlots<4>>(
    slots: &mut S,
    here: &PredicatesAt<'_, '_, 3>,
    start: u32,
    scratch: &mut Scratch<S::Places>,
) -> bool {
    let Scratch { conflict, boundary, beyond, vertices, .. } = scratch;
    boundary.clear();
    vertices.clear();
    let (corners, around) = (corners(slots, start), slots.neighbors(start));
    let places = corners.map(|v| vertices.push(v, here));
    for (facet, beyond) in CAVITY_FACETS.iter().zip(around) {
        let corners_of = |all: [u32; 4]| facet.map(|k| all[k]);
        boundary.push(Facet { corners: corners_of(corners), beyond, places: FacetPlaces::new(corners_of(places)) });
    }
    conflict.push(start);
    mark(slots, start, state::CONFLICT);
    // The facets before `next` have been looked at, and those before `kept` are the cavity's so far.
    let (mut next, mut kept) = (0, 0);
    while let Some(&Facet { beyond: across, places, .. }) = boundary.get(next) {
        let facet = next;
        next += 1;
        let (other, k) = (across >> 2, across as usize & 3);
        let [first, apex] = slots.first_and(other, k);
        let apex = apex & !state::MASK;
        match first & state::MASK {
            state::CONFLICT => continue,
            state::UNKNOWN => {
                let (det, is_certain) = if boundary[facet].corners[2] == slots.infinite() {
                    (f64::NAN, false)
                } else {
                    here.insphere_of_rows(vertices.rows(places), apex)
                };
                let is_in_conflict = match is_certain {
                    true => det > 0.0,
                    false => test_again(slots, here, det, boundary[facet], vertices, beyond),
                };
                if is_in_conflict {
                    let place = match vertices.place(apex) {
                        Some(place) => place,
                        None if S::SHARED && !slots.claim(apex) => return false,
                        None => vertices.push(apex, here),
                    };
                    slots.set_first(other, first | state::CONFLICT);
                    conflict.push(other);
                    // The three other facets of the tetrahedron replace this one.
                    let Facet { corners: [a, b, c], places, .. } = boundary[facet];
                    let [_, x] = slots.first_and(other, (k + 1) % 4);
                    let x = x & !state::MASK;
                    let order = ORDERS[k][usize::from(x == b) + 2 * usize::from(x == c)];
                    let [beyond_a, beyond_b, beyond_c] = slots.some_neighbors(other, order);
                    let [abd, bcd, cad] = places.around(place);
                    boundary.extend([
                        Facet { corners: [a, b, apex], beyond: beyond_c, places: abd },
                        Facet { corners: [b, c, apex], beyond: beyond_a, places: bcd },
                        Facet { corners: [c, a, apex], beyond: beyond_b, places: cad },
                    ]);
                    if c == slots.infinite() {
                        bring_last(boundary);
                    }
                    continue;
                }
            }
            _ => {}
        }
        boundary[kept] = boundary[facet];
        kept += 1;
    }
    boundary.truncate(kept);
    true
}

/// In the last two facets, (b, c, d) and (c, a, d), brings c to the end.
#[cold]
fn bring_last(facets: &mut [Facet]) {
    if let [.., bcd, cad] = facets {
        (*bcd, *cad) = (bcd.rotate().rotate(), cad.rotate());
    }
}

/// Returns whether what is beyond a facet is in conflict with the vertex `here`, from the value `det`
/// of its in-sphere determinant, which does not decide. If not, marks it, lest this is asked again.
#[inline(never)]
fn test_again<S: MarkedSlots<4>>(
    slots: &mut S,
    here: &PredicatesAt<'_, '_, 3>,
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
