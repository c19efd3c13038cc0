//! What a run has on the device, and the commands that it records there.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Parts, Pending, Readback, Recorder,
        device_mesh::DeviceMesh,
        layout::{BLOCK, COUNTER_WORDS, Counters, PARAM_WORDS, Params},
        phase1::{
            capacity::more_blocks,
            finish::Finish,
            memory::Memory,
            plan::{Batch, first_counters},
            round::RoundPlan,
            settings::Settings,
            stages::{Stage, Stages},
        },
        points::PointBuffers,
        start::StartMesh,
    },
};

/// The largest number of workgroups of a kernel with an invocation per slot: enough for the largest devices.
/// Kernels stride over what there is to do.
const MAX_WORKGROUPS: u32 = 512;

/// The most unused slots per 1,024 simplices of a mesh that is taken: so few that their product with
/// 1,024 fits 32 bits.
const MAX_SPREAD: u64 = 1 << 20;

/// The buffers of a run, and the parameters of its kernels.
pub(crate) struct DeviceRun<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(crate) params: Params,
    pub(crate) memory: Memory<D>,
    /// The points, for the next run.
    pub(crate) points: Option<PointBuffers>,
    pub(crate) settings: Settings<D>,
    /// The parts of the large arrays, if they are in parts.
    pub(crate) parts: Option<Parts>,
}

impl<const D: usize> DeviceRun<D>
where
    Dimension<D>: Finish<D>,
{
    /// Returns the workgroups of a kernel with an invocation per slot.
    pub(crate) fn workgroups(&self, gpu: &Gpu) -> u32 {
        let slots = self.params.blocks.saturating_mul(BLOCK);
        gpu.workgroups(slots as usize).min(MAX_WORKGROUPS)
    }

    /// Records a stage.
    fn record(&self, gpu: &Gpu, recorder: &mut Recorder<'_>, stage: Stage) {
        self.memory.bound.record(recorder, stage, self.workgroups(gpu));
    }

    /// Writes the parameters.
    fn write_params(&self, gpu: &Gpu) {
        self.memory.buffers.control.write(gpu, 0, bytemuck::cast_slice(&[self.params]));
    }

    /// Writes the counters.
    fn write_counters(&self, gpu: &Gpu, counters: Counters) {
        self.memory.buffers.control.write(gpu, PARAM_WORDS, bytemuck::cast_slice(&[counters]));
    }

    /// Sets what the parameters say of the start.
    pub(crate) fn set_start(&mut self, start: &StartMesh) {
        self.params = Params {
            moved_simplices: 0,
            moved_ghosts: 0,
            start_points: start.points.len() as u32,
            start_simplices: start.simplices.len() as u32,
            start_stride: start.stride(self.params.infinite),
            ..self.params
        };
    }

    /// Records the start, in which each point gets its simplex. `counters` are those before it.
    pub(crate) fn record_start(&self, gpu: &Gpu, recorder: &mut Recorder<'_>, start: &StartMesh, counters: &Counters) {
        let (inserted, active) = (self.params.start_points, self.params.start_simplices);
        self.write_params(gpu);
        self.write_counters(gpu, Counters { inserted, active_len: [active, 0], ..*counters });
        let buffers = &self.memory.buffers;
        buffers.start.points.write(gpu, 0, &start.points);
        buffers.start.simplices.write(gpu, 0, &start.simplices);
        buffers.record_clear(recorder);
        self.record(gpu, recorder, Stage::FillFree);
        self.record(gpu, recorder, Stage::Start);
    }

    /// Records a batch of rounds, without the start, and submits so many dispatches of it at a time.
    ///
    /// # Errors
    ///
    /// Those of [`DeviceRun::grow_to`].
    pub(crate) fn record_batch(
        &mut self,
        gpu: &Gpu,
        stages: &Stages,
        recorder: &mut Recorder<'_>,
        batch: &Batch,
        piece: usize,
    ) -> Result<(), Error> {
        if batch.grows {
            let more = self.settings.tail_blocks(self.params.infinite);
            self.grow_to(gpu, stages, recorder, self.params.blocks.saturating_add(more))?;
        }
        if batch.clears_votes {
            self.record(gpu, recorder, Stage::ClearVotes);
        }
        batch.rounds.iter().for_each(|&round| self.record_round(gpu, recorder, round, piece));
        Ok(())
    }

    fn record_round(&self, gpu: &Gpu, recorder: &mut Recorder<'_>, round: RoundPlan, piece: usize) {
        if !round.has_moved {
            self.memory.buffers.messages.record_clear(recorder.encoder());
        }
        let workgroups = self.workgroups(gpu);
        for stage in round.stages() {
            self.memory.bound.record(recorder, stage, workgroups);
            recorder.split(gpu, piece);
        }
    }

    /// Records that `mesh` is taken in place of a start.
    ///
    /// # Errors
    ///
    /// Those of [`DeviceRun::grow_to`].
    pub(crate) fn record_moved(
        &mut self,
        gpu: &Gpu,
        stages: &Stages,
        recorder: &mut Recorder<'_>,
        mesh: &DeviceMesh<D>,
    ) -> Result<(), Error> {
        let (simplices, hull) = (mesh.simplex_count(), mesh.hull_count());
        let all = (simplices + hull) as u32;
        // A sixteenth of the slots is left to flips.
        let blocks = (all + all / 16).div_ceil(BLOCK) + self.settings.tail_blocks(self.params.infinite);
        if D == 3 && blocks > self.params.blocks {
            self.grow_to(gpu, stages, recorder, blocks)?;
        }
        // In 2D, the last slot is never used.
        let free = self.params.blocks * BLOCK - all - 1;
        let [moved_inverted, moved_violated] = self.settings.budget.limits.most(simplices as f64);
        self.params = Params {
            blocks_before: 0,
            moved_simplices: simplices as u32,
            moved_ghosts: hull as u32,
            moved_spread: (u64::from(free) * 1024 / u64::from(all.max(1))).min(MAX_SPREAD) as u32,
            moved_inverted,
            moved_violated,
            ..self.params
        };
        self.write_params(gpu);
        self.write_counters(gpu, first_counters(0));
        let buffers = &self.memory.buffers;
        buffers.record_clear(recorder);
        self.record(gpu, recorder, Stage::FillFree);
        let mut bindings = buffers.bindings();
        bindings.extend([("moved_simplices", mesh.simplices()), ("moved_neighbors", mesh.neighbors())]);
        stages.moved.bind(&bindings).record(recorder, self.workgroups(gpu));
        Ok(())
    }

    /// Adds slots to the tail, so that there are so many blocks.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManySimplices`] and [`Error::BufferTooLarge`].
    fn grow_to(&mut self, gpu: &Gpu, stages: &Stages, recorder: &mut Recorder<'_>, blocks: u32) -> Result<(), Error> {
        let before = self.params.blocks;
        let blocks = more_blocks::<D>(gpu, self.parts, self.params.infinite, before, blocks)?;
        self.memory = self.memory.with_blocks(stages, gpu, recorder, blocks, self.parts)?;
        (self.params.blocks_before, self.params.blocks) = (before, blocks);
        self.write_params(gpu);
        self.record(gpu, recorder, Stage::FillFree);
        Ok(())
    }

    /// Records the readback of the counters.
    pub(crate) fn read_counters(
        &self,
        gpu: &Gpu,
        readback: &mut Readback,
        recorder: &mut Recorder<'_>,
    ) -> Pending<u32> {
        readback.copy(gpu, recorder.encoder(), &self.memory.buffers.control, PARAM_WORDS, COUNTER_WORDS)
    }
}

/// Returns the counters in the words that were read.
pub(crate) fn counters_in(words: &[u32]) -> Counters {
    *bytemuck::from_bytes(bytemuck::cast_slice(words))
}
