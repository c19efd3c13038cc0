//! The segments, the pieces that they are cut into, and the points on them.

use super::shape::Shape;
use crate::{
    constrained::{
        growing::Growing,
        topology::{next, previous},
    },
    index::NONE,
};

/// What a vertex is: a given point; a point on this segment; or one that was added beside segments.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Vertex {
    Given,
    On(u32),
    Free,
}

/// A part of a segment that is an edge.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    /// Its ends, in the direction of the segment.
    pub(super) ends: [u32; 2],
    pub(super) segment: u32,
    /// The next piece of the segment; [`NONE`] for the last.
    pub(super) next: u32,
    pub(super) is_queued: bool,
    /// Whether it cannot be cut, as coordinates are too coarse.
    pub(super) is_last: bool,
}

/// The segments and their pieces. The first piece of a segment has the number of the segment.
pub(super) struct Pieces {
    /// The lower vertex of each first.
    pub(super) segments: Vec<[u32; 2]>,
    /// Segments before this one are the constrained edges of the mesh, which ascend; the others are edges of the hull.
    pub(super) constraints: usize,
    /// Whether each segment meets another one under less than 60° at its ends.
    is_acute: Vec<[bool; 2]>,
    pub(super) pieces: Vec<Piece>,
    pub(super) vertices: Vec<Vertex>,
}

impl Pieces {
    /// Takes the constrained edges of a mesh, and the edges of the hull that bound what is inside.
    pub(super) fn new(mesh: &mut Growing, constraints: &[[u32; 2]]) -> Self {
        let mut segments = constraints.to_vec();
        segments.extend(mesh.mark_hull());
        let whole =
            |(segment, &ends): (u32, &[u32; 2])| Piece { ends, segment, next: NONE, is_queued: false, is_last: false };
        let pieces = (0..).zip(&segments).map(whole).collect();
        let is_acute = vec![[false; 2]; segments.len()];
        let vertices = vec![Vertex::Given; mesh.points.len()];
        Pieces { segments, constraints: constraints.len(), is_acute, pieces, vertices }
    }

    /// Finds where segments meet under less than 60° inside.
    pub(super) fn find_acute(&mut self, mesh: &Growing, shape: &Shape<'_>) {
        for e in 0..3 * mesh.triangles.len() as u32 {
            let first = mesh.piece(e);
            if first == NONE || !mesh.is_inside(e) {
                continue;
            }
            // Counter-clockwise up to the next piece.
            let mut at = e;
            let second = loop {
                let closing = previous(at);
                match mesh.piece(closing) {
                    NONE => at = mesh.twin(closing),
                    piece => break piece,
                }
                if at == NONE || at == e {
                    break NONE;
                }
            };
            if second == NONE || second == first {
                continue;
            }
            let apex = mesh.origin(e);
            let [a, b] = [mesh.target(e), mesh.origin(previous(at))].map(|v| mesh.point(v));
            if shape.is_acute(mesh.point(apex), a, b) {
                for segment in [first, second].map(|segment| segment as usize) {
                    self.is_acute[segment][usize::from(self.segments[segment][1] == apex)] = true;
                }
            }
        }
    }

    /// Returns whether the segment of a piece meets another one under less than 60°.
    pub(super) fn is_acute(&self, piece: u32) -> bool {
        self.is_acute[self.pieces[piece as usize].segment as usize].contains(&true)
    }

    /// Returns where to cut a piece in two: in the middle, or on a shell around the end of its segment that is acute. If both
    /// are, each has half of the segment.
    pub(super) fn place(&self, mesh: &Growing, shape: &Shape<'_>, piece: u32) -> [f64; 2] {
        let Piece { ends, segment, .. } = self.pieces[piece as usize];
        let piece = ends.map(|v| mesh.point(v));
        let middle = shape.middle(piece);
        let [a, b] = self.segments[segment as usize].map(|v| mesh.point(v));
        match self.is_acute[segment as usize] {
            [true, true] if self.segments[segment as usize] == ends => middle,
            [true, true] if shape.square(a, middle) > shape.square(b, middle) => shape.on_shell(piece, b, a),
            [true, _] => shape.on_shell(piece, a, b),
            [_, true] => shape.on_shell(piece, b, a),
            _ => middle,
        }
    }

    /// Cuts a piece in two at a vertex. The second part comes after all pieces.
    pub(super) fn cut(&mut self, piece: u32, vertex: u32) {
        let second = self.pieces.len() as u32;
        let whole = self.pieces[piece as usize];
        let [start, end] = whole.ends;
        let of = |ends, next| Piece { ends, next, is_queued: false, ..whole };
        self.pieces[piece as usize] = of([start, vertex], second);
        self.pieces.push(of([vertex, end], whole.next));
    }

    /// Returns the pieces of a segment from its lower vertex on.
    pub(super) fn of_segment(&self, segment: u32) -> impl Iterator<Item = [u32; 2]> + Clone + '_ {
        let after = |&piece: &u32| Some(self.pieces[piece as usize].next).filter(|&next| next != NONE);
        std::iter::successors(Some(segment), after).map(|piece| self.pieces[piece as usize].ends)
    }

    /// Returns whether a triangle whose shortest edge is a given half-edge has to stay as it is, because of an angle between
    /// segments: its smallest angle is one, or the edge joins two segments at the same distance from where they meet under
    /// less than 60° (Miller, Pav and Walkington 2003). A point that improves it would come too near the segments, and
    /// points on these would make the same triangle anew, smaller.
    pub(super) fn is_between(&self, mesh: &Growing, shape: &Shape<'_>, e: u32) -> bool {
        if mesh.piece(next(e)) != NONE && mesh.piece(previous(e)) != NONE {
            return true;
        }
        if mesh.piece(e) != NONE {
            return false;
        }
        let [u, v] = [mesh.origin(e), mesh.target(e)];
        let of = |v: u32| self.vertices[v as usize];
        let meeting = match (of(u), of(v)) {
            (Vertex::On(s), Vertex::On(t)) if s != t => {
                let [s, t] = [s, t].map(|s| self.segments[s as usize]);
                s.into_iter().find(|v| t.contains(v))
            }
            (Vertex::On(s), Vertex::Given) => self.meeting(s, v),
            (Vertex::Given, Vertex::On(s)) => self.meeting(s, u),
            _ => None,
        };
        meeting.is_some_and(|center| {
            let [center, u, v] = [center, u, v].map(|v| mesh.point(v));
            shape.are_on_shell(center, u, v)
        })
    }

    /// Returns the end of a segment from which another segment leads to a vertex.
    fn meeting(&self, segment: u32, v: u32) -> Option<u32> {
        let (constraints, hull) = self.segments.split_at(self.constraints);
        let is_segment = |w: &u32| {
            let ends = [v.min(*w), v.max(*w)];
            constraints.binary_search(&ends).is_ok() || hull.binary_search(&ends).is_ok()
        };
        self.segments[segment as usize].into_iter().filter(|&w| w != v).find(is_segment)
    }
}
