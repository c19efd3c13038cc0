//! Triangles under change: half-edges, marks of constrained edges, and flips.

use crate::{
    d2::Mesh2,
    index::NONE,
    input::points::Points2,
    parallel::{Threads, for_chunks},
    predicates::{
        Sign, incircle, orient2d,
        symbolic::{break_tie, without},
    },
};
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};

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
/// the number of triangles changes. Several threads change triangles at once, each its own.
pub(super) struct Marked<'a> {
    points: Points2<'a>,
    triangles: Vec<[AtomicU32; 3]>,
    halfedges: Vec<[AtomicU32; 3]>,
    /// Bit *k* of entry *t* says whether edge *k* of triangle *t* is constrained.
    marks: Vec<AtomicU8>,
    /// A half-edge that starts at each vertex; [`NONE`] for points that are no vertices. All threads write this:
    /// whichever is last, the half-edge is right.
    start: Vec<AtomicU32>,
}

impl<'a> Marked<'a> {
    /// Takes the triangles of a mesh of these points, without a mark.
    pub(super) fn new(mesh: &mut Mesh2, points: Points2<'a>) -> Self {
        let start: Vec<AtomicU32> = (0..points.len()).map(|_| AtomicU32::new(NONE)).collect();
        for (e, &v) in (0..).zip(mesh.triangles.as_flattened()) {
            start[v as usize].store(e, Relaxed);
        }
        let marks = mesh.triangles.iter().map(|_| AtomicU8::new(0)).collect();
        // Both collections reuse the memory of the lists.
        let shared =
            |list: &mut Vec<[u32; 3]>| std::mem::take(list).into_iter().map(|row| row.map(AtomicU32::new)).collect();
        Marked { points, triangles: shared(&mut mesh.triangles), halfedges: shared(&mut mesh.halfedges), marks, start }
    }

    /// Gives the triangles back.
    pub(super) fn restore(self, mesh: &mut Mesh2) {
        let own = |list: Vec<[AtomicU32; 3]>| list.into_iter().map(|row| row.map(AtomicU32::into_inner)).collect();
        (mesh.triangles, mesh.halfedges) = (own(self.triangles), own(self.halfedges));
    }

    /// Returns a half-edge that starts at a vertex; [`NONE`] if it has no triangles.
    pub(super) fn start(&self, v: u32) -> u32 {
        self.start[v as usize].load(Relaxed)
    }

    /// Returns all triangles as one part.
    pub(super) fn whole(&mut self) -> Part<'_> {
        self.part(&[], 0)
    }

    /// Returns the triangles of one owner. Only one thread at a time may change them.
    pub(super) fn part<'m>(&'m self, owners: &'m [u8], own: u8) -> Part<'m> {
        Part { mesh: self, owners, own, pending: Vec::new(), elsewhere: Vec::new() }
    }

    /// Assigns each triangle to one of `count` owners, and returns these. An owner has the triangles whose first vertex is
    /// in its strip of the plane. Strips lie across the axis along which `starts` are spread more, and divide them evenly.
    pub(super) fn owners(&self, threads: Threads, count: usize, starts: impl Iterator<Item = u32>) -> Vec<u8> {
        let mut places: Vec<[f64; 2]> = starts.map(|v| self.points.get(v as usize)).collect();
        let spread = |axis: usize| {
            let along = places.iter().map(|p| p[axis]);
            along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
        };
        let axis = usize::from(spread(1) > spread(0));
        places.sort_unstable_by(|p, q| p[axis].total_cmp(&q[axis]));
        let bounds: Vec<f64> = (1..count).map(|i| places[i * places.len() / count][axis]).collect();
        // A look at the points in the order of the triangles would take several times as long.
        let mut of_vertices = vec![0; self.points.len()];
        for_chunks(threads, &mut of_vertices, |first, owners| {
            for (owner, v) in owners.iter_mut().zip(first..) {
                let along = self.points.get(v)[axis];
                *owner = bounds.partition_point(|&bound| bound <= along) as u8;
            }
        });
        let mut owners = vec![0; self.triangles.len()];
        for_chunks(threads, &mut owners, |first, owners| {
            for (owner, [v, ..]) in owners.iter_mut().zip(&self.triangles[first..]) {
                *owner = of_vertices[v.load(Relaxed) as usize];
            }
        });
        owners
    }

    /// Removes all marks. Returns the edges that had them.
    pub(super) fn unmark_all(&mut self) -> Vec<u32> {
        let mut marked = Vec::new();
        for (t, mark) in (0..).zip(&mut self.marks) {
            let mark = std::mem::take(mark.get_mut());
            marked.extend((0..3).filter(|k| mark >> k & 1 == 1).map(|k| 3 * t + k));
        }
        marked
    }
}

/// Those triangles of a mesh that one thread changes. All others are elsewhere: other threads may change them.
pub(super) struct Part<'m> {
    mesh: &'m Marked<'m>,
    /// Of each triangle; empty if this part has them all.
    owners: &'m [u8],
    own: u8,
    /// Half-edges that may not be locally Delaunay.
    pending: Vec<u32>,
    /// Those of them that cannot be flipped without triangles that are elsewhere.
    elsewhere: Vec<u32>,
}

impl Part<'_> {
    /// Returns the number of triangles of the mesh.
    pub(super) fn mesh_len(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// Returns whether a half-edge is of one of the triangles.
    pub(super) fn has(&self, e: u32) -> bool {
        self.owners.get(e as usize / 3).is_none_or(|&owner| owner == self.own)
    }

    /// Returns whether a half-edge is of a triangle elsewhere.
    pub(super) fn is_elsewhere(&self, e: u32) -> bool {
        e != NONE && !self.has(e)
    }

    pub(super) fn point(&self, v: u32) -> [f64; 2] {
        self.mesh.points.get(v as usize)
    }

    /// Returns the vertex where a half-edge starts.
    pub(super) fn origin(&self, e: u32) -> u32 {
        self.mesh.triangles[e as usize / 3][e as usize % 3].load(Relaxed)
    }

    /// Returns the vertex where a half-edge ends.
    pub(super) fn target(&self, e: u32) -> u32 {
        self.origin(next(e))
    }

    /// Returns the half-edge against another; [`NONE`] on the hull.
    pub(super) fn twin(&self, e: u32) -> u32 {
        self.mesh.halfedges[e as usize / 3][e as usize % 3].load(Relaxed)
    }

    /// Returns a half-edge that starts at a vertex; [`NONE`] if it has no triangles.
    pub(super) fn start(&self, v: u32) -> u32 {
        self.mesh.start(v)
    }

    pub(super) fn is_marked(&self, e: u32) -> bool {
        self.mesh.marks[e as usize / 3].load(Relaxed) >> (e % 3) & 1 == 1
    }

    fn set_mark(&mut self, e: u32, is_marked: bool) {
        let (mark, bit) = (&self.mesh.marks[e as usize / 3], 1 << (e % 3));
        let before = mark.load(Relaxed);
        mark.store(if is_marked { before | bit } else { before & !bit }, Relaxed);
    }

    /// Marks an edge as constrained.
    pub(super) fn mark(&mut self, e: u32) {
        self.set_mark(e, true);
        let twin = self.twin(e);
        if twin != NONE {
            self.set_mark(twin, true);
        }
    }

    /// Puts half-edges against each other, either of which has the mark of the edge between them.
    pub(super) fn join(&mut self, e: u32, twin: u32, is_marked: bool) {
        for (from, to) in [(e, twin), (twin, e)] {
            if from != NONE {
                self.mesh.halfedges[from as usize / 3][from as usize % 3].store(to, Relaxed);
                self.set_mark(from, is_marked);
            }
        }
    }

    /// Writes the vertices of a triangle.
    pub(super) fn put(&mut self, t: u32, vertices: [u32; 3]) {
        for ((e, v), place) in (3 * t..).zip(vertices).zip(&self.mesh.triangles[t as usize]) {
            place.store(v, Relaxed);
            self.mesh.start[v as usize].store(e, Relaxed);
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

    /// Notes that edges may not be locally Delaunay.
    pub(super) fn doubt(&mut self, edges: impl IntoIterator<Item = u32>) {
        self.pending.extend(edges);
    }

    /// Flips the edges in doubt, and what that puts in doubt, until all are constrained or locally Delaunay
    /// (Lawson 1977), except for those beside triangles that are elsewhere.
    pub(super) fn flip_pending(&mut self) {
        while let Some(e) = self.pending.pop() {
            let twin = self.twin(e);
            if twin == NONE || self.is_marked(e) {
                continue;
            }
            if !self.has(twin) {
                self.elsewhere.push(e);
                continue;
            }
            if self.is_delaunay(e, twin) {
                continue;
            }
            let outer = [previous(e), next(twin), previous(twin), next(e)];
            if outer.iter().any(|&e| self.is_elsewhere(self.twin(e))) {
                self.elsewhere.push(e);
                continue;
            }
            let (t, u) = self.flip(e, twin);
            self.pending.extend([3 * t, 3 * t + 1, 3 * u, 3 * u + 1]);
        }
    }

    /// Returns the edges in doubt that are left.
    pub(super) fn left(self) -> Vec<u32> {
        self.elsewhere
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
