//! The contents of the buffers of 2D. [`gpu::layout`](crate::gpu::layout) describes them for
//! tetrahedra; these are the differences for triangles. `shaders/d2/simplex.wgsl` has the counterparts.
//!
//! **Triangles** live in slots of four words, of which the last is 0. Slots 2v and 2v + 1 are the
//! two that the insertion of vertex *v* adds; the triangles of the start fill those of its vertices.
//! No flip changes the number of triangles, so there is no list of free slots. Kernels that both
//! dimensions share count slots in blocks of eight; the number of slots is rounded up, and the last one
//! is never used.
//!
//! **Neighbours** are packed as 4·triangle + edge: entry *k* of a triangle is the edge opposite its
//! vertex *k*, as the triangle on the other side numbers it.

use bytemuck::{Pod, Zeroable};

use crate::gpu::{
    layout::BLOCK,
    shader::{assert_layout, constants::d2},
};

/// Slots of a vertex.
pub const SLOTS_PER_POINT: u32 = d2::SLOTS_PER_POINT;

/// The kind of a flip of two triangles into two.
pub const FLIP_22: u32 = d2::FLIP_22;

/// Returns the blocks of eight slots for `points` points.
pub fn blocks(points: u32) -> u32 {
    (SLOTS_PER_POINT * points + 1).div_ceil(BLOCK)
}

/// A flip in the history.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct EdgeFlip {
    /// The edge that it made: the first of the two triangles lies on the left.
    pub edge: [u32; 2],
    /// The triangles that it made.
    pub triangles: [u32; 2],
    /// The nodes that changed these later, or [`NONE`](crate::NONE).
    pub next: [u32; 2],
}
assert_layout!(EdgeFlip);

/// A sign that the lattice does not prove of the true coordinates, because some were rounded; by
/// input indices, where the number of points is the vertex at infinity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct UncertainTest {
    /// A triangle p, a, b.
    pub triangle: [u32; 3],
    /// The vertex opposite the edge a b in the triangle across: it must not be in conflict with
    /// this one. If infinity is among the triangle's vertices, it must not lie beyond the line of
    /// the others. Or [`COUNTER_CLOCKWISE`] or [`FLAT`].
    pub beyond: u32,
}
assert_layout!(UncertainTest);

/// In the place of [`UncertainTest::beyond`]: the triangle must be counter-clockwise.
pub const COUNTER_CLOCKWISE: u32 = d2::COUNTER_CLOCKWISE;
/// In the place of [`UncertainTest::beyond`]: the triangle, which the answer leaves out, must be
/// flat.
pub const FLAT: u32 = d2::FLAT;
