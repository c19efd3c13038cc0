//! The buffers of Phase 1 that only 2D has.

use crate::{
    Error,
    gpu::{Binding, Gpu, Storage, dim, layout::BLOCK},
};

/// The buffers of Phase 1 that only 2D has.
#[derive(Debug, Clone)]
pub struct OwnBuffers {
    /// Whether each slot has a triangle of the mesh.
    pub marks: Storage<u32>,
    /// The number of each slot's triangle in the mesh.
    pub offsets: Storage<u32>,
}

impl dim::OwnBuffers for OwnBuffers {
    fn new(gpu: &Gpu, _points: usize, blocks: u32) -> Result<Self, Error> {
        let slots = (blocks * BLOCK) as usize;
        Ok(OwnBuffers { marks: Storage::new(gpu, "marks", slots)?, offsets: Storage::new(gpu, "offsets", slots)? })
    }

    fn with_blocks(&self, gpu: &Gpu, _encoder: &mut wgpu::CommandEncoder, blocks: u32) -> Result<Self, Error> {
        // Both are written before they are read, in the end.
        dim::OwnBuffers::new(gpu, 0, blocks)
    }

    /// Records nothing: both are written before they are read.
    fn record_clear(&self, _encoder: &mut wgpu::CommandEncoder) {}

    fn bindings(&self) -> Vec<Binding<'_>> {
        vec![("marks", self.marks.buffer()), ("offsets", self.offsets.buffer())]
    }

    fn bytes(&self) -> u64 {
        self.marks.bytes() + self.offsets.bytes()
    }
}
