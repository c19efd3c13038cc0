//! What differs between the dimensions in the references.

use std::{fmt::Debug, ops::Range};

use gdel::internals::gpu::dim::Dim;
use gdel::internals::gpu::layout::Counters;
use gdel::internals::input::lattice::Width;
use gdel::internals::predicates::Sign;

use crate::Vertex;

/// What the references need from a dimension in addition to [`Dim`]: predicates, corners, facets
/// and flips.
pub trait ReferenceDim<const D: usize>: Dim<D> {
    /// The buffers that only this dimension has.
    type OwnState: OwnState;

    /// The Euler characteristic of the sphere of `D` dimensions: vertices − edges + triangles in
    /// 2D, vertices − edges + facets − tetrahedra in 3D. There are twice as many facets as
    /// tetrahedra, so that it is vertices − edges + simplices in both dimensions.
    const EULER_CHARACTERISTIC: usize;

    /// Returns the corners of the facet opposite corner `k`. Followed by a vertex beyond the facet,
    /// they are those of a positively oriented simplex.
    fn facet(k: usize) -> &'static [usize];

    /// Returns the orientation of these points. Never zero.
    fn orient_perturbed(width: Width, points: &[Vertex<D>], corners: Self::Corners) -> Sign;

    /// Returns on which side of the circumsphere of positively oriented points `e` is: positive if
    /// inside. Never zero.
    fn in_sphere(width: Width, points: &[Vertex<D>], own: &Self::OwnState, corners: Self::Corners, e: u32) -> Sign;

    /// Returns which child of a simplex with these corners, split at `p`, holds `q`: the one with
    /// `p` in place of that corner.
    fn child_of(corners: Self::Corners, p: u32, q: u32, orient: impl Fn(Self::Corners) -> Sign) -> usize;

    /// Returns which of the simplices that a flip made holds `p`, and the node that changed it
    /// later.
    fn descend(flip: &Self::Flip, p: u32, orient: impl Fn(Self::Corners) -> Sign) -> (u32, u32);

    /// Returns the nodes that changed the simplices of a flip later.
    fn next_nodes(flip: &mut Self::Flip) -> &mut [u32];

    /// Returns which facets of the first simplex that a flip with this outcome made lead to the others
    /// that it made, and which facets of each of them are outer ones.
    fn made_by(outcome: u32) -> (&'static [usize], Range<usize>);

    /// Counts a flip that was carried out, and frees the slot that it gave back.
    fn count_flip(own: &mut Self::OwnState, counters: &mut Counters, outcome: u32);
}

/// The buffers that only one dimension has, in host memory.
pub trait OwnState: Debug + Clone + PartialEq {
    /// Creates them for `points` points and `blocks` blocks of slots.
    fn new(points: usize, blocks: u32) -> Self;

    /// Makes them larger, for `blocks` blocks.
    fn grow(&mut self, blocks: u32);

    /// Notes that a vertex is inserted in this round, and that its first `slots` slots are used.
    fn occupy(&mut self, vertex: u32, slots: u32, round: u32);

    /// Notes that a slot is used.
    fn occupy_slot(&mut self, slot: u32);
}

/// No buffers.
impl OwnState for () {
    fn new(_points: usize, _blocks: u32) {}

    fn grow(&mut self, _blocks: u32) {}

    fn occupy(&mut self, _vertex: u32, _slots: u32, _round: u32) {}

    fn occupy_slot(&mut self, _slot: u32) {}
}
