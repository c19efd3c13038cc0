//! Triangles under change: half-edges, marks of constrained edges, and flips.

use crate::{
    d2::Mesh2,
    index::NONE,
    input::points::Points2,
    predicates::{
        Sign, incircle, orient2d,
        symbolic::{break_tie, without},
    },
};

/// Returns the next half-edge around the triangle.
pub(super) fn next(e: u32) -> u32 {
    if e % 3 == 2 { e - 2 } else { e + 1 }
}

/// Returns the half-edge before, around the triangle.
pub(super) fn previous(e: u32) -> u32 {
    if e.is_multiple_of(3) { e + 2 } else { e - 1 }
}

/// The triangles of a mesh, with marks.
///
/// Half-edge *e* = 3·*t* + *k* goes from vertex *k* of triangle *t* to the next one. Neither the hull nor
/// the number of triangles changes.
pub(super) struct Marked<'a> {
    points: Points2<'a>,
    pub(super) triangles: Vec<[u32; 3]>,
    halfedges: Vec<[u32; 3]>,
    /// Bit *k* of entry *t* says whether edge *k* of triangle *t* is constrained.
    marks: Vec<u8>,
    /// A half-edge that starts at each vertex; [`NONE`] for points that are no vertices.
    start: Vec<u32>,
    /// Half-edges that may not be locally Delaunay.
    pending: Vec<u32>,
}

impl<'a> Marked<'a> {
    /// Takes the triangles of a mesh of these points, without a mark.
    pub(super) fn new(mesh: &mut Mesh2, points: Points2<'a>) -> Self {
        let (triangles, halfedges) = (std::mem::take(&mut mesh.triangles), std::mem::take(&mut mesh.halfedges));
        let mut start = vec![NONE; points.len()];
        for (e, &v) in (0..).zip(triangles.as_flattened()) {
            start[v as usize] = e;
        }
        Marked { points, marks: vec![0; triangles.len()], triangles, halfedges, start, pending: Vec::new() }
    }

    /// Gives the triangles back.
    pub(super) fn restore(self, mesh: &mut Mesh2) {
        (mesh.triangles, mesh.halfedges) = (self.triangles, self.halfedges);
    }

    pub(super) fn point(&self, v: u32) -> [f64; 2] {
        self.points.get(v as usize)
    }

    /// Returns the vertex where a half-edge starts.
    pub(super) fn origin(&self, e: u32) -> u32 {
        self.triangles[e as usize / 3][e as usize % 3]
    }

    /// Returns the vertex where a half-edge ends.
    pub(super) fn target(&self, e: u32) -> u32 {
        self.origin(next(e))
    }

    /// Returns the half-edge against another; [`NONE`] on the hull.
    pub(super) fn twin(&self, e: u32) -> u32 {
        self.halfedges[e as usize / 3][e as usize % 3]
    }

    /// Returns a half-edge that starts at a vertex; [`NONE`] if it has no triangles.
    pub(super) fn start(&self, v: u32) -> u32 {
        self.start[v as usize]
    }

    pub(super) fn is_marked(&self, e: u32) -> bool {
        self.marks[e as usize / 3] >> (e % 3) & 1 == 1
    }

    fn set_mark(&mut self, e: u32, is_marked: bool) {
        let (mark, bit) = (&mut self.marks[e as usize / 3], 1 << (e % 3));
        *mark = if is_marked { *mark | bit } else { *mark & !bit };
    }

    /// Marks an edge as constrained.
    pub(super) fn mark(&mut self, e: u32) {
        self.set_mark(e, true);
        let twin = self.twin(e);
        if twin != NONE {
            self.set_mark(twin, true);
        }
    }

    /// Removes all marks.
    pub(super) fn unmark_all(&mut self) {
        for (t, mark) in (0..).zip(&mut self.marks) {
            let marked = (0..3).filter(|k| *mark >> k & 1 == 1).map(|k| 3 * t + k);
            self.pending.extend(marked);
            *mark = 0;
        }
    }

    /// Puts half-edges against each other, either of which has the mark of the edge between them.
    pub(super) fn join(&mut self, e: u32, twin: u32, is_marked: bool) {
        self.halfedges[e as usize / 3][e as usize % 3] = twin;
        self.set_mark(e, is_marked);
        if twin != NONE {
            self.halfedges[twin as usize / 3][twin as usize % 3] = e;
            self.set_mark(twin, is_marked);
        }
    }

    /// Writes the vertices of a triangle.
    pub(super) fn put(&mut self, t: u32, vertices: [u32; 3]) {
        self.triangles[t as usize] = vertices;
        for (e, v) in (3 * t..).zip(vertices) {
            self.start[v as usize] = e;
        }
    }

    pub(super) fn orient2d(&self, a: u32, b: u32, c: u32) -> Sign {
        orient2d(self.point(a), self.point(b), self.point(c))
    }

    /// Returns whether a vertex is on the same side of another as a third one, in the order of the coordinates: of
    /// collinear vertices, whether two are in the same direction.
    pub(super) fn is_towards(&self, from: u32, v: u32, goal: u32) -> bool {
        let [from, v, goal] = [from, v, goal].map(|v| self.point(v));
        (from < v) == (from < goal)
    }

    /// Notes that an edge may not be locally Delaunay.
    pub(super) fn doubt(&mut self, e: u32) {
        self.pending.push(e);
    }

    /// Flips the edges in doubt, and what that puts in doubt, until all are constrained or locally Delaunay
    /// (Lawson 1977).
    pub(super) fn flip_pending(&mut self) {
        while let Some(e) = self.pending.pop() {
            let twin = self.twin(e);
            if twin == NONE || self.is_marked(e) || self.is_delaunay(e, twin) {
                continue;
            }
            let (t, u) = self.flip(e, twin);
            self.pending.extend([3 * t, 3 * t + 1, 3 * u, 3 * u + 1]);
        }
    }

    /// Returns whether the vertex beyond an edge is outside the circumcircle of the triangle before it; ties are
    /// broken by the input order.
    fn is_delaunay(&self, e: u32, twin: u32) -> bool {
        let four = [self.origin(e), self.target(e), self.origin(previous(e)), self.origin(previous(twin))];
        let [a, b, c, d] = four.map(|v| self.point(v));
        let sign = match incircle(a, b, c, d) {
            0 => break_tie(four, |left_out| {
                let [a, b, c] = without(four, left_out);
                self.orient2d(a, b, c)
            }),
            sign => sign,
        };
        sign <= 0
    }

    /// Replaces edge ab of the triangles a, b, p and b, a, q by pq: they become p, a, q and q, b, p, which are
    /// returned. The edges between these two are their last ones.
    fn flip(&mut self, e: u32, twin: u32) -> (u32, u32) {
        let outer = [previous(e), next(twin), previous(twin), next(e)];
        let [p, a, q, b] = outer.map(|e| self.origin(e));
        let [pa, aq, qb, bp] = outer.map(|e| (self.twin(e), self.is_marked(e)));
        let (t, u) = (e / 3, twin / 3);
        self.put(t, [p, a, q]);
        self.put(u, [q, b, p]);
        for (e, (across, is_marked)) in [(3 * t, pa), (3 * t + 1, aq), (3 * u, qb), (3 * u + 1, bp)] {
            self.join(e, across, is_marked);
        }
        self.join(3 * t + 2, 3 * u + 2, false);
        (t, u)
    }
}
