//! The buffers of Phase 1 that only 3D has.

use crate::{
    error::Error,
    gpu::{Binding, Gpu, Storage, dim},
};

/// The buffers of Phase 1 that only 3D has.
#[derive(Debug, Clone)]
pub struct OwnBuffers {
    /// Whether each vertex failed.
    pub failed: Storage<u32>,
    /// One tetrahedron of the mesh at each point, plus 1; 0 for points that are merged into others.
    /// Infinity comes last.
    pub tet_of: Storage<u32>,
}

impl dim::OwnBuffers for OwnBuffers {
    fn new(gpu: &Gpu, points: usize, _blocks: u32) -> Result<Self, Error> {
        Ok(OwnBuffers {
            failed: Storage::new(gpu, "failed vertices", points)?,
            tet_of: Storage::new(gpu, "tetrahedra of points", points + 1)?,
        })
    }

    fn with_blocks(&self, _gpu: &Gpu, _encoder: &mut wgpu::CommandEncoder, _blocks: u32) -> Result<Self, Error> {
        Ok(self.clone())
    }

    /// Records that no vertex failed, and that no point has a tetrahedron.
    fn record_clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.failed.buffer(), 0, None);
        encoder.clear_buffer(self.tet_of.buffer(), 0, None);
    }

    fn bindings(&self) -> Vec<Binding<'_>> {
        vec![("failed", self.failed.buffer()), ("tet_of", self.tet_of.buffer())]
    }

    fn bytes(&self) -> u64 {
        self.failed.bytes() + self.tet_of.bytes()
    }
}
