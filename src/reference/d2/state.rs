//! The buffers of the plane, in host memory.

use crate::d2::gpu::layout::{EdgeFlip, blocks};
use crate::gpu::layout::{Active, BLOCK, Counters, HELD_SHIFT, NONE, Params, Status, Waiting};
use crate::input::lattice::Width;
use crate::predicates::Sign;
use crate::reference::d3::scramble;

use crate::reference::d2::predicates::{self, Vertex};

/// All buffers.
#[derive(Debug, Clone)]
pub struct State {
    /// The width of the lattice.
    pub width: Width,
    /// What the kernels are told.
    pub params: Params,
    /// PredicateContext, and the kernel point.
    pub points: Vec<Vertex>,
    /// The first triangle.
    pub first: [u32; 3],
    /// Whether another vertex stands for each, because it lies at the same place.
    pub merged: Vec<bool>,
    /// The vertices of each slot, and 0; all zero in an unused one.
    pub triangles: Vec<[u32; 4]>,
    /// The neighbours of each slot, and 0.
    pub neighbors: Vec<[u32; 4]>,
    /// The status of each slot.
    pub status: Vec<Status>,
    /// For each slot whose triangle changed in this flip iteration, where its outer edges went; while points are picked,
    /// the best score (entry 0) and the point that has it, plus 1 (entry 1).
    pub messages: Vec<[u32; 4]>,
    /// The active list, in two halves of one entry a slot.
    pub active: [Vec<Active>; 2],
    /// The flips of this round.
    pub history: Vec<EdgeFlip>,
    /// The points that are not inserted yet, along the Hilbert curve.
    pub waiting: Vec<Waiting>,
    /// The scores of the waiting points, in the order of that list.
    pub scores: Vec<u32>,
    /// Counters.
    pub counters: Counters,
}

impl State {
    /// Buffers for `points`, the last of which is the kernel point, with nothing in them.
    pub fn new(width: Width, points: Vec<Vertex>, history: u32) -> Self {
        let infinite = points.len() as u32 - 1;
        let blocks = blocks(infinite);
        let slots = (blocks * BLOCK) as usize;
        State {
            width,
            params: Params {
                infinite,
                blocks,
                history,
                entries: infinite,
                bid_bits: 33 - (slots as u32).leading_zeros(),
                ..Params::default()
            },
            first: [0; 3],
            merged: vec![false; infinite as usize],
            triangles: vec![[0; 4]; slots],
            neighbors: vec![[0; 4]; slots],
            status: vec![Status::default(); slots],
            messages: vec![[0; 4]; slots],
            active: [vec![Active::default(); slots], vec![Active::default(); slots]],
            history: vec![EdgeFlip::default(); history as usize],
            waiting: vec![Waiting { point: NONE, tet: NONE }; infinite as usize],
            scores: vec![0; infinite as usize],
            counters: Counters { first_node: 1, next_node: 1, ..Counters::default() },
            points,
        }
    }

    /// The vertices of a triangle.
    pub fn triangle(&self, t: u32) -> [u32; 3] {
        let [a, b, c, _] = self.triangles[t as usize];
        [a, b, c]
    }

    /// The triangle across edge `k` of a triangle, and the edge as that one numbers it.
    pub fn across(&self, t: u32, k: usize) -> (u32, usize) {
        let across = self.neighbors[t as usize][k];
        (across >> 2, across as usize & 3)
    }

    /// The orientation of three finite vertices; the number of infinity stands for the kernel point. Never zero.
    pub fn orient_finite(&self, vertices: [u32; 3]) -> Sign {
        predicates::orient2d(vertices.map(|v| self.points[v as usize]))
    }

    /// The orientation of three vertices, one of which may be at infinity. Never zero.
    pub fn orient(&self, vertices: [u32; 3]) -> Sign {
        let sign = self.orient_finite(vertices);
        if vertices.contains(&self.params.infinite) { -sign } else { sign }
    }

    /// Whether `e` is inside the circumcircle of a positively oriented triangle. For an infinite triangle that is the
    /// half-plane beyond its hull edge.
    pub fn inside(&self, triangle: [u32; 3], e: u32) -> bool {
        let infinite = self.params.infinite;
        if e == infinite {
            return false;
        }
        match triangle.iter().position(|&v| v == infinite) {
            Some(k) => self.orient(replaced(triangle, k, e)) > 0,
            None => {
                let [a, b, c] = triangle;
                predicates::incircle([a, b, c, e].map(|v| self.points[v as usize])) > 0
            }
        }
    }

    /// Whether a slot holds a triangle.
    pub fn is_used(&self, t: usize) -> bool {
        self.triangles[t] != [0; 4]
    }

    /// Whether waiting points may lie in a triangle.
    pub fn is_held(&self, t: u32) -> bool {
        self.status[t as usize].flags >> HELD_SHIFT == self.counters.round
    }

    /// The half of the active list that this flip iteration reads.
    pub fn half(&self) -> usize {
        (self.counters.iteration & 1) as usize
    }

    /// Whether a flip iteration does nothing, for want of active triangles.
    pub fn is_idle(&self, iteration: u32) -> bool {
        self.counters.active_len[(iteration & 1) as usize] < self.params.min_active.max(1)
    }

    /// The number that entry `i` of the active list bids in this flip iteration.
    pub fn bid(&self, i: usize) -> u32 {
        let bits = self.params.bid_bits;
        let it = self.counters.iteration;
        (it + 1) << bits | scramble(i as u32, it, bits - 1)
    }

    /// The vote that marks a triangle as changed in flip iteration `iteration`: above every bid of it.
    pub fn changed_mark(&self, iteration: u32) -> u32 {
        let bits = self.params.bid_bits;
        (iteration + 1) << bits | ((1 << bits) - 1)
    }
}

/// The same three with entry `k` replaced.
pub fn replaced(mut three: [u32; 3], k: usize, v: u32) -> [u32; 3] {
    three[k] = v;
    three
}

/// The words of a slot.
pub fn words([a, b, c]: [u32; 3]) -> [u32; 4] {
    [a, b, c, 0]
}
