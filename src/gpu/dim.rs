//! What differs between the dimensions in the data that device and host share.
//!
//! The frame of the GPU engine is generic over the number `D` of coordinates, as
//! [`Points`](crate::Points) and [`Lattice`](crate::input::lattice::Lattice) are. [`Dim`] supplies
//! what differs; `d2/gpu/dim.rs` and `d3/gpu/dim.rs` implement it for [`Dimension<2>`] and
//! [`Dimension<3>`].

use std::fmt::Debug;

use bytemuck::Pod;

use crate::{
    cpu::Incremental,
    dimension::Dimension,
    error::Error,
    gpu::{Binding, Gpu, Parts, shader::Shaders},
    input::lattice::Width,
    predicates::Sign,
};

/// The vertices of a simplex in `D` dimensions: `[u32; D + 1]`.
pub type Corners<const D: usize> = <Dimension<D> as Dim<D>>::Corners;

/// A flip in the history of `D` dimensions.
pub type Flip<const D: usize> = <Dimension<D> as Dim<D>>::Flip;

/// What differs between the dimensions: simplices, flips, vertices, and how many slots there are.
pub trait Dim<const D: usize>: Incremental<D> + Debug + Copy + Send + Sync + 'static {
    /// The vertices of a simplex: `[u32; D + 1]`.
    type Corners: Pod + Debug + PartialEq + Eq + Send + Sync + AsRef<[u32]> + AsMut<[u32]>;
    /// A flip in the history.
    type Flip: Pod + Debug + Default + PartialEq + Eq + Send + Sync;
    /// The buffers of Phase 1 that only this dimension has.
    type OwnBuffers: OwnBuffers;

    /// The slots of a vertex: it owns `SLOTS_PER_POINT * v` and those that follow.
    const SLOTS_PER_POINT: u32;
    /// What simplices are called in labels and messages.
    const SIMPLICES: &'static str;
    /// The words that a vertex with narrow coordinates takes on the device; one with wide
    /// coordinates takes twice as many.
    const NARROW_WORDS: usize;
    /// The shaders of the kernels.
    const SHADERS: &'static Shaders;
    /// The largest number of points: simplices are numbered in 30 bits.
    const MAX_POINTS: usize;
    /// The default of [`MemorySettings::history`](crate::gpu::phase1::MemorySettings::history).
    const HISTORY: u32;
    /// The simplices of a mesh per point: more than most meshes have.
    const MESH_PER_POINT: usize;
    /// The flip iterations that are recorded for a round of which nothing is known: enough for most
    /// inputs in rounds that insert several times as many points as the one before.
    const FIRST_ITERATIONS: u32;

    /// Returns the blocks, of [`BLOCK`](crate::gpu::layout::BLOCK) slots each, for `points` points.
    /// `tail` of them belong to no vertex; 2D needs none and ignores it.
    fn blocks(points: u32, tail: u32) -> u32;

    /// Returns the words that a vertex takes on the device.
    fn vertex_words(width: Width) -> usize {
        match width {
            Width::Narrow => Self::NARROW_WORDS,
            Width::Wide => 2 * Self::NARROW_WORDS,
        }
    }

    /// Returns how many of `count` points the CPU engine triangulates while the device orders all of
    /// them. With more, it would take longer than the rounds that this saves. At least `D + 1`.
    fn start_points(count: usize) -> usize;

    /// Appends the words of a vertex at `position`, which the lattice has `rounded` or not. 3D
    /// stores the input index with it; 2D stores it elsewhere and ignores it here.
    fn append_vertex(words: &mut Vec<i32>, width: Width, position: [i64; D], index: u32, rounded: bool);

    /// Returns the orientation of the corners of a simplex, without perturbation.
    ///
    /// # Panics
    ///
    /// Panics if there are not `D + 1` corners.
    fn orient(width: Width, corners: &[[i64; D]]) -> Sign;

    /// Returns how good `p` is as the next corner of a large simplex that has the corners `chosen`:
    /// the larger, the better.
    fn spread(chosen: &[[f64; D]], p: [f64; D]) -> f64;
}

/// Returns the high and the low word, of 31 bits each, of a wide lattice coordinate.
pub fn words_of(coordinate: i64) -> [i32; 2] {
    [(coordinate >> 31) as i32, (coordinate & 0x7fff_ffff) as i32]
}

/// The buffers of Phase 1 that only one dimension has.
pub trait OwnBuffers: Debug + Clone {
    /// Creates them for `points` points and `blocks` blocks of slots.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`].
    fn new(gpu: &Gpu, points: usize, blocks: u32, parts: Option<Parts>) -> Result<Self, Error>;

    /// Returns larger ones with the same contents, for `blocks` blocks.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`].
    fn with_blocks(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        blocks: u32,
        parts: Option<Parts>,
    ) -> Result<Self, Error>;

    /// Records that buffers are cleared that a run expects to be zero.
    fn record_clear(&self, encoder: &mut wgpu::CommandEncoder);

    /// Returns the buffers under the names that they have in shaders.
    fn bindings(&self) -> Vec<Binding<'_>>;

    /// Returns the bytes that they take on the device.
    fn bytes(&self) -> u64;
}

/// No buffers.
impl OwnBuffers for () {
    fn new(_gpu: &Gpu, _points: usize, _blocks: u32, _parts: Option<Parts>) -> Result<Self, Error> {
        Ok(())
    }

    fn with_blocks(
        &self,
        _gpu: &Gpu,
        _encoder: &mut wgpu::CommandEncoder,
        _blocks: u32,
        _parts: Option<Parts>,
    ) -> Result<Self, Error> {
        Ok(())
    }

    fn record_clear(&self, _encoder: &mut wgpu::CommandEncoder) {}

    fn bindings(&self) -> Vec<Binding<'_>> {
        Vec::new()
    }

    fn bytes(&self) -> u64 {
        0
    }
}
