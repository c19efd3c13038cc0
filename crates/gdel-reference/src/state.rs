//! The buffers of Phase 1, in host memory.

use bytemuck::Zeroable;

use gdel::internals::dimension::Dimension;
use gdel::internals::gpu::dim::{Corners, Dim, Flip};
use gdel::internals::gpu::start::StartMesh;
use gdel::internals::input::lattice::Width;
use gdel::internals::predicates::Sign;
use gdel::{
    NONE,
    internals::gpu::layout::{Active, BLOCK, Counters, HELD_SHIFT, Params, Status, Waiting},
};

use crate::Vertex;
use crate::dim::{OwnState, ReferenceDim};

/// All buffers of Phase 1.
#[derive(Debug, Clone)]
pub struct State<const D: usize>
where
    Dimension<D>: ReferenceDim<D>,
{
    /// The width of the lattice.
    pub width: Width,
    /// The parameters of the kernels.
    pub params: Params,
    /// The vertices, and the interior point.
    pub points: Vec<Vertex<D>>,
    /// The simplices of the start.
    pub start: StartMesh,
    /// The vertices of the start's points.
    pub start_vertices: Vec<u32>,
    /// Whether another vertex stands for each, because it lies at the same place.
    pub merged: Vec<bool>,
    /// The vertices of each slot, in 2D followed by 0; all zero in an unused one.
    pub simplices: Vec<[u32; 4]>,
    /// The neighbours of each slot, in 2D followed by 0.
    pub neighbors: Vec<[u32; 4]>,
    /// The status of each slot.
    pub status: Vec<Status>,
    /// For each slot whose simplex changed in this flip iteration, where its outer facets went;
    /// while points are picked, the best score (entry 0) and the point that has it, plus 1 (entry
    /// 1).
    pub messages: Vec<[u32; 4]>,
    /// The active list, in two halves of one entry per slot.
    pub active: [Vec<Active>; 2],
    /// The flips of this round.
    pub history: Vec<Flip<D>>,
    /// The points that are not inserted yet, along the Hilbert curve.
    pub waiting: Vec<Waiting>,
    /// The scores of the waiting points, in the order of that list.
    pub scores: Vec<u32>,
    /// Counters.
    pub counters: Counters,
    /// The buffers that only this dimension has.
    pub own: <Dimension<D> as ReferenceDim<D>>::OwnState,
}

impl<const D: usize> State<D>
where
    Dimension<D>: ReferenceDim<D>,
{
    /// Creates empty buffers for `points`, the last of which is the interior point. `tail` blocks
    /// of slots belong to no vertex (2D ignores it), and the history can hold `history` nodes.
    pub fn new(width: Width, points: Vec<Vertex<D>>, tail: u32, history: u32) -> Self {
        let infinite = points.len() as u32 - 1;
        let blocks = Dimension::<D>::blocks(infinite, tail);
        let slots = (blocks * BLOCK) as usize;
        State {
            width,
            params: Params { infinite, blocks, history, ..Params::default() },
            start: StartMesh { points: Vec::new(), simplices: Vec::new() },
            start_vertices: Vec::new(),
            merged: vec![false; infinite as usize],
            simplices: vec![[0; 4]; slots],
            neighbors: vec![[NONE; 4]; slots],
            status: vec![Status::default(); slots],
            messages: vec![[0; 4]; slots],
            active: [vec![Active::default(); slots], vec![Active::default(); slots]],
            history: vec![Flip::<D>::default(); history as usize],
            waiting: vec![Waiting { point: NONE, tet: NONE }; infinite as usize],
            scores: vec![0; infinite as usize],
            counters: Counters { bid_base: 1, entries: infinite, ..Counters::default() },
            own: OwnState::new(infinite as usize, blocks),
            points,
        }
    }

    /// Makes room for `blocks` blocks of slots.
    pub fn grow(&mut self, blocks: u32) {
        let slots = (blocks * BLOCK) as usize;
        self.params.blocks = blocks;
        self.simplices.resize(slots, [0; 4]);
        self.neighbors.resize(slots, [NONE; 4]);
        self.status.resize(slots, Status::default());
        self.messages.resize(slots, [0; 4]);
        self.active.iter_mut().for_each(|half| half.resize(slots, Active::default()));
        self.own.grow(blocks);
    }

    /// Sets the start, and its vertices.
    pub fn set_start(&mut self, start: StartMesh, vertices: Vec<u32>) {
        self.params.start_points = start.points.len() as u32;
        self.params.start_simplices = start.simplices.len() as u32;
        self.params.start_stride = start.stride(self.params.infinite);
        (self.start, self.start_vertices) = (start, vertices);
    }

    /// Returns the slot of simplex `i` of the start.
    pub fn start_slot(&self, i: u32) -> u32 {
        let points = self.params.start_points;
        Dimension::<D>::SLOTS_PER_POINT * self.start_vertices[(i % points) as usize] + i / points
    }

    /// Returns the vertices of a simplex.
    pub fn corners(&self, t: u32) -> Corners<D> {
        let mut corners = Corners::<D>::zeroed();
        corners.as_mut().copy_from_slice(&self.simplices[t as usize][..=D]);
        corners
    }

    /// Returns the simplex across facet `k` of a simplex, and the facet as that one numbers it.
    pub fn across(&self, t: u32, k: usize) -> (u32, usize) {
        let across = self.neighbors[t as usize][k];
        (across >> 2, across as usize & 3)
    }

    /// Returns the orientation of finite vertices; the number of infinity stands for the interior
    /// point. Never zero.
    pub fn orient_finite(&self, corners: Corners<D>) -> Sign {
        Dimension::<D>::orient_perturbed(self.width, &self.points, corners)
    }

    /// Returns the orientation of vertices, one of which may be at infinity. Never zero.
    pub fn orient(&self, corners: Corners<D>) -> Sign {
        let sign = self.orient_finite(corners);
        if corners.as_ref().contains(&self.params.infinite) { -sign } else { sign }
    }

    /// Returns whether `e` is inside the circumsphere of a positively oriented simplex. For an
    /// infinite simplex that is the half-space beyond its hull facet.
    pub fn inside(&self, corners: Corners<D>, e: u32) -> bool {
        let infinite = self.params.infinite;
        if e == infinite {
            return false;
        }
        match corners.as_ref().iter().position(|&v| v == infinite) {
            Some(k) => self.orient(replaced(corners, k, e)) > 0,
            None => Dimension::<D>::in_sphere(self.width, &self.points, &self.own, corners, e) > 0,
        }
    }

    /// Returns whether a slot holds a simplex.
    pub fn is_used(&self, t: usize) -> bool {
        self.simplices[t] != [0; 4]
    }

    /// Returns whether waiting points may lie in a simplex.
    pub fn is_held(&self, t: u32) -> bool {
        self.status[t as usize].flags >> HELD_SHIFT == self.counters.round
    }

    /// Returns the half of the active list that this flip iteration reads.
    pub fn half(&self) -> usize {
        (self.counters.iteration & 1) as usize
    }

    /// Returns whether a flip iteration does nothing, for want of active simplices.
    pub fn is_idle(&self, iteration: u32) -> bool {
        self.counters.active_len[(iteration & 1) as usize] < self.counters.min_active.max(1)
    }

    /// Lists a simplex in this half of the active list.
    pub(super) fn append(&mut self, half: usize, tet: u32) {
        let at = &mut self.counters.active_len[half];
        self.active[half][*at as usize] = Active { tet, outcome: 0 };
        *at += 1;
    }

    /// Returns the bids of this flip iteration, as checking and committing see it.
    pub fn bids(&self) -> Bids {
        self.bids_of(self.counters.iteration, self.counters.bid_base)
    }

    /// Returns the bids of this flip iteration, as linking sees it.
    pub fn link_bids(&self) -> Bids {
        self.bids_of(self.counters.link_iteration, self.counters.link_bid_base)
    }

    fn bids_of(&self, iteration: u32, base: u32) -> Bids {
        let entries = self.counters.active_len[(iteration & 1) as usize];
        Bids { iteration, base, bits: (32 - entries.leading_zeros()).max(2) }
    }
}

/// The bids of a flip iteration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bids {
    /// The iteration, which decides on the order of the bids.
    pub iteration: u32,
    /// The lowest bid: above all votes of earlier iterations.
    pub base: u32,
    /// The bits of a bidder's number.
    pub bits: u32,
}

impl Bids {
    /// Returns the number that entry `i` of the active list bids.
    pub fn bid(&self, i: usize) -> u32 {
        self.base + scramble(i as u32, self.iteration, self.bits)
    }

    /// Returns the vote that marks a simplex as changed: above every bid.
    pub fn changed_mark(&self) -> u32 {
        self.base + (1 << self.bits)
    }

    /// Returns the lowest bid of the next iteration.
    pub fn next_base(&self) -> u32 {
        self.changed_mark() + 1
    }
}

/// Permutes the numbers of `bits` bits, differently in each iteration, so that the same proposals
/// do not lose again and again.
pub(super) fn scramble(number: u32, iteration: u32, bits: u32) -> u32 {
    let mask = (1 << bits) - 1;
    let half = bits / 2;
    let mut x = number ^ (iteration.wrapping_mul(0x9e37_79b9) & mask);
    x = x.wrapping_mul(0x85eb_ca6b) & mask;
    x ^= x >> half;
    x = x.wrapping_mul(0xc2b2_ae35) & mask;
    x ^ x >> half
}

/// Returns the same corners with entry `k` replaced.
pub(super) fn replaced<C: AsMut<[u32]>>(mut corners: C, k: usize, v: u32) -> C {
    corners.as_mut()[k] = v;
    corners
}

/// Returns the words of a slot: in 2D the last one is 0.
pub(super) fn slot(words: impl AsRef<[u32]>) -> [u32; 4] {
    let words = words.as_ref();
    std::array::from_fn(|k| words.get(k).copied().unwrap_or(0))
}
