//! The 3D implementations of the traits of the references.

use std::ops::Range;

use gdel::internals::d3::mesh::FACETS;
use gdel::internals::dimension::Dimension;
use gdel::internals::gpu::layout::{
    ALL_FREE, BLOCK, Counters, DONE, DONE_23, FLIP_23, FlipNode, ROUND_SHIFT, SLOT_SHIFT,
};
use gdel::internals::input::lattice::Width;
use gdel::internals::predicates::Sign;

use crate::State;
use crate::d3::predicates::{self, Vertex};
use crate::d3::{flip_check, flip_commit, mark_failed, pick};
use crate::dim::{self, ReferenceDim};
use crate::kernels::Kernels;
use crate::state::replaced;

impl ReferenceDim<3> for Dimension<3> {
    type OwnState = OwnState;

    const EULER_CHARACTERISTIC: usize = 0;

    fn facet(k: usize) -> &'static [usize] {
        &FACETS[k]
    }

    fn orient_perturbed(width: Width, points: &[Vertex], corners: [u32; 4]) -> Sign {
        predicates::orient3d(width, corners.map(|v| points[v as usize]), points[points.len() - 1])
    }

    fn in_sphere(width: Width, points: &[Vertex], own: &OwnState, [a, b, c, d]: [u32; 4], e: u32) -> Sign {
        let five = [a, b, c, d, e];
        let rounds = five.map(|v| own.free[v as usize] >> ROUND_SHIFT);
        predicates::insphere(width, five.map(|v| points[v as usize]), rounds, points[points.len() - 1])
    }

    /// Takes 3 orientations: the plane of p, v₀, v₁ and that of p, v₂, v₃ leave two children whose
    /// directions from p meet; a third plane divides them.
    fn child_of(corners: [u32; 4], p: u32, q: u32, orient: impl Fn([u32; 4]) -> Sign) -> usize {
        let on_side_of = |i: usize, j: usize| orient(replaced(replaced(corners, i, q), j, p)) > 0;
        let a = if on_side_of(3, 2) { 3 } else { 2 };
        let b = if on_side_of(0, 1) { 0 } else { 1 };
        if on_side_of(1 - b, 5 - a) { 5 - a } else { 1 - b }
    }

    /// Takes one or two orientations.
    fn descend(flip: &FlipNode, p: u32, orient: impl Fn([u32; 4]) -> Sign) -> (u32, u32) {
        let FlipNode { ring: [x0, x1, x2], d, e, .. } = *flip;
        let beyond = |x: u32| orient([x, p, d, e]) > 0;
        let k = if flip.kind == FLIP_23 {
            match beyond(x0) {
                true if beyond(x1) => 1,
                true => 0,
                false if beyond(x2) => 2,
                false => 1,
            }
        } else if orient([x0, x1, x2, p]) > 0 {
            0
        } else {
            1
        };
        (flip.tets[k], flip.next[k])
    }

    fn next_nodes(flip: &mut FlipNode) -> &mut [u32] {
        &mut flip.next
    }

    fn made_by(outcome: u32) -> (&'static [usize], Range<usize>) {
        if outcome & DONE_23 != 0 { (&[0, 1], 2..4) } else { (&[3], 0..3) }
    }

    fn count_flip(own: &mut OwnState, counters: &mut Counters, outcome: u32) {
        if outcome & DONE_23 != 0 {
            counters.flips_23 += 1;
        } else {
            let slot = (outcome & !DONE) >> SLOT_SHIFT;
            own.free[(slot / BLOCK) as usize] |= 1 << (slot % BLOCK);
            counters.flips_32 += 1;
        }
    }
}

impl Kernels<3> for Dimension<3> {
    fn score(state: &State<3>, t: u32, p: u32) -> u32 {
        pick::score(state, t, p)
    }

    fn proposal(state: &State<3>, t: u32) -> (u32, Vec<u32>) {
        flip_check::proposal(state, t)
    }

    fn commit(state: &mut State<3>, i: usize) {
        flip_commit::commit(state, i);
    }

    /// Marks the failed vertices.
    fn finish(state: &mut State<3>) {
        mark_failed(state);
    }

    /// Panics unless exactly the unused slots are free.
    fn validate_own(state: &State<3>) {
        for (t, tet) in (0..).zip(&state.simplices) {
            let free = state.own.free[(t / BLOCK) as usize] >> (t % BLOCK) & 1 != 0;
            assert_eq!(free, *tet == [0; 4], "slot {t} is both free and used, or neither");
        }
    }
}

/// The buffers that only 3D has, in host memory.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnState {
    /// The free slots of each block, and the round in which its vertex was inserted.
    pub free: Vec<u32>,
    /// Whether each vertex has a facet that is not locally Delaunay.
    pub failed: Vec<u32>,
}

impl dim::OwnState for OwnState {
    fn new(points: usize, blocks: u32) -> Self {
        OwnState { free: vec![ALL_FREE; blocks as usize], failed: vec![0; points] }
    }

    fn grow(&mut self, blocks: u32) {
        self.free.resize(blocks as usize, ALL_FREE);
    }

    fn occupy(&mut self, vertex: u32, slots: u32, round: u32) {
        self.free[vertex as usize] = round << ROUND_SHIFT | ALL_FREE & !((1 << slots) - 1);
    }

    fn occupy_slot(&mut self, slot: u32) {
        self.free[(slot / BLOCK) as usize] &= !(1 << (slot % BLOCK));
    }
}
