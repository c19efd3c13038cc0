//! The buffers of Phase 1 that only 3D has.

use crate::{
    error::Error,
    gpu::{Binding, Gpu, Parts, Storage, append_bindings, dim, layout::BLOCK, shader::assert_layout},
};
use bytemuck::{Pod, Zeroable};

/// The parameters of gathering tetrahedra, and of writing changed ones back.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Gathering {
    /// The number of the first tetrahedron that is gathered: 1 at the first time.
    pub first: u32,
    /// The entries of the patch.
    pub patched: u32,
}
assert_layout!(Gathering);

/// The buffers of Phase 1 that only 3D has.
#[derive(Debug, Clone)]
pub struct OwnBuffers {
    /// Whether each vertex failed.
    pub failed: Storage<u32>,
    /// One tetrahedron of the mesh at each point, plus 1; 0 for points that are merged into others.
    /// Infinity comes last.
    pub vertex_simplex: Storage<u32>,
    /// For each point, a bit that says whether its star is wanted.
    pub wanted: Storage<u32>,
    /// The parameters of gathering.
    pub gathering: Storage<Gathering>,
    /// For each tetrahedron of the mesh, the number under which it was gathered, or 0.
    pub region_numbers: Storage<u32>,
    /// Where the gathered tetrahedra are in the mesh, as [`Gathered::slots`](crate::d3::splay::Gathered::slots)
    /// has it; then the slots of the patch.
    pub gathered_slots: Storage<u32>,
}

impl dim::OwnBuffers for OwnBuffers {
    fn new(gpu: &Gpu, points: usize, blocks: u32, parts: Option<Parts>) -> Result<Self, Error> {
        let slots = blocks as usize * BLOCK as usize;
        Ok(OwnBuffers {
            failed: Storage::new(gpu, "failed vertices", points)?,
            vertex_simplex: Storage::new(gpu, "tetrahedra of points", points + 1)?,
            wanted: Storage::new(gpu, "wanted stars", points.div_ceil(32))?,
            gathering: Storage::new(gpu, "gathering", 1)?,
            region_numbers: Storage::in_parts(gpu, "numbers of gathered tetrahedra", slots, parts)?,
            gathered_slots: Storage::in_parts(gpu, "slots of gathered tetrahedra", slots, parts)?,
        })
    }

    fn with_blocks(
        &self,
        gpu: &Gpu,
        _encoder: &mut wgpu::CommandEncoder,
        blocks: u32,
        parts: Option<Parts>,
    ) -> Result<Self, Error> {
        let slots = blocks as usize * BLOCK as usize;
        // Nothing was gathered yet.
        Ok(OwnBuffers {
            region_numbers: Storage::in_parts(gpu, "numbers of gathered tetrahedra", slots, parts)?,
            gathered_slots: Storage::in_parts(gpu, "slots of gathered tetrahedra", slots, parts)?,
            ..self.clone()
        })
    }

    /// Records that no vertex failed, that no point has a tetrahedron, and that no star is wanted.
    fn record_clear(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(self.failed.buffer(), 0, None);
        encoder.clear_buffer(self.vertex_simplex.buffer(), 0, None);
        encoder.clear_buffer(self.wanted.buffer(), 0, None);
    }

    fn bindings(&self) -> Vec<Binding<'_>> {
        let mut bindings = vec![
            ("failed", self.failed.buffer()),
            ("vertex_simplex", self.vertex_simplex.buffer()),
            ("wanted", self.wanted.buffer()),
            ("gathering", self.gathering.buffer()),
        ];
        append_bindings(
            &mut bindings,
            &[self.region_numbers.named("region_numbers"), self.gathered_slots.named("gathered_slots")],
        );
        bindings
    }

    fn bytes(&self) -> u64 {
        let OwnBuffers { failed, vertex_simplex, wanted, gathering, region_numbers, gathered_slots } = self;
        let points = failed.bytes() + vertex_simplex.bytes() + wanted.bytes() + gathering.bytes();
        points + region_numbers.bytes() + gathered_slots.bytes()
    }
}
