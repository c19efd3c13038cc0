//! The buffers of Phase 1, in host memory.

use crate::gpu::layout::{Active, BLOCK, Counters, FlipNode, HELD_SHIFT, NONE, Params, Status, Waiting};
use crate::input::lattice::Width;
use crate::predicates::Sign;

use crate::reference::d3::predicates::{self, Vertex};

/// All buffers of Phase 1.
#[derive(Debug, Clone)]
pub struct State {
    /// The width of the lattice.
    pub width: Width,
    /// What the kernels are told.
    pub params: Params,
    /// PredicateContext, and the kernel point.
    pub points: Vec<Vertex>,
    /// The first tetrahedron.
    pub first: [u32; 4],
    /// Whether another vertex stands for each, because it lies at the same place.
    pub merged: Vec<bool>,
    /// The vertices of each slot; all zero in a free one.
    pub tets: Vec<[u32; 4]>,
    /// The neighbours of each slot.
    pub neighbors: Vec<[u32; 4]>,
    /// The status of each slot.
    pub status: Vec<Status>,
    /// The free slots of each block.
    pub free: Vec<u32>,
    /// For each slot whose tetrahedron changed in this flip iteration, where its outer facets went; while points are
    /// picked, the best score (entry 0) and the point that has it, plus 1 (entry 1).
    pub messages: Vec<[u32; 4]>,
    /// The active list, in two halves of one entry a slot.
    pub active: [Vec<Active>; 2],
    /// The flips of this round.
    pub history: Vec<FlipNode>,
    /// The points that are not inserted yet, along the Hilbert curve.
    pub waiting: Vec<Waiting>,
    /// The scores of the waiting points, in the order of that list.
    pub scores: Vec<u32>,
    /// Whether each vertex has a facet that is not locally Delaunay.
    pub failed: Vec<u32>,
    /// Counters.
    pub counters: Counters,
}

impl State {
    /// Buffers for `points`, the last of which is the kernel point, with nothing in them.
    pub fn new(width: Width, points: Vec<Vertex>, tail_blocks: u32, history: u32) -> Self {
        let infinite = points.len() as u32 - 1;
        let blocks = infinite + 1 + tail_blocks;
        let slots = (blocks * BLOCK) as usize;
        State {
            width,
            params: Params {
                infinite,
                blocks,
                history,
                entries: infinite,
                bid_bits: 33 - (slots as u32).leading_zeros(),
                compact_from: u32::MAX,
                ..Params::default()
            },
            first: [0; 4],
            merged: vec![false; infinite as usize],
            tets: vec![[0; 4]; slots],
            neighbors: vec![[NONE; 4]; slots],
            status: vec![Status::default(); slots],
            free: vec![0xff; blocks as usize],
            messages: vec![[0; 4]; slots],
            active: [vec![Active::default(); slots], vec![Active::default(); slots]],
            history: vec![FlipNode::default(); history as usize],
            waiting: vec![Waiting { point: NONE, tet: NONE }; infinite as usize],
            scores: vec![0; infinite as usize],
            failed: vec![0; infinite as usize],
            counters: Counters { first_node: 1, next_node: 1, ..Counters::default() },
            points,
        }
    }

    /// The orientation of four vertices, one of which may be at infinity. Never zero.
    pub fn orient(&self, vertices: [u32; 4]) -> Sign {
        let sign = predicates::orient3d(self.width, vertices.map(|v| self.points[v as usize]));
        if vertices.contains(&self.params.infinite) { -sign } else { sign }
    }

    /// Whether `e` is inside the circumsphere of a positively oriented tetrahedron. For an infinite tetrahedron that is
    /// the half-space beyond its hull facet.
    pub fn inside(&self, tet: [u32; 4], e: u32) -> bool {
        let infinite = self.params.infinite;
        if e == infinite {
            return false;
        }
        match tet.iter().position(|&v| v == infinite) {
            Some(k) => self.orient(replaced(tet, k, e)) > 0,
            None => {
                let [a, b, c, d] = tet;
                predicates::insphere(self.width, [a, b, c, d, e].map(|v| self.points[v as usize])) > 0
            }
        }
    }

    /// Whether a slot holds a tetrahedron.
    pub fn is_used(&self, t: usize) -> bool {
        self.tets[t] != [0; 4]
    }

    /// Whether waiting points may lie in a tetrahedron.
    pub fn is_held(&self, t: u32) -> bool {
        self.status[t as usize].flags >> HELD_SHIFT == self.counters.round
    }

    /// The half of the active list that this flip iteration reads.
    pub fn half(&self) -> usize {
        (self.counters.iteration & 1) as usize
    }

    /// Whether a flip iteration does nothing, for want of active tetrahedra.
    pub fn is_idle(&self, iteration: u32) -> bool {
        self.counters.active_len[(iteration & 1) as usize] < self.params.min_active.max(1)
    }

    /// The number that entry `i` of the active list bids in this flip iteration.
    pub fn bid(&self, i: usize) -> u32 {
        let bits = self.params.bid_bits;
        let it = self.counters.iteration;
        (it + 1) << bits | scramble(i as u32, it, bits - 1)
    }

    /// The vote that marks a tetrahedron as changed in flip iteration `iteration`: above every bid of it.
    pub fn changed_mark(&self, iteration: u32) -> u32 {
        let bits = self.params.bid_bits;
        (iteration + 1) << bits | ((1 << bits) - 1)
    }
}

/// A permutation of the numbers of `bits` bits that changes from iteration to iteration, so that the same proposals do
/// not lose again and again.
pub fn scramble(number: u32, iteration: u32, bits: u32) -> u32 {
    let mask = (1 << bits) - 1;
    let half = bits / 2;
    let mut x = number ^ (iteration.wrapping_mul(0x9e37_79b9) & mask);
    x = x.wrapping_mul(0x85eb_ca6b) & mask;
    x ^= x >> half;
    x = x.wrapping_mul(0xc2b2_ae35) & mask;
    x ^ x >> half
}

/// The same four with entry `k` replaced.
pub fn replaced(mut four: [u32; 4], k: usize, v: u32) -> [u32; 4] {
    four[k] = v;
    four
}
