//! Triangles of a mesh that gains and loses vertices.
//!
//! A vertex that comes replaces the triangles in conflict with it, its cavity, by those that join it to the border of
//! the cavity (Bowyer 1981, Watson 1981). The search for the cavity crosses no piece of a segment, so the mesh stays
//! the constrained Delaunay triangulation. A triangle is entered only through an edge that the vertex sees, and where the
//! vertex is in conflict with it, it sees the other two edges, too: both are exact, so the cavity has the shape of a star,
//! and no triangle that is made is flat or turned.

use super::topology::{next, previous};
use crate::{
    d2::Mesh2,
    error::Error,
    index::NONE,
    predicates::{
        Sign,
        exact::{expansions_are_exact, incircle_by_expansions, orient2d_by_expansions},
        incircle, orient2d,
        symbolic::{break_tie, without},
    },
};

/// A vertex with more triangles than this is not removed.
const MAX_DEGREE: usize = 32;

/// A triangle. Edge *k* goes from vertex *k* to the next; half-edge 3·*t* + *k* is that of triangle *t*.
#[derive(Clone, Copy)]
pub(super) struct Triangle {
    /// [`NONE`] three times for a slot without a triangle.
    pub(super) vertices: [u32; 3],
    /// The opposite half-edge of each edge; [`NONE`] on the hull.
    pub(super) across: [u32; 3],
    /// The piece of a segment that each edge is; [`NONE`] for others.
    pub(super) pieces: [u32; 3],
    pub(super) is_inside: bool,
}

const NO_TRIANGLE: Triangle = Triangle { vertices: [NONE; 3], across: [NONE; 3], pieces: [NONE; 3], is_inside: false };

/// An edge on the border of a cavity, and what is on the other side of it.
#[derive(Clone, Copy)]
struct Border {
    from: u32,
    to: u32,
    across: u32,
    piece: u32,
    is_inside: bool,
}

/// Where a walk ends.
pub(super) enum Place {
    /// In this triangle or on an edge of it that is no piece.
    Triangle(u32),
    /// At this piece, which is in the way.
    Piece(u32),
    /// At a vertex, or outside the hull.
    Nowhere,
}

/// A mesh that does not fit its points: an error of who made it.
pub(super) const BROKEN: Error = Error::BrokenMesh { reason: "a point has no place in it" };

/// The triangles, and the points.
pub(super) struct Growing {
    pub(super) points: Vec<[f64; 2]>,
    /// Whether the expansions of predicates are exact for all points.
    is_moderate: bool,
    pub(super) triangles: Vec<Triangle>,
    /// A half-edge of each piece.
    pub(super) edges: Vec<u32>,
    /// The triangles that the last change made.
    pub(super) made: Vec<u32>,
    /// Slots without triangles.
    free: Vec<u32>,
    cavity: Vec<u32>,
    border: Vec<Border>,
    stack: Vec<u32>,
    /// The corners of the ears that fill the place of a vertex, by their places along its border.
    ears: Vec<[usize; 3]>,
}

impl Growing {
    /// Copies the triangles of a mesh, each from its lowest vertex on: what is done with them must not depend on how the
    /// mesh was made. `segments` are its constrained edges, which ascend; each is one piece.
    ///
    /// # Errors
    ///
    /// [`Error::BrokenMesh`].
    pub(super) fn new(mesh: &Mesh2, inside: &[bool], points: Vec<[f64; 2]>) -> Result<Self, Error> {
        let count = mesh.triangles.len();
        let bad = |reason| Err(Error::BrokenMesh { reason });
        if mesh.halfedges.len() != count || inside.len() != count {
            return bad("its arrays have different lengths");
        }
        if mesh.triangles.as_flattened().contains(&NONE) {
            return bad("a vertex is not a point");
        }
        let shifts: Vec<u8> =
            mesh.triangles.iter().map(|t| (0..3).min_by_key(|&k| t[k as usize]).unwrap_or(0)).collect();
        let moved = |e: u32| match shifts.get(e as usize / 3) {
            Some(&shift) => e - e % 3 + (e % 3 + 3 - u32::from(shift)) % 3,
            None => NONE,
        };
        let mut first = vec![0u32; points.len() + 1];
        mesh.constraints.iter().for_each(|&[low, _]| first[low as usize + 1] += 1);
        (0..points.len()).for_each(|v| first[v + 1] += first[v]);
        let piece = |[a, b]: [u32; 2]| {
            let [low, high] = [a.min(b), a.max(b)];
            let range = first[low as usize] as usize..first[low as usize + 1] as usize;
            let found = mesh.constraints[range.clone()].binary_search(&[low, high]);
            found.map_or(NONE, |i| (range.start + i) as u32)
        };
        let mut edges = vec![NONE; mesh.constraints.len()];
        let mut triangles = Vec::with_capacity(2 * count);
        for (t, &shift) in shifts.iter().enumerate() {
            let (mut vertices, mut across) = (mesh.triangles[t], mesh.halfedges[t]);
            vertices.rotate_left(shift.into());
            across.rotate_left(shift.into());
            let pieces = [0, 1, 2].map(|k| piece([vertices[k], vertices[(k + 1) % 3]]));
            for (k, &piece) in pieces.iter().enumerate().filter(|&(_, &piece)| piece != NONE) {
                // Of two, the one that starts at the lower vertex.
                if edges[piece as usize] == NONE || vertices[k] < vertices[(k + 1) % 3] {
                    edges[piece as usize] = (3 * t + k) as u32;
                }
            }
            let [a, b, c] = vertices.map(|v| points[v as usize]);
            if orient2d(a, b, c) <= 0 {
                return bad("a triangle is flat or clockwise");
            }
            triangles.push(Triangle { vertices, across: across.map(moved), pieces, is_inside: inside[t] });
        }
        let (free, cavity, border) = Default::default();
        let (stack, ears, made) = Default::default();
        let is_moderate = expansions_are_exact(&points);
        let growing = Growing { points, is_moderate, triangles, edges, made, free, cavity, border, stack, ears };
        let is_mutual = |e: u32| {
            let twin = growing.twin(e);
            twin == NONE || growing.twin(twin) == e && growing.origin(twin) == growing.target(e)
        };
        if growing.edges.contains(&NONE) || !(0..3 * count as u32).all(is_mutual) {
            return bad("edges are not those of the triangles");
        }
        Ok(growing)
    }

    pub(super) fn point(&self, v: u32) -> [f64; 2] {
        self.points[v as usize]
    }

    pub(super) fn origin(&self, e: u32) -> u32 {
        self.triangles[e as usize / 3].vertices[e as usize % 3]
    }

    pub(super) fn target(&self, e: u32) -> u32 {
        self.origin(next(e))
    }

    /// Returns the vertex opposite an edge.
    pub(super) fn apex(&self, e: u32) -> u32 {
        self.origin(previous(e))
    }

    pub(super) fn twin(&self, e: u32) -> u32 {
        self.triangles[e as usize / 3].across[e as usize % 3]
    }

    pub(super) fn piece(&self, e: u32) -> u32 {
        self.triangles[e as usize / 3].pieces[e as usize % 3]
    }

    pub(super) fn is_inside(&self, e: u32) -> bool {
        self.triangles[e as usize / 3].is_inside
    }

    /// Makes an edge a piece.
    pub(super) fn mark(&mut self, e: u32, piece: u32) {
        self.triangles[e as usize / 3].pieces[e as usize % 3] = piece;
        let twin = self.twin(e);
        if twin != NONE {
            self.triangles[twin as usize / 3].pieces[twin as usize % 3] = piece;
        }
        self.edges[piece as usize] = e;
    }

    /// Prepares for questions about the places of these points, which are no vertices.
    pub(super) fn prepare_for(&mut self, points: &[[f64; 2]]) {
        self.is_moderate &= expansions_are_exact(points);
    }

    /// Makes the edges of the hull pieces where it bounds what is inside, unless they are pieces already. Returns their
    /// ends, the lower vertex of each first; they ascend.
    pub(super) fn mark_hull(&mut self) -> Vec<[u32; 2]> {
        let is_bare = |e: &u32| self.twin(*e) == NONE && self.piece(*e) == NONE && self.is_inside(*e);
        let mut bare: Vec<u32> = (0..3 * self.triangles.len() as u32).filter(is_bare).collect();
        let ends = |mesh: &Self, e: u32| {
            let (from, to) = (mesh.origin(e), mesh.target(e));
            [from.min(to), from.max(to)]
        };
        bare.sort_unstable_by_key(|&e| ends(self, e));
        let first = self.edges.len();
        self.edges.resize(first + bare.len(), NONE);
        (first as u32..).zip(&bare).for_each(|(piece, &e)| self.mark(e, piece));
        bare.into_iter().map(|e| ends(self, e)).collect()
    }

    /// Adds a point, which is no vertex yet.
    pub(super) fn push(&mut self, p: [f64; 2]) {
        self.is_moderate &= expansions_are_exact(&[p]);
        self.points.push(p);
    }

    fn orient2d(&self, a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
        if self.is_moderate { orient2d_by_expansions(a, b, c) } else { orient2d(a, b, c) }
    }

    /// Returns the side of the line from a vertex to another on which a point is: 1 on the left, −1 on the right.
    pub(super) fn orient(&self, a: u32, b: u32, p: [f64; 2]) -> Sign {
        self.orient2d(self.point(a), self.point(b), p)
    }

    /// Walks from a triangle straight to the last point, up to the first piece of a segment.
    pub(super) fn walk(&self, t: u32) -> Place {
        let goal = self.points[self.points.len() - 1];
        let Some(mut crossed) = (3 * t..3 * t + 3).find(|&e| self.orient(self.origin(e), self.target(e), goal) < 0)
        else {
            return self.place(t, goal);
        };
        let start = self.point(self.apex(crossed));
        // Every step leads to another triangle along a line, so there are at most as many as triangles.
        for _ in 0..self.triangles.len() {
            match (self.piece(crossed), self.twin(crossed)) {
                (NONE, NONE) => return Place::Nowhere,
                (NONE, twin) => {
                    let is_right = self.orient2d(start, goal, self.point(self.apex(twin))) > 0;
                    crossed = if is_right { next(twin) } else { previous(twin) };
                    if self.orient(self.origin(crossed), self.target(crossed), goal) >= 0 {
                        return self.place(crossed / 3, goal);
                    }
                }
                (piece, _) => return Place::Piece(piece),
            }
        }
        Place::Nowhere
    }

    /// Returns the place of a point in a triangle or on its border.
    pub(super) fn place(&self, t: u32, p: [f64; 2]) -> Place {
        let mut on = None;
        for e in 3 * t..3 * t + 3 {
            match self.orient(self.origin(e), self.target(e), p) {
                0 if on.is_some() => return Place::Nowhere,
                0 => on = Some(e),
                1 => {}
                _ => return Place::Nowhere,
            }
        }
        match on.map(|e| self.piece(e)) {
            None | Some(NONE) => Place::Triangle(t),
            Some(piece) => Place::Piece(piece),
        }
    }

    /// Returns whether a vertex is inside the circumcircle of three others, which are counter-clockwise; ties are broken
    /// by the input order.
    fn is_in_circle(&self, [a, b, c]: [u32; 3], v: u32) -> bool {
        let four = [a, b, c, v];
        let [pa, pb, pc, p] = four.map(|v| self.point(v));
        let sign = if self.is_moderate { incircle_by_expansions(pa, pb, pc, p) } else { incircle(pa, pb, pc, p) };
        let is_in = |left_out| {
            let [a, b, c] = without(four, left_out);
            self.orient(a, b, self.point(c))
        };
        (if sign == 0 { break_tie(four, is_in) } else { sign }) > 0
    }

    /// Finds the cavity of the last point, which is in a triangle.
    ///
    /// # Errors
    ///
    /// [`BROKEN`].
    pub(super) fn dig(&mut self, t: u32) -> Result<(), Error> {
        self.cavity.clear();
        self.border.clear();
        self.cavity.push(t);
        self.stack.extend([3 * t + 2, 3 * t + 1, 3 * t]);
        self.spread()
    }

    /// Finds the cavity of the last point, which cuts a piece in two, on it or beside it. Returns false if the point is not
    /// in one of the triangles beside the piece, as where coordinates are too coarse.
    ///
    /// # Errors
    ///
    /// [`BROKEN`].
    pub(super) fn dig_at(&mut self, piece: u32) -> Result<bool, Error> {
        let e = self.edges[piece as usize];
        let vertex = self.points.len() as u32 - 1;
        let sees = |e: u32| self.orient(self.origin(e), self.target(e), self.point(vertex));
        let side = sees(e);
        let (near, far) = if side < 0 { (self.twin(e), e) } else { (e, self.twin(e)) };
        if near == NONE || sees(next(near)) <= 0 || sees(previous(near)) <= 0 {
            return Ok(false);
        }
        self.cavity.clear();
        self.border.clear();
        self.cavity.push(near / 3);
        self.stack.extend([previous(near), next(near)]);
        self.spread()?;
        if far != NONE && self.is_in_circle(self.triangles[far as usize / 3].vertices, vertex) {
            self.cavity.push(far / 3);
            self.stack.extend([previous(far), next(far)]);
            self.spread()?;
        } else if side != 0 {
            // What was the piece stays as an edge, since the pieces have a bend. On the hull, what is between these is outside.
            let is_inside = far != NONE && self.is_inside(far);
            let [from, to] = [self.origin(near), self.target(near)];
            self.border.push(Border { from, to, across: far, piece: NONE, is_inside });
        }
        Ok(true)
    }

    /// Adds the triangles in conflict with the last point that are beyond the edges on the stack to its cavity, and the
    /// others to the border, counter-clockwise.
    fn spread(&mut self) -> Result<(), Error> {
        let vertex = self.points.len() as u32 - 1;
        while let Some(e) = self.stack.pop() {
            let (across, piece) = (self.twin(e), self.piece(e));
            if across != NONE && piece == NONE {
                let beyond = across / 3;
                if self.is_in_circle(self.triangles[beyond as usize].vertices, vertex) {
                    if self.cavity.len() >= self.triangles.len() {
                        return Err(BROKEN);
                    }
                    self.cavity.push(beyond);
                    self.stack.extend([previous(across), next(across)]);
                    continue;
                }
            }
            let border =
                Border { from: self.origin(e), to: self.target(e), across, piece, is_inside: self.is_inside(e) };
            self.border.push(border);
        }
        Ok(())
    }

    /// Returns the triangles of the cavity.
    pub(super) fn cavity(&self) -> &[u32] {
        &self.cavity
    }

    /// Returns the pieces on the border of the cavity.
    pub(super) fn border_pieces(&self) -> impl Iterator<Item = u32> + '_ {
        self.border.iter().map(|border| border.piece).filter(|&piece| piece != NONE)
    }

    /// Joins the last point to the border of its cavity.
    pub(super) fn fill(&mut self) {
        let vertex = self.points.len() as u32 - 1;
        self.made.clear();
        for i in 0..self.border.len() {
            let Border { from, to, across, piece, is_inside } = self.border[i];
            let t = self.slot();
            self.triangles[t as usize] = Triangle {
                vertices: [vertex, from, to],
                across: [NONE, across, NONE],
                pieces: [NONE, piece, NONE],
                is_inside,
            };
            self.attach(3 * t + 1, across, piece);
            self.made.push(t);
        }
        self.release();
        let last = self.border.len() - 1;
        for (i, &t) in self.made.iter().enumerate() {
            let after = self.made[if i == last { 0 } else { i + 1 }];
            let (out, back) = (3 * t + 2, 3 * after);
            // On the hull, the last is not beside the first.
            if self.origin(out) == self.target(back) {
                self.triangles[t as usize].across[2] = back;
                self.triangles[after as usize].across[0] = out;
            }
        }
    }

    /// Does the same with the cavity of a point that cuts a piece with these ends in two. The part at the first end keeps
    /// the number of the piece. Returns that of the other.
    pub(super) fn fill_cut(&mut self, piece: u32, [start, end]: [u32; 2]) -> u32 {
        self.fill();
        let second = self.edges.len() as u32;
        self.edges.push(NONE);
        for i in 0..self.made.len() {
            let t = self.made[i];
            let [_, from, to] = self.triangles[t as usize].vertices;
            for (v, e) in [(from, 3 * t), (to, 3 * t + 2)] {
                if v == start {
                    self.mark(e, piece);
                } else if v == end {
                    self.mark(e, second);
                }
            }
        }
        second
    }

    /// Puts a new half-edge against what is across it.
    fn attach(&mut self, e: u32, across: u32, piece: u32) {
        if across != NONE {
            let triangle = &mut self.triangles[across as usize / 3];
            (triangle.across[across as usize % 3], triangle.pieces[across as usize % 3]) = (e, piece);
        }
        if piece != NONE {
            self.edges[piece as usize] = e;
        }
    }

    /// Returns a slot for a triangle: one of the cavity, a free one, or a new one.
    fn slot(&mut self) -> u32 {
        let old = self.cavity.pop().or_else(|| self.free.pop());
        old.unwrap_or_else(|| {
            self.triangles.push(NO_TRIANGLE);
            self.triangles.len() as u32 - 1
        })
    }

    /// Frees what is left of the cavity.
    fn release(&mut self) {
        while let Some(t) = self.cavity.pop() {
            self.triangles[t as usize] = NO_TRIANGLE;
            self.free.push(t);
        }
    }

    /// Removes the vertex where a half-edge starts, which is on no segment. Returns false if it has too many triangles, or
    /// if the triangles that are to fill its place are not found at once, as where its neighbours do not see each other.
    pub(super) fn remove(&mut self, e: u32) -> bool {
        self.cavity.clear();
        self.border.clear();
        let mut at = e;
        loop {
            let outer = next(at);
            self.cavity.push(at / 3);
            let (from, to) = (self.origin(outer), self.target(outer));
            let (across, piece) = (self.twin(outer), self.piece(outer));
            self.border.push(Border { from, to, across, piece, is_inside: self.is_inside(at) });
            at = self.twin(previous(at));
            if at == e {
                break;
            }
            if at == NONE || self.border.len() == MAX_DEGREE {
                return false;
            }
        }
        if !self.find_ears() {
            return false;
        }
        self.made.clear();
        for i in 0..self.ears.len() {
            let [before, ear, after] = self.ears[i];
            let t = self.slot();
            let sides = [self.border[before], self.border[ear]];
            let vertices = [sides[0].from, sides[1].from, sides[1].to];
            let mut triangle = Triangle { vertices, is_inside: sides[0].is_inside, ..NO_TRIANGLE };
            for (k, side) in sides.into_iter().enumerate() {
                (triangle.across[k], triangle.pieces[k]) = (side.across, side.piece);
            }
            let closing = self.border[after];
            if i + 1 == self.ears.len() {
                (triangle.across[2], triangle.pieces[2]) = (closing.across, closing.piece);
            }
            self.triangles[t as usize] = triangle;
            for k in 0..3 {
                self.attach(3 * t + k, triangle.across[k as usize], triangle.pieces[k as usize]);
            }
            let Border { from, is_inside, .. } = sides[0];
            self.border[before] = Border { from, to: sides[1].to, across: 3 * t + 2, piece: NONE, is_inside };
            self.made.push(t);
        }
        self.release();
        true
    }

    /// Finds the triangles that fill the place of a vertex inside its border. Each is an ear of what is left: the places
    /// of the edges before it and behind it, and of that after these.
    fn find_ears(&mut self) -> bool {
        self.ears.clear();
        let mut left: Vec<usize> = (0..self.border.len()).collect();
        while left.len() >= 3 {
            let count = left.len();
            let corners: Vec<u32> = left.iter().map(|&i| self.border[i].from).collect();
            let is_ear = |&i: &usize| {
                let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % count]);
                self.orient(a, b, self.point(c)) > 0
                    && (3..count).all(|k| !self.is_in_circle([a, b, c], corners[(i + k) % count]))
            };
            let Some(i) = (0..count).find(is_ear) else { return false };
            let ear = (i + 1) % count;
            self.ears.push([left[i], left[ear], left[(i + 2) % count]]);
            if count == 3 {
                return true;
            }
            left.remove(ear);
        }
        false
    }
}

/// Returns the vertices of the hull of a mesh from the lowest on.
pub(super) fn hull(mesh: &Mesh2) -> Vec<u32> {
    let mut after = vec![NONE; mesh.duplicate_of.len()];
    for (t, across) in mesh.halfedges.iter().enumerate() {
        for k in (0..3).filter(|&k| across[k] == NONE) {
            let [from, to] = mesh.edge(t, k);
            after[from as usize] = to;
        }
    }
    let first = after.iter().position(|&to| to != NONE).map(|v| v as u32);
    let on = |&v: &u32| Some(after[v as usize]).filter(|&v| Some(v) != first && v != NONE);
    std::iter::successors(first, on).take(after.len()).collect()
}
