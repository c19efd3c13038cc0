//! Bowyer–Watson insertion (1981): find the triangles whose circumcircles contain the new point,
//! and fill their cavity with triangles at the point.
//!
//! The outside of the hull is triangulated too, by *ghosts*, triangles that join the edges of the
//! hull to one infinite vertex, so that no edge is special. The in-circle test breaks its ties
//! symbolically and never returns zero, so the cavity is star-shaped, has no vertex inside, and no
//! new triangle is flat.
//!
//! With weights the test is the power test, and all of that stays true except that vertices may lie inside the cavity:
//! they become hidden, and slots are left over. A point that is not in conflict with the triangle that contains it is
//! hidden, too.

use crate::{
    cpu::Insert,
    d2::triangulation::MAX_TRIANGLES,
    error::Error,
    index::BuildIndexHasher,
    predicates::filter::{PredicateContext, PredicatesAt},
    slots::Slots,
};
use std::collections::HashSet;

/// The maximum number of points: a sphere of *n* + 1 vertices has 2·*n* − 2 triangles.
pub(crate) const MAX_POINTS: usize = MAX_TRIANGLES / 2;

/// An edge of a cavity.
#[derive(Clone, Copy)]
struct Edge {
    /// The start and the end, with the cavity on the left.
    ends: [u32; 2],
    /// The triangle outside the cavity: 4·(triangle) + (edge as it is numbered there).
    beyond: u32,
}

/// Lists that insertions reuse.
#[derive(Default)]
pub struct Scratch {
    /// The triangles in conflict, whose slots the new triangles take.
    conflict: Vec<u32>,
    /// The edges of the cavity, counter-clockwise.
    boundary: Vec<Edge>,
    /// The edges that are still to be crossed, the next one last.
    pending: Vec<Edge>,
    /// Slots that cavities with vertices inside have left over.
    free: Vec<u32>,
    large: Large,
}

/// With weights, the triangles in conflict if they are more than [`FEW`].
type Large = HashSet<u32, BuildIndexHasher>;

/// So few triangles in conflict are searched one by one.
const FEW: usize = 32;

/// The corner after corner *k* of a triangle, counter-clockwise.
pub(crate) const NEXT: [usize; 3] = [1, 2, 0];
/// The corner before corner *k* of a triangle, counter-clockwise.
pub(crate) const PREVIOUS: [usize; 3] = [2, 0, 1];

/// A walk among triangles that other threads change ends after this many: it may go in circles.
const MAX_STEPS: usize = 1 << 16;

impl<S: Slots<3>> Insert<2> for S {
    type Scratch = Scratch;

    const REPORT: usize = 1 << 13;

    fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    fn locate<const W: bool>(&self, vertices: &PredicateContext<'_, 2, W>, p: u32, start: u32) -> u32 {
        let mut t = match self.simplex(start).iter().position(|&v| v == self.infinite()) {
            Some(k) => self.neighbors(start)[k] >> 2,
            None => start,
        };
        let here = vertices.at(p);
        let mut came_through = 3;
        let mut steps = 0;
        'walk: loop {
            let v = self.simplex(t);
            if v.contains(&self.infinite()) || (S::SHARED && steps == MAX_STEPS) {
                return t;
            }
            steps += 1;
            for k in 0..3 {
                let [a, b] = edge_of(v, k);
                if k != came_through && here.orient2d(a, b) < 0 {
                    let across = self.neighbors(t)[k];
                    (t, came_through) = (across >> 2, across as usize & 3);
                    continue 'walk;
                }
            }
            return t;
        }
    }

    fn insert<const W: bool>(
        &mut self,
        vertices: &PredicateContext<'_, 2, W>,
        p: u32,
        start: u32,
        scratch: &mut Scratch,
    ) -> Result<Option<u32>, Error> {
        if S::SHARED && !can_begin(self, p, start) {
            return Ok(None);
        }
        let here = vertices.at(p);
        if (S::SHARED || W) && !in_conflict(self, &here, start) {
            // The point is hidden, unless another thread has misled the walk.
            return Ok((W && (!S::SHARED || contains(self, &here, start))).then_some(start));
        }
        // The new triangles are two more than the old ones, or fewer if vertices lie inside the cavity.
        if !find_cavity(self, &here, start, scratch) || !self.has_room(2) {
            return Ok(None);
        }
        let Scratch { conflict, boundary, free, .. } = scratch;
        if W && conflict.len() > boundary.len() {
            for slot in conflict.drain(boundary.len()..) {
                // No walk of another thread takes this for a triangle.
                self.set_simplex(slot, [0; 3]);
                free.push(slot);
            }
        }
        if W {
            let missing = boundary.len() - conflict.len();
            conflict.extend(free.drain(free.len().saturating_sub(missing)..));
        }
        while conflict.len() < boundary.len() {
            conflict.push(self.push()?);
        }
        // Around p, each new triangle shares one edge with the previous triangle and one with the
        // next.
        let mut before = conflict[boundary.len() - 1];
        for (i, &Edge { ends: [a, b], beyond }) in boundary.iter().enumerate() {
            let new = conflict[i];
            let next = if i + 1 < boundary.len() { conflict[i + 1] } else { conflict[0] };
            self.set_simplex(new, [p, a, b]);
            self.set_neighbors(new, [beyond, 4 * next + 2, 4 * before + 1]);
            self.set_neighbor(beyond, 4 * new);
            before = new;
        }
        Ok(Some(before))
    }

    fn finish(&mut self, mut scratch: Scratch) {
        scratch.free.sort_unstable();
        scratch.free.into_iter().rev().for_each(|slot| self.discard(slot));
    }
}

/// Returns the ends of the edge opposite corner `k` of a triangle, with the triangle on the left.
pub(crate) fn edge_of(triangle: [u32; 3], k: usize) -> [u32; 2] {
    [triangle[NEXT[k]], triangle[PREVIOUS[k]]]
}

/// Returns whether the circumcircle of `t` contains the vertex `here`.
///
/// The circumcircle of a ghost is the half-plane beyond its edge and, on the edge's line, the edge
/// itself: the part of the line inside the circumcircle of the triangle on the other side of the
/// edge. With weights, that is not the edge.
#[inline]
pub(crate) fn in_conflict<const W: bool>(slots: &impl Slots<3>, here: &PredicatesAt<'_, '_, 2, W>, t: u32) -> bool {
    let v = slots.simplex(t);
    match v.iter().position(|&v| v == slots.infinite()) {
        None => here.incircle(v) > 0,
        Some(k) => {
            let [a, b] = edge_of(v, k);
            match here.orient2d(a, b) {
                0 if W => here.incircle(slots.simplex(slots.neighbors(t)[k] >> 2)) > 0,
                0 => here.is_between(a, b),
                side => side > 0,
            }
        }
    }
}

/// Claims `p` and the vertices of `start`, to which a walk among triangles that other threads
/// change has led. Returns whether `start` exists.
fn can_begin(slots: &mut impl Slots<3>, p: u32, start: u32) -> bool {
    let seen = slots.simplex(start);
    seen[0] != seen[1] && slots.claim(p) && seen.iter().all(|&v| slots.claim(v)) && slots.simplex(start) == seen
}

/// Returns whether `t` is a triangle that contains the vertex `here`.
fn contains<const W: bool>(slots: &impl Slots<3>, here: &PredicatesAt<'_, '_, 2, W>, t: u32) -> bool {
    let v = slots.simplex(t);
    let is_within = |k: usize| {
        let [a, b] = edge_of(v, k);
        here.orient2d(a, b) >= 0
    };
    !v.contains(&slots.infinite()) && (0..3).all(is_within)
}

/// Lists the triangles in conflict with the vertex `here`, and the edges around them, counter-clockwise,
/// depth-first. Returns whether all their vertices could be claimed.
///
/// Without weights no vertex lies inside the cavity, so the adjacencies of its triangles form a tree, and none is
/// visited twice. With weights, the edges to triangles that have been visited already are left out. They are those
/// along which the cavity would have to be cut to have no vertex inside, so the others stay in their order.
fn find_cavity<S: Slots<3>, const W: bool>(
    slots: &mut S,
    here: &PredicatesAt<'_, '_, 2, W>,
    start: u32,
    scratch: &mut Scratch,
) -> bool {
    let Scratch { conflict, boundary, pending, large, .. } = scratch;
    conflict.clear();
    boundary.clear();
    pending.clear();
    conflict.push(start);
    let edge = |slots: &S, t: u32, k: usize| Edge { ends: edge_of(slots.simplex(t), k), beyond: slots.neighbors(t)[k] };
    pending.extend([edge(slots, start, 2), edge(slots, start, 1), edge(slots, start, 0)]);
    while let Some(next) = pending.pop() {
        let (t, k) = (next.beyond >> 2, (next.beyond & 3) as usize);
        if W && has(conflict, large, t) {
            continue;
        }
        if in_conflict(slots, here, t) {
            if S::SHARED && !slots.claim(slots.simplex(t)[k]) {
                return false;
            }
            conflict.push(t);
            pending.extend([edge(slots, t, PREVIOUS[k]), edge(slots, t, NEXT[k])]);
        } else {
            boundary.push(next);
        }
    }
    true
}

/// Returns whether a triangle is one of those in conflict, of which all but the last are in `large` if they are many.
fn has(conflict: &[u32], large: &mut Large, t: u32) -> bool {
    if conflict.len() <= FEW {
        return conflict.contains(&t);
    }
    if conflict.len() == FEW + 1 {
        large.clear();
        large.extend(conflict);
    }
    large.extend(conflict.last());
    large.contains(&t)
}
