//! Bowyer–Watson insertion (1981): find the triangles whose circumcircles contain the new point,
//! and fill their cavity with triangles at the point.
//!
//! The outside of the hull is triangulated too, by *ghosts*, triangles that join the edges of the
//! hull to one infinite vertex, so that no edge is special. The in-circle test breaks its ties
//! symbolically and never returns zero, so the cavity is star-shaped, has no vertex inside, and no
//! new triangle is flat.

use crate::{
    cpu::Insert,
    d2::triangulation::MAX_TRIANGLES,
    error::Error,
    predicates::filter::{PredicateContext2, PredicatesAt},
    slots::Slots,
};

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
}

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

    fn locate(&self, vertices: &PredicateContext2<'_>, p: u32, start: u32) -> u32 {
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

    fn insert(
        &mut self,
        vertices: &PredicateContext2<'_>,
        p: u32,
        start: u32,
        scratch: &mut Scratch,
    ) -> Result<Option<u32>, Error> {
        if S::SHARED && !can_begin(self, vertices, p, start) {
            return Ok(None);
        }
        // The new triangles are two more than the old ones.
        if !find_cavity(self, &vertices.at(p), start, scratch) || !self.has_room(2) {
            return Ok(None);
        }
        let Scratch { conflict, boundary, .. } = scratch;
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

    fn finish(&mut self, _scratch: Scratch) {}
}

/// Returns the ends of the edge opposite corner `k` of a triangle, with the triangle on the left.
pub(crate) fn edge_of(triangle: [u32; 3], k: usize) -> [u32; 2] {
    [triangle[NEXT[k]], triangle[PREVIOUS[k]]]
}

/// Returns whether the circumcircle of `t` contains the vertex `here`.
///
/// The circumcircle of a ghost is the half-plane beyond its edge and, on the edge's line, the edge
/// itself: the part of the line inside the circumcircle of the triangle on the other side of the
/// edge.
#[inline]
pub(crate) fn in_conflict(slots: &impl Slots<3>, here: &PredicatesAt<'_, '_, 2>, t: u32) -> bool {
    let v = slots.simplex(t);
    match v.iter().position(|&v| v == slots.infinite()) {
        None => here.incircle(v) > 0,
        Some(k) => {
            let [a, b] = edge_of(v, k);
            match here.orient2d(a, b) {
                0 => here.is_between(a, b),
                side => side > 0,
            }
        }
    }
}

/// Claims `p` and the vertices of `start`, to which a walk among triangles that other threads
/// change has led. Returns whether `start` exists and is in conflict with `p`.
fn can_begin(slots: &mut impl Slots<3>, vertices: &PredicateContext2<'_>, p: u32, start: u32) -> bool {
    let seen = slots.simplex(start);
    seen[0] != seen[1]
        && slots.claim(p)
        && seen.iter().all(|&v| slots.claim(v))
        && slots.simplex(start) == seen
        && in_conflict(slots, &vertices.at(p), start)
}

/// Lists the triangles in conflict with the vertex `here`, and the edges around them, counter-clockwise,
/// depth-first. Returns whether all their vertices could be claimed.
///
/// No vertex lies inside the cavity, so the adjacencies of its triangles form a tree, and none is
/// visited twice.
fn find_cavity<S: Slots<3>>(slots: &mut S, here: &PredicatesAt<'_, '_, 2>, start: u32, scratch: &mut Scratch) -> bool {
    let Scratch { conflict, boundary, pending } = scratch;
    conflict.clear();
    boundary.clear();
    pending.clear();
    conflict.push(start);
    let edge = |slots: &S, t: u32, k: usize| Edge { ends: edge_of(slots.simplex(t), k), beyond: slots.neighbors(t)[k] };
    pending.extend([edge(slots, start, 2), edge(slots, start, 1), edge(slots, start, 0)]);
    while let Some(next) = pending.pop() {
        let (t, k) = (next.beyond >> 2, (next.beyond & 3) as usize);
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
