//! The buffers of Phase 1 that only 3D has.

use crate::{
    Error,
    gpu::{Binding, Gpu, Storage, dim},
};

/// The buffers of Phase 1 that only 3D has.
#[derive(Debug, Clone)]
pub struct OwnBuffers {
    /// The free slots of each block.
    pub free: Storage<u32>,
    /// Whether each vertex failed.
    pub failed: Storage<u32>,
}

impl dim::OwnBuffers for OwnBuffers {
    fn new(gpu: &Gpu, points: usize, blocks: u32) -> Result<Self, Error> {
        Ok(OwnBuffers {
            free: Storage::new(gpu, "free slots", blocks as usize)?,
            failed: Storage::new(gpu, "failed vertices", points)?,
        })
    }

    fn with_blocks(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, blocks: u32) -> Result<Self, Error> {
        let free = Storage::new(gpu, "free slots", blocks as usize)?;
        encoder.copy_buffer_to_buffer(self.free.buffer(), 0, free.buffer(), 0, self.free.bytes());
        Ok(OwnBuffers { free, failed: self.failed.clone() })
    }

    /// Records that no vertex failed.
    fn record_clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.failed.buffer(), 0, None);
    }

    fn bindings(&self) -> Vec<Binding<'_>> {
        vec![("free", self.free.buffer()), ("failed", self.failed.buffer())]
    }

    fn bytes(&self) -> u64 {
        self.free.bytes() + self.failed.bytes()
    }
}
