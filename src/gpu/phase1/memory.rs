//! What a run holds, and leaves to the next run of its form.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Parts, Recorder,
        phase1::{
            buffers::{Buffers, Sizes},
            finish::Finish,
            iterations::Needed,
            stages::{BoundStages, Stages},
        },
        points::{DevicePoints, PointBuffers},
    },
};

/// The buffers of a run, and the kernels' bind groups of them.
#[derive(Debug)]
pub(crate) struct Memory<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(crate) buffers: Buffers<D>,
    pub(crate) bound: BoundStages<D>,
}

/// What a run left.
#[derive(Debug)]
pub(crate) struct Kept<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(crate) points: Option<PointBuffers>,
    pub(crate) memory: Option<Memory<D>>,
    /// The flip iterations that the last run that inserted points needed.
    pub(crate) needed: Needed,
}

impl<const D: usize> Default for Kept<D>
where
    Dimension<D>: Finish<D>,
{
    fn default() -> Self {
        Kept { points: None, memory: None, needed: Needed::default() }
    }
}

impl<const D: usize> Memory<D>
where
    Dimension<D>: Finish<D>,
{
    fn bind(stages: &Stages, gpu: &Gpu, buffers: Buffers<D>) -> Result<Self, Error> {
        Ok(Memory { bound: stages.bind(gpu, &buffers)?, buffers })
    }

    /// Returns what is kept, if it is for these points and large enough, and creates all of it
    /// otherwise.
    pub(crate) fn new(
        stages: &Stages,
        gpu: &Gpu,
        kept: Option<Memory<D>>,
        points: DevicePoints,
        sizes: Sizes,
    ) -> Result<Self, Error> {
        let fits = |b: &Buffers<D>| {
            b.points.vertices.buffer() == points.vertices.buffer()
                && b.blocks() >= sizes.blocks
                && b.history.len() == sizes.history as usize
                && b.start.points.len() >= sizes.start_points
        };
        match kept {
            Some(memory) if fits(&memory.buffers) => Ok(memory),
            _ => Memory::bind(stages, gpu, Buffers::new(gpu, points, sizes)?),
        }
    }

    /// Returns the same with more blocks.
    pub(crate) fn with_blocks(
        &self,
        stages: &Stages,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        blocks: u32,
        parts: Option<Parts>,
    ) -> Result<Self, Error> {
        Memory::bind(stages, gpu, self.buffers.with_blocks(gpu, recorder, blocks, parts)?)
    }

    /// Returns the bytes that it takes, without the points.
    pub(crate) fn bytes(&self) -> u64 {
        self.buffers.bytes()
    }
}
