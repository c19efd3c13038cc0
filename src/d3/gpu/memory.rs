//! What a run holds on the device, and leaves to the next run of its form.

use crate::d3::gpu::{buffers::Buffers, phase1::Phase1};
use crate::{
    Error,
    d3::gpu::{finish::BoundFinish, flip::BoundFlip, insert::BoundInsert, relocate::BoundRelocate},
    gpu::{
        Gpu, Recorder,
        points::{DevicePoints, PointBuffers},
    },
};

/// The buffers of a run, and the kernels' bind groups of them.
#[derive(Debug)]
pub(crate) struct Memory {
    pub(crate) buffers: Buffers,
    pub(crate) insert: BoundInsert,
    pub(crate) flip: BoundFlip,
    pub(crate) relocate: BoundRelocate,
    pub(crate) finish: BoundFinish,
    pub(crate) fill_free: wgpu::BindGroup,
}

/// What a run left.
#[derive(Debug, Default)]
pub(crate) struct Kept {
    pub(crate) points: Option<PointBuffers>,
    pub(crate) memory: Option<Memory>,
}

impl Memory {
    fn bind(kernels: &Phase1, gpu: &Gpu, buffers: Buffers) -> Result<Self, Error> {
        Ok(Memory {
            insert: kernels.insert.bind(gpu, &buffers),
            flip: kernels.flip.bind(gpu, &buffers),
            relocate: kernels.relocate.bind(gpu, &buffers)?,
            finish: kernels.finish.bind(gpu, &buffers)?,
            fill_free: kernels.fill_free.bind(gpu, &buffers.bindings()),
            buffers,
        })
    }

    /// What is kept, if it is for these points and large enough, else all of it anew.
    pub(crate) fn new(
        kernels: &Phase1,
        gpu: &Gpu,
        kept: Option<Memory>,
        points: DevicePoints,
        blocks: u32,
        history: u32,
    ) -> Result<Self, Error> {
        let fits = |b: &Buffers| {
            b.points.vertices.buffer() == points.vertices.buffer()
                && b.free.len() >= blocks as usize
                && b.history.len() == history as usize
        };
        match kept {
            Some(memory) if fits(&memory.buffers) => Ok(memory),
            _ => Memory::bind(kernels, gpu, Buffers::new(gpu, points, blocks, history)?),
        }
    }

    /// The same with more blocks.
    pub(crate) fn with_blocks(
        &self,
        kernels: &Phase1,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        blocks: u32,
    ) -> Result<Self, Error> {
        Memory::bind(kernels, gpu, self.buffers.with_blocks(gpu, recorder, blocks)?)
    }

    /// The blocks that there are.
    pub(crate) fn blocks(&self) -> u32 {
        self.buffers.free.len() as u32
    }

    /// The bytes that it takes, but for the points.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffers.bytes() + self.relocate.bytes() + self.finish.bytes()
    }
}
