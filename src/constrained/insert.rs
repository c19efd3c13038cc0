//! Segments become edges of a triangulation.
//!
//! A segment goes from vertex to vertex in pieces. For each piece:
//!
//! 1. Walk from one end to the other, and collect the edges that it crosses.
//! 2. The triangles that it crosses are a cavity, which the piece cuts in two. Each part is a polygon of which
//!    every vertex sees the piece, so a scan that cuts ears off triangulates it in linear time (Toussaint and Avis
//!    1982). An edge inside the cavity that is not crossed is on the polygon twice, once from either side.
//! 3. Flips make the new triangles constrained Delaunay.
//!
//! A piece that crosses a constrained edge is left out, and the crossing noted.
//!
//! Several threads insert at once, each in a part of the triangles. What needs triangles of other parts is left until
//! one thread has all of them. The triangulation does not depend on the order, so threads need not agree on one.

use super::topology::{Part, next, previous};
use crate::{index::NONE, predicates::Sign};
use rustc_hash::FxHashMap;

/// As many triangles as most vertices have no more of.
const FEW: usize = 8;

/// What insertion says of the segments.
#[derive(Debug, Default)]
pub(super) struct Inserted {
    /// The constrained edges, the lower vertex first, each with the segment that it is a piece of. An edge of
    /// several segments is there once for each.
    pub(super) pieces: Vec<([u32; 2], u32)>,
    /// The pieces that are left out: the constrained edge that one crosses, and its segment.
    pub(super) crossings: Vec<([u32; 2], u32)>,
    /// What is left of segments that lead elsewhere: the segment, and the vertices between which it is to be inserted.
    pub(super) left: Vec<(u32, [u32; 2])>,
}

impl Inserted {
    /// Moves all that another one says to the end of this one.
    pub(super) fn append(&mut self, other: &mut Self) {
        self.pieces.append(&mut other.pieces);
        self.crossings.append(&mut other.crossings);
        self.left.append(&mut other.left);
    }
}

/// Inserts segments into a part of a triangulation.
pub(super) struct Inserter<'m> {
    mesh: Part<'m>,
    inserted: Inserted,
    cavity: Cavity,
}

/// What a piece crosses.
#[derive(Default)]
struct Cavity {
    /// The triangles.
    triangles: Vec<u32>,
    /// The half-edges along the border, to the left of the piece and to its right, both as seen from where it starts.
    sides: [Vec<u32>; 2],
    /// The edges of both polygons, one after the other.
    chain: Vec<Link>,
    /// Vertices that are left of a polygon, each with what is beyond the edge to it.
    stack: Vec<(u32, Facing)>,
    /// Edges of which one side has been rebuilt: the half-edge that was against it, and that which is to be joined.
    open: FxHashMap<u32, u32>,
}

/// An edge of the polygon.
#[derive(Clone, Copy)]
struct Link {
    /// Its end, on the way along the polygon.
    end: u32,
    facing: Facing,
}

/// What is on the other side of an edge of the polygon.
#[derive(Clone, Copy)]
struct Facing {
    across: u32,
    is_marked: bool,
    /// The half-edge on this side, if the cavity is on both.
    inner: u32,
}

impl Facing {
    const NOTHING: Facing = Facing { across: NONE, is_marked: false, inner: NONE };
}

/// How a segment leaves a vertex.
enum Way {
    /// Along an edge, to this vertex.
    Along(u32, u32),
    /// Through the triangle in which this half-edge starts at the vertex.
    Through(u32),
    /// Perhaps through triangles that are elsewhere.
    Elsewhere,
}

/// A turn around a vertex in search of the way to another.
struct Turn {
    vertex: u32,
    goal: u32,
    first: u32,
    at: u32,
    is_clockwise: bool,
    /// On which sides of the goal's direction the other vertices of the triangle are, if the one before had them.
    sides: [Option<Sign>; 2],
}

impl Turn {
    fn new(mesh: &Part<'_>, vertex: u32, goal: u32) -> Self {
        let first = mesh.start(vertex);
        Turn { vertex, goal, first, at: first, is_clockwise: false, sides: [None; 2] }
    }

    /// Looks at the next triangle. Returns the way if it is there.
    fn step(&mut self, mesh: &Part<'_>) -> Option<Way> {
        let e = self.at;
        if e == NONE {
            return None;
        }
        if !mesh.has(e) {
            return Some(Way::Elsewhere);
        }
        let (p, q) = (mesh.target(e), mesh.origin(previous(e)));
        if p == self.goal {
            return Some(Way::Along(p, e));
        }
        if q == self.goal {
            return Some(Way::Along(q, previous(e)));
        }
        let side = |v: u32| mesh.orient2d(self.vertex, self.goal, v);
        let [right, left] = self.sides;
        let (right, left) = (right.unwrap_or_else(|| side(p)), left.unwrap_or_else(|| side(q)));
        if right == 0 && mesh.is_towards(self.vertex, p, self.goal) {
            return Some(Way::Along(p, e));
        }
        if left == 0 && mesh.is_towards(self.vertex, q, self.goal) {
            return Some(Way::Along(q, previous(e)));
        }
        if right < 0 && left > 0 {
            return Some(Way::Through(e));
        }
        self.turn(mesh, right, left);
        None
    }

    /// Goes on counter-clockwise, and clockwise from where it began once the hull is reached.
    fn turn(&mut self, mesh: &Part<'_>, right: Sign, left: Sign) {
        if !self.is_clockwise {
            let on = mesh.twin(previous(self.at));
            if on != NONE {
                self.at = if on == self.first { NONE } else { on };
                self.sides = [Some(left), None];
                return;
            }
        }
        let (from, left) = if self.is_clockwise { (self.at, Some(right)) } else { (self.first, None) };
        self.is_clockwise = true;
        self.sides = [None, left];
        let on = mesh.twin(from);
        self.at = if on == NONE { NONE } else { next(on) };
    }
}

/// Why a piece is not inserted.
enum Stop {
    /// It needs triangles that are elsewhere. Nothing has been changed.
    Elsewhere,
    /// A way that should be there is not.
    Lost,
}

/// An error of the program or of the mesh: a way that should be there is not.
pub(super) struct Lost;

impl<'m> Inserter<'m> {
    pub(super) fn new(mesh: Part<'m>) -> Self {
        Inserter { mesh, inserted: Inserted::default(), cavity: Cavity::default() }
    }

    /// Returns what insertion says, and the edges that may not be locally Delaunay because of triangles elsewhere.
    pub(super) fn finish(self) -> (Inserted, Vec<u32>) {
        (self.inserted, self.mesh.left())
    }

    /// Inserts the segment between two different vertices, as far as it leads through the triangles of this part.
    pub(super) fn insert(&mut self, segment: u32, mut ends: [u32; 2]) -> Result<(), Lost> {
        while ends[0] != ends[1] {
            match self.insert_piece(segment, ends) {
                Ok(left) => ends = left,
                Err(Stop::Elsewhere) => {
                    self.inserted.left.push((segment, ends));
                    break;
                }
                Err(Stop::Lost) => return Err(Lost),
            }
        }
        Ok(())
    }

    /// Inserts the piece at one of the ends. Returns the ends of what is left.
    fn insert_piece(&mut self, segment: u32, mut ends: [u32; 2]) -> Result<[u32; 2], Stop> {
        let (way, end) = self.way(ends)?;
        let from = ends[end];
        ends[end] = match way {
            Way::Along(to, e) if !self.mesh.is_elsewhere(self.mesh.twin(e)) => {
                self.mesh.mark(e);
                self.inserted.pieces.push(([from.min(to), from.max(to)], segment));
                to
            }
            Way::Through(e) => self.cross(segment, e, ends[1 - end])?,
            Way::Along(..) | Way::Elsewhere => return Err(Stop::Elsewhere),
        };
        Ok(ends)
    }

    /// Finds how the segment leaves one of its ends, and which: the first, unless that has many triangles. Then it turns
    /// around both at once, so that it takes no longer than around the one with fewer.
    fn way(&self, [a, b]: [u32; 2]) -> Result<(Way, usize), Stop> {
        let mut first = Turn::new(&self.mesh, a, b);
        for _ in 0..FEW {
            if let Some(way) = first.step(&self.mesh) {
                return Ok((way, 0));
            }
        }
        let mut turns = [first, Turn::new(&self.mesh, b, a)];
        while turns[0].at != NONE || turns[1].at != NONE {
            for (end, turn) in turns.iter_mut().enumerate() {
                if let Some(way) = turn.step(&self.mesh) {
                    return Ok((way, end));
                }
            }
        }
        Err(Stop::Lost)
    }

    /// Follows a segment from the vertex where half-edge `e` starts through the triangle of `e`, up to the next vertex
    /// on it, and makes this piece an edge. Returns the vertex.
    fn cross(&mut self, segment: u32, e: u32, goal: u32) -> Result<u32, Stop> {
        let from = self.mesh.origin(e);
        let Cavity { triangles, sides: [left, right], .. } = &mut self.cavity;
        for list in [&mut *triangles, &mut *left, &mut *right] {
            list.clear();
        }
        triangles.push(e / 3);
        left.push(previous(e));
        right.push(e);
        let mut is_free = true;
        // From right to left.
        let mut crossed = next(e);
        let to = loop {
            if self.mesh.is_marked(crossed) {
                is_free = false;
                let [a, b] = [self.mesh.origin(crossed), self.mesh.target(crossed)];
                self.inserted.crossings.push(([a.min(b), a.max(b)], segment));
            }
            let beyond = self.mesh.twin(crossed);
            if self.mesh.is_elsewhere(beyond) {
                return Err(Stop::Elsewhere);
            }
            if beyond == NONE || triangles.len() == self.mesh.mesh_len() {
                return Err(Stop::Lost);
            }
            triangles.push(beyond / 3);
            let (rightwards, leftwards) = (next(beyond), previous(beyond));
            let apex = self.mesh.origin(leftwards);
            let side = if apex == goal { 0 } else { self.mesh.orient2d(from, goal, apex) };
            if side <= 0 {
                right.push(rightwards);
            }
            if side >= 0 {
                left.push(leftwards);
            }
            crossed = match side {
                0 => break apex,
                1 => rightwards,
                _ => leftwards,
            };
        };
        if is_free {
            right.reverse();
            self.rebuild(from, to)?;
            self.inserted.pieces.push(([from.min(to), from.max(to)], segment));
        }
        Ok(to)
    }

    /// Triangulates the cavity with the piece as an edge.
    fn rebuild(&mut self, from: u32, to: u32) -> Result<(), Stop> {
        // What is across is noted for both sides before any of it is overwritten.
        self.cavity.triangles.sort_unstable();
        let mut chain = std::mem::take(&mut self.cavity.chain);
        chain.clear();
        for &e in self.cavity.sides.iter().flatten() {
            let across = self.mesh.twin(e);
            if self.mesh.is_elsewhere(across) {
                return Err(Stop::Elsewhere);
            }
            let is_inside = across != NONE && self.cavity.triangles.binary_search(&(across / 3)).is_ok();
            let facing = Facing { across, is_marked: self.mesh.is_marked(e), inner: if is_inside { e } else { NONE } };
            chain.push(Link { end: self.mesh.origin(e), facing });
        }
        let (left, right) = chain.split_at(self.cavity.sides[0].len());
        let left = self.cut_ears(from, left)?;
        let right = self.cut_ears(to, right)?;
        self.cavity.chain = chain;
        self.mesh.join(left, right, true);
        self.mesh.flip_pending();
        Ok(())
    }

    /// Triangulates the polygon that goes from a vertex along a chain, on the right of it, and back to the vertex.
    /// Returns the half-edge that goes from its vertex to the last one of the chain.
    fn cut_ears(&mut self, from: u32, chain: &[Link]) -> Result<u32, Stop> {
        let mut stack = std::mem::take(&mut self.cavity.stack);
        stack.clear();
        stack.push((from, Facing::NOTHING));
        for &Link { end, mut facing } in chain {
            while let [.., (before, _), (ear, ear_facing)] = stack[..] {
                if self.mesh.orient2d(before, ear, end) >= 0 {
                    break;
                }
                let t = self.cavity.triangles.pop().ok_or(Stop::Lost)?;
                self.mesh.put(t, [before, end, ear]);
                self.connect(3 * t + 1, facing);
                self.connect(3 * t + 2, ear_facing);
                facing = Facing { across: 3 * t, ..Facing::NOTHING };
                stack.pop();
            }
            stack.push((end, facing));
        }
        let base = if let [_, (_, base)] = stack[..] { Ok(base.across) } else { Err(Stop::Lost) };
        self.cavity.stack = stack;
        base
    }

    /// Joins a new half-edge with what is across, or notes it if that is to be made yet.
    fn connect(&mut self, e: u32, facing: Facing) {
        self.mesh.doubt([e]);
        if facing.inner == NONE {
            return self.mesh.join(e, facing.across, facing.is_marked);
        }
        match self.cavity.open.remove(&facing.inner) {
            Some(other) => self.mesh.join(e, other, facing.is_marked),
            None => {
                self.cavity.open.insert(facing.across, e);
            }
        }
    }
}
