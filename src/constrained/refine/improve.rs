//! The points that make a mesh better (Ruppert 1995, Chew 1993, Shewchuk 2002).
//!
//! 1. A piece of a segment to which a vertex is too near is cut in two. Before that, what was added near it is removed.
//! 2. A bad triangle gets a point at its centre or off-centre, unless a piece is in the way or the point is too near one:
//!    then that is cut.
//!
//! Pieces go first; of the triangles, those with the shortest edges. The order depends on the points alone.

use super::{
    RefineOptions, Size,
    pieces::{Pieces, Vertex},
    queue::Queue,
    shape::{Measures, Shape},
};
use crate::{
    constrained::{
        growing::{Growing, Place},
        topology::previous,
    },
    error::Error,
    index::NONE,
};
use std::collections::VecDeque;

/// Where a point is moved that is not beside the segment that it is to cut, but outside the hull: by units in the last place
/// of the coordinates there.
const NUDGES: [[f64; 2]; 8] =
    [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];

/// By how many of these it is moved at most.
const MAX_NUDGE: f64 = 4.0;

/// More triangles than this have half-edges that no index can name.
const MAX_TRIANGLES: usize = i32::MAX as usize / 3;

/// A mesh, and what is to be done with it.
pub(super) struct Improver<'a> {
    pub(super) mesh: Growing,
    pub(super) pieces: Pieces,
    pub(super) shape: Shape<'a>,
    /// The size at each vertex, if there is one for each point.
    sizes: Vec<f64>,
    /// Pieces that are to be cut.
    near: VecDeque<u32>,
    bad: Queue,
    /// How many more points there may be.
    left: usize,
    /// Whether a point was not added because of that.
    pub(super) is_limited: bool,
    pub(super) removed: usize,
}

impl<'a> Improver<'a> {
    pub(super) fn new(mut mesh: Growing, constraints: &[[u32; 2]], options: &RefineOptions<'a>) -> Self {
        let shape = Shape::new(options, &mesh.points);
        let mut pieces = Pieces::new(&mut mesh, constraints);
        pieces.find_acute(&mesh, &shape);
        let sizes = if let Size::PerPoint(sizes) = options.size { sizes.to_vec() } else { Vec::new() };
        let left = options.max_points.unwrap_or(usize::MAX);
        let (near, bad) = (VecDeque::new(), Queue::new());
        Improver { mesh, pieces, shape, sizes, near, bad, left, is_limited: false, removed: 0 }
    }

    /// Adds points until no triangle is bad that can be made better.
    ///
    /// # Errors
    ///
    /// [`Error::BrokenMesh`].
    pub(super) fn improve(&mut self) -> Result<(), Error> {
        (0..self.pieces.pieces.len() as u32).for_each(|piece| self.look_at_piece(piece));
        self.cut_pieces()?;
        self.enqueue_all();
        while let Some((t, vertices)) = self.bad.pop() {
            if self.mesh.triangles[t as usize].vertices != vertices {
                continue;
            }
            let cut = self.pieces.pieces.len();
            self.improve_triangle(t)?;
            self.cut_pieces()?;
            if self.is_limited {
                break;
            }
            if self.pieces.pieces.len() > cut && self.mesh.triangles[t as usize].vertices == vertices {
                self.look_at(t);
            }
        }
        Ok(())
    }

    /// Returns the corners of a triangle.
    fn corners(&self, t: u32) -> [[f64; 2]; 3] {
        self.mesh.triangles[t as usize].vertices.map(|v| self.mesh.point(v))
    }

    fn ends(&self, piece: u32) -> [[f64; 2]; 2] {
        self.pieces.pieces[piece as usize].ends.map(|v| self.mesh.point(v))
    }

    pub(super) fn measure(&self, t: u32) -> Measures {
        self.shape.measure(self.corners(t))
    }

    /// Returns whether a triangle is larger than allowed.
    pub(super) fn is_large(&self, t: u32, measures: &Measures) -> bool {
        let size = |v: u32| self.sizes.get(v as usize).copied().unwrap_or(0.0);
        self.shape.is_large(measures, self.corners(t), self.mesh.triangles[t as usize].vertices.map(size))
    }

    /// Returns whether a triangle has to stay as it is, because of an angle between segments.
    pub(super) fn is_between(&self, t: u32, measures: &Measures) -> bool {
        self.pieces.is_between(&self.mesh, &self.shape, 3 * t + measures.shortest as u32)
    }

    /// Enqueues a triangle if it is bad.
    fn look_at(&mut self, t: u32) {
        let triangle = &self.mesh.triangles[t as usize];
        let vertices = triangle.vertices;
        if !triangle.is_inside || vertices[0] == NONE {
            return;
        }
        let measures = self.measure(t);
        if self.shape.is_skinny(&measures) && !self.is_between(t, &measures) || self.is_large(t, &measures) {
            self.bad.push(Shape::key(&measures), (t, vertices));
        }
    }

    /// Enqueues all bad triangles, in the order of their vertices.
    fn enqueue_all(&mut self) {
        let mut order: Vec<([u32; 3], u32)> =
            (0..).zip(&self.mesh.triangles).map(|(t, all)| (all.vertices, t)).collect();
        for (vertices, _) in &mut order {
            let lowest = (0..3).min_by_key(|&k| vertices[k]).unwrap_or(0);
            vertices.rotate_left(lowest);
        }
        order.sort_unstable();
        order.into_iter().for_each(|(_, t)| self.look_at(t));
    }

    /// Enqueues what the last change made: bad triangles, and pieces that vertices have come too near.
    fn look_at_made(&mut self) {
        for i in 0..self.mesh.made.len() {
            let t = self.mesh.made[i];
            self.look_at(t);
            for piece in self.mesh.triangles[t as usize].pieces {
                if piece != NONE {
                    self.look_at_piece(piece);
                }
            }
        }
    }

    /// Enqueues a piece if a vertex beside it is too near.
    fn look_at_piece(&mut self, piece: u32) {
        let ends = self.ends(piece);
        let e = self.mesh.edges[piece as usize];
        let is_near = |e: u32| {
            e != NONE && self.mesh.is_inside(e) && self.shape.is_near(ends, self.mesh.point(self.mesh.apex(e)))
        };
        if is_near(e) || is_near(self.mesh.twin(e)) {
            self.enqueue_piece(piece);
        }
    }

    fn enqueue_piece(&mut self, piece: u32) {
        let entry = &mut self.pieces.pieces[piece as usize];
        if !entry.is_queued && !entry.is_last {
            entry.is_queued = true;
            self.near.push_back(piece);
        }
    }

    fn cut_pieces(&mut self) -> Result<(), Error> {
        while let Some(piece) = self.near.pop_front() {
            if self.is_full() {
                break;
            }
            // It counts as queued until it is cut, so that it is not cut twice.
            if !self.cut(piece)? {
                self.pieces.pieces[piece as usize].is_last = true;
            }
        }
        Ok(())
    }

    /// Returns whether no more points may be added, and notes it.
    fn is_full(&mut self) -> bool {
        let is_full = self.left == 0 || self.mesh.triangles.len() + 64 > MAX_TRIANGLES;
        self.is_limited |= is_full;
        is_full
    }

    /// Cuts a piece in two. Returns false if coordinates are too coarse for that.
    fn cut(&mut self, piece: u32) -> Result<bool, Error> {
        let place = self.pieces.place(&self.mesh, &self.shape, piece);
        if self.ends(piece).into_iter().any(|end| self.shape.is_finest(end, place)) {
            return Ok(false);
        }
        if !self.pieces.is_acute(piece) {
            self.clear(piece);
        }
        self.mesh.push(place);
        if !self.dig_near(piece, place)? {
            self.mesh.points.pop();
            return Ok(false);
        }
        self.left -= 1;
        let vertex = self.mesh.points.len() as u32 - 1;
        self.pieces.vertices.push(Vertex::On(self.pieces.pieces[piece as usize].segment));
        let [start, end] = self.pieces.pieces[piece as usize].ends;
        if !self.sizes.is_empty() {
            self.sizes.push(0.5 * self.sizes[start as usize] + 0.5 * self.sizes[end as usize]);
        }
        self.mesh.fill_cut(piece, [start, end]);
        self.pieces.cut(piece, vertex);
        self.look_at_made();
        Ok(true)
    }

    /// Finds the cavity of the last point at a place near a piece, or at one of those beside it.
    fn dig_near(&mut self, piece: u32, place: [f64; 2]) -> Result<bool, Error> {
        if self.mesh.dig_at(piece)? {
            return Ok(true);
        }
        let largest = self.ends(piece).as_flattened().iter().fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()));
        let mut unit = largest * f64::EPSILON;
        while unit <= MAX_NUDGE * f64::EPSILON * largest {
            for [x, y] in NUDGES {
                self.mesh.points.pop();
                self.mesh.push([place[0] + x * unit, place[1] + y * unit]);
                if self.mesh.dig_at(piece)? {
                    return Ok(true);
                }
            }
            unit *= 2.0;
        }
        Ok(false)
    }

    /// Removes what was added beside segments in the diametral circle of a piece and is visible from there, as in Chew's
    /// second algorithm.
    fn clear(&mut self, piece: u32) {
        let ends = self.ends(piece);
        for side in [false, true] {
            loop {
                let first = self.mesh.edges[piece as usize];
                // The side on the left of the piece, or that on the right.
                let is_left = self.mesh.origin(first) == self.pieces.pieces[piece as usize].ends[0];
                let e = if is_left == side { self.mesh.twin(first) } else { first };
                if e == NONE || !self.mesh.is_inside(e) {
                    break;
                }
                let apex = self.mesh.apex(e);
                let is_free = self.pieces.vertices[apex as usize] == Vertex::Free;
                if !is_free || !self.shape.is_in_diametral_circle(ends, self.mesh.point(apex)) {
                    break;
                }
                if !self.mesh.remove(previous(e)) {
                    break;
                }
                self.removed += 1;
                self.left = self.left.saturating_add(1);
                self.look_at_made();
            }
        }
    }

    /// Adds a point for a bad triangle, or enqueues the pieces that are in its way.
    fn improve_triangle(&mut self, t: u32) -> Result<(), Error> {
        let corners = self.corners(t);
        let measures = self.measure(t);
        let [a, b] = [0, 1].map(|k| corners[(measures.shortest + k) % 3]);
        if self.shape.is_finest(a, b) || self.shape.is_flat(&measures, corners) {
            return Ok(());
        }
        let place = self.shape.improving_point(&measures, corners);
        if !place.iter().all(|x| x.is_finite()) {
            return Ok(());
        }
        self.mesh.push(place);
        let near = match self.mesh.walk(t) {
            Place::Piece(piece) => vec![piece],
            Place::Triangle(start) if !self.is_full() => {
                self.mesh.dig(start)?;
                let is_near = |&piece: &u32| self.shape.is_near(self.ends(piece), place);
                let near: Vec<u32> = self.mesh.border_pieces().filter(is_near).collect();
                if near.is_empty() {
                    self.join(start, place);
                    return Ok(());
                }
                near
            }
            _ => Vec::new(),
        };
        self.mesh.points.pop();
        near.into_iter().for_each(|piece| self.enqueue_piece(piece));
        Ok(())
    }

    /// Makes the last point, at this place in a triangle, a vertex.
    fn join(&mut self, start: u32, place: [f64; 2]) {
        self.left -= 1;
        self.pieces.vertices.push(Vertex::Free);
        if !self.sizes.is_empty() {
            self.sizes.push(self.size_at(start, place));
        }
        self.mesh.fill();
        // The new vertex is near no piece.
        (0..self.mesh.made.len()).for_each(|i| self.look_at(self.mesh.made[i]));
    }

    /// Returns the size at a place in a triangle: linear between those at its vertices.
    fn size_at(&self, t: u32, place: [f64; 2]) -> f64 {
        let corners = self.corners(t);
        let sizes = self.mesh.triangles[t as usize].vertices.map(|v| self.sizes[v as usize]);
        let shares = [0, 1, 2].map(|k| self.shape.double_area([corners[(k + 1) % 3], corners[(k + 2) % 3], place]));
        let whole = shares[0] + shares[1] + shares[2];
        (0..3).map(|k| sizes[k] * (shares[k] / whole)).sum()
    }
}
