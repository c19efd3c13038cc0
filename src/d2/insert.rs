//! Bowyer–Watson insertion (1981): find the triangles whose circumcircles contain the new point,
//! and fill their cavity with triangles at the point.
//!
//! The outside of the hull is triangulated too, by *ghosts*, triangles that join the edges of the
//! hull to one infinite vertex, so that no edge is special. The in-circle test breaks its ties
//! symbolically and never returns zero, so the cavity is star-shaped, has no vertex inside, and no
//! new triangle is flat.

use crate::d2::triangulation::{MAX_TRIANGLES, Triangulation2};
use crate::{cpu::Insert, error::Error, predicates::filter::PredicateContext2, slots};

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

impl Insert<2> for Triangulation2 {
    type Scratch = Scratch;

    const SIMPLICES_PER_POINT: usize = 2;
    const REPORT: usize = 1 << 13;

    /// Creates one triangle, and the ghosts on its three edges.
    fn initial(infinite: u32) -> Self {
        let triangles = vec![[0, 1, 2], [infinite, 2, 1], [0, 2, infinite], [1, 0, infinite]];
        let neighbors = vec![[0; 3]; 4];
        let mut mesh = Triangulation2 { triangles, neighbors, infinite };
        for t in 0..4 {
            for k in 0..3 {
                // The edge with the opposite direction.
                let [from, to] = mesh.edge(t, k);
                let against = (0..12).map(|e| [e / 3, e % 3]).find(|&[u, l]| mesh.edge(u, l) == [to, from]);
                if let Some([u, l]) = against {
                    mesh.join(4 * t + k, 4 * u + l);
                }
            }
        }
        mesh
    }

    fn reserve(&mut self, triangles: usize) -> Result<(), Error> {
        slots::reserve(&mut self.triangles, &mut self.neighbors, triangles)
    }

    fn scratch(_vertices: usize) -> Scratch {
        Scratch::default()
    }

    fn locate(&self, vertices: &PredicateContext2<'_>, p: u32, start: u32) -> u32 {
        let mut t = match self.triangles[start as usize].iter().position(|&v| v == self.infinite) {
            Some(k) => self.neighbors[start as usize][k] >> 2,
            None => start,
        };
        let mut came_through = 3;
        'walk: loop {
            for k in 0..3 {
                let [a, b] = self.edge(t, k);
                if k != came_through && vertices.orient2d(a, b, p) < 0 {
                    let across = self.neighbors[t as usize][k as usize];
                    (t, came_through) = (across >> 2, across & 3);
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
        vertices: &PredicateContext2<'_>,
        p: u32,
        start: u32,
        scratch: &mut Scratch,
    ) -> Result<u32, Error> {
        self.find_cavity(vertices, p, start, scratch);
        let Scratch { conflict, boundary, .. } = scratch;
        while conflict.len() < boundary.len() {
            conflict.push(slots::push(&mut self.triangles, &mut self.neighbors, MAX_TRIANGLES)?);
        }
        // Around p, each new triangle shares one edge with the previous triangle and one with the
        // next.
        let mut before = conflict[boundary.len() - 1];
        for (i, &Edge { ends: [a, b], beyond }) in boundary.iter().enumerate() {
            let new = conflict[i];
            let next = if i + 1 < boundary.len() { conflict[i + 1] } else { conflict[0] };
            self.triangles[new as usize] = [p, a, b];
            self.neighbors[new as usize] = [beyond, 4 * next + 2, 4 * before + 1];
            self.neighbors[beyond as usize / 4][beyond as usize % 4] = 4 * new;
            before = new;
        }
        Ok(before)
    }

    fn finish(&mut self, _scratch: Scratch) {}
}

impl Triangulation2 {
    /// Returns the ends of the edge of `t` opposite its corner `k`, with `t` on the left.
    fn edge(&self, t: u32, k: u32) -> [u32; 2] {
        let v = self.triangles[t as usize];
        [v[NEXT[k as usize]], v[PREVIOUS[k as usize]]]
    }

    /// Returns whether the circumcircle of `t` contains vertex `p`.
    ///
    /// The circumcircle of a ghost is the half-plane beyond its edge and, on the edge's line, the
    /// edge itself: the part of the line inside the circumcircle of the triangle on the other side
    /// of the edge.
    #[inline]
    pub(crate) fn in_conflict(&self, vertices: &PredicateContext2<'_>, t: u32, p: u32) -> bool {
        let v = self.triangles[t as usize];
        match v.iter().position(|&v| v == self.infinite) {
            None => vertices.incircle(v, p) > 0,
            Some(k) => {
                let [a, b] = [v[NEXT[k]], v[PREVIOUS[k]]];
                match vertices.orient2d(a, b, p) {
                    0 => vertices.is_between(a, p, b),
                    side => side > 0,
                }
            }
        }
    }

    /// Lists the triangles in conflict with `p`, and the edges around them, counter-clockwise,
    /// depth-first.
    ///
    /// No vertex lies inside the cavity, so the adjacencies of its triangles form a tree, and none
    /// is visited twice.
    fn find_cavity(&mut self, vertices: &PredicateContext2<'_>, p: u32, start: u32, scratch: &mut Scratch) {
        let Scratch { conflict, boundary, pending } = scratch;
        conflict.clear();
        boundary.clear();
        conflict.push(start);
        let edge = |t: u32, k: usize| Edge { ends: self.edge(t, k as u32), beyond: self.neighbors[t as usize][k] };
        pending.extend([edge(start, 2), edge(start, 1), edge(start, 0)]);
        while let Some(next) = pending.pop() {
            let (t, k) = (next.beyond >> 2, (next.beyond & 3) as usize);
            if self.in_conflict(vertices, t, p) {
                conflict.push(t);
                pending.extend([edge(t, PREVIOUS[k]), edge(t, NEXT[k])]);
            } else {
                boundary.push(next);
            }
        }
    }
}
