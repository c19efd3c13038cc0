//! The 2D implementations of the traits of the references.

use std::ops::Range;

use gdel::internals::d2::gpu::layout::EdgeFlip;
use gdel::internals::dimension::Dimension;
use gdel::internals::gpu::layout::Counters;
use gdel::internals::input::lattice::Width;
use gdel::internals::predicates::Sign;

use crate::State;
use crate::d2::predicates::{self, Vertex};
use crate::d2::{flip_check, flip_commit, pick};
use crate::dim::ReferenceDim;
use crate::kernels::Kernels;

impl ReferenceDim<2> for Dimension<2> {
    type OwnState = ();

    const EULER_CHARACTERISTIC: usize = 2;

    fn facet(k: usize) -> &'static [usize] {
        const EDGES: [[usize; 2]; 3] = [[2, 1], [0, 2], [1, 0]];
        &EDGES[k]
    }

    fn orient_perturbed(_width: Width, points: &[Vertex], corners: [u32; 3]) -> Sign {
        predicates::orient2d(corners.map(|v| points[v as usize]), points[points.len() - 1])
    }

    fn in_sphere(_width: Width, points: &[Vertex], _own: &(), [a, b, c]: [u32; 3], e: u32) -> Sign {
        predicates::incircle([a, b, c, e].map(|v| points[v as usize]))
    }

    /// Takes 2 orientations: the rays from p to the corners divide the triangle. The line of the
    /// first ray leaves two children on a side, and the ray between those decides.
    fn child_of(corners: [u32; 3], p: u32, q: u32, orient: impl Fn([u32; 3]) -> Sign) -> usize {
        let left_of = |ray: usize| orient([p, corners[ray], q]) > 0;
        match left_of(0) {
            true if left_of(1) => 0,
            true => 2,
            false if left_of(2) => 1,
            false => 0,
        }
    }

    /// Takes one orientation.
    fn descend(flip: &EdgeFlip, p: u32, orient: impl Fn([u32; 3]) -> Sign) -> (u32, u32) {
        let [a, b] = flip.edge;
        let k = if orient([a, b, p]) > 0 { 0 } else { 1 };
        (flip.triangles[k], flip.next[k])
    }

    fn next_nodes(flip: &mut EdgeFlip) -> &mut [u32] {
        &mut flip.next
    }

    fn made_by(_outcome: u32) -> (&'static [usize], Range<usize>) {
        (&[0], 1..3)
    }

    fn count_flip(_own: &mut (), counters: &mut Counters, _outcome: u32) {
        counters.flips_22 += 1;
    }
}

impl Kernels<2> for Dimension<2> {
    fn score(state: &State<2>, t: u32, p: u32) -> u32 {
        pick::score(state, t, p)
    }

    fn proposal(state: &State<2>, t: u32) -> (u32, Vec<u32>) {
        flip_check::proposal(state, t)
    }

    fn commit(state: &mut State<2>, i: usize) {
        flip_commit::commit(state, i);
    }

    fn finish(_state: &mut State<2>) {}

    fn validate_own(_state: &State<2>) {}
}
