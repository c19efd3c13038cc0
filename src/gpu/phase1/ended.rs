//! The end of a run: the mesh without gaps, which stays on the device or is read.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Pending, Profiler, Recorder, Room, Rooms,
        dim::{Corners, Dim},
        host::{Fit, Host},
        layout::{COUNTER_WORDS, Counters, PARAM_WORDS},
        mesh_check::sum_of_phase1,
        phase1::{
            begin::Begin,
            finish::{Aliases, Copied, Copies, Finish},
            kernels::Phase1,
            memory::Memory,
            record::counters_in,
            run::Phase1Run,
            settings::Settings,
            stats::Phase1Stats,
        },
        points::PointBuffers,
        primitives::scan::GROUPS,
    },
    index::NONE,
    parallel::{self, Threads},
    stats::Stopwatch,
};

/// The output of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase1Output<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    /// The mesh, and what is to be repaired or checked of it.
    pub result: <Dimension<D> as Finish<D>>::Result,
    /// Points that are vertices of no simplex, with that of the point at the same place of the
    /// lattice: exact duplicates, and points that were rounded to the same place, which are
    /// inserted afterwards.
    pub merged: Vec<[u32; 2]>,
    /// What the run did.
    pub stats: Phase1Stats,
}

impl<'a, const D: usize> Phase1Run<'a, D>
where
    Dimension<D>: Finish<D>,
{
    /// Has threads look for memory for the mesh, which the host is to read, unless that of the lists `used`
    /// will do.
    pub(crate) fn prepare_room(&mut self, used: [Vec<Corners<D>>; 2]) {
        let len = self.device.params.infinite as usize * Dimension::<D>::MESH_PER_POINT;
        self.rooms = used.map(|used| Room::new(used, len));
    }

    /// Ends the run without a mesh, and keeps its buffers for the next one. Returns what it did as
    /// far as that is known.
    pub fn abandon(mut self) -> Phase1Stats {
        self.keep_needed();
        let Phase1Run { kernels, device, plan, mut meter, .. } = self;
        meter.end(*plan.counters());
        kernels.kept.points = device.points;
        keep(kernels, device.memory, meter.read_before, meter.stats)
    }

    /// Makes the mesh and reads it back.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub async fn finish(self) -> Result<Phase1Output<D>, Error> {
        let (mut ended, _, (), ()) = self.end(|_, _| (), || ()).await?;
        let (result, merged) = ended.read().await?;
        Ok(Phase1Output { result, merged, stats: ended.release() })
    }

    /// Makes the mesh and leaves it on the device. `more` records what the same submission is to do
    /// with it; the host does `meanwhile` before it waits for that.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(crate) async fn end<T, U>(
        mut self,
        more: impl FnOnce(&mut Copies<'_>, &Memory<D>) -> T,
        meanwhile: impl FnOnce() -> U,
    ) -> Result<(Ended<'a, D>, wgpu::SubmissionIndex, T, U), Error> {
        let gpu = self.gpu;
        let workgroups = self.workgroups();
        let profiler = self.profiler.take();
        let is_merged = self.plan.counters().merged > 0;
        let (submission, counters, finite, merged, more) = gpu
            .with_error_scope("the end of Phase 1", || {
                let (memory, readback) = (&self.device.memory, &mut self.kernels.readback);
                let mut copies = Copies { readback, gpu, recorder: Recorder::new(gpu, profiler) };
                memory.bound.record_end(&mut copies.recorder, workgroups);
                let more = more(&mut copies, memory);
                let finite = copies.copy_from(memory.bound.sums(), GROUPS, 1);
                let counters = copies.copy_from(&memory.buffers.control, PARAM_WORDS, COUNTER_WORDS);
                let merged_into = &memory.buffers.points.merged_into;
                let merged = is_merged.then(|| copies.copy(merged_into, merged_into.len()));
                self.meter.stats.dispatches += copies.recorder.dispatches();
                self.meter.stats.submits += 1;
                Ok((copies.recorder.submit(gpu), counters, finite, merged, more))
            })
            .await?;
        let prepared = meanwhile();
        // What was submitted beyond the end had nothing to do, and came before.
        self.receive_all().await?;
        self.meter.stats.stalls += 1;
        let words = self.kernels.readback.receive(gpu, &submission, counters).await?;
        let finite = self.kernels.readback.receive(gpu, &submission, finite).await?[0] as usize;
        let counters = counters_in(&words);
        self.check_lengths(&counters, finite)?;
        // All points are inserted that are not merged; of a mesh that has moved, duplicates may have parted.
        let is_counted = D == 3 && !self.has_moved();
        let vertices = is_counted.then(|| self.device.params.infinite.wrapping_sub(counters.merged));
        sum_of_phase1([counters.mesh_sum, counters.mesh_vertices], vertices).map_err(|what| gpu.wrong(what))?;
        if is_merged != (counters.merged > 0) {
            return Err(gpu.wrong("points are merged after the first round"));
        }
        self.meter.end(counters);
        self.keep_needed();
        self.kernels.kept.points = self.device.points;
        let merged = match merged {
            Some(merged) => Merged::Coming(submission.clone(), merged),
            None => Merged::Known(Vec::new()),
        };
        let ended = Ended {
            gpu,
            counters,
            finite,
            merged,
            workgroups,
            kernels: self.kernels,
            memory: self.device.memory,
            rooms: self.rooms,
            read_before: self.meter.read_before,
            stats: self.meter.stats,
        };
        Ok((ended, submission, more, prepared))
    }

    /// Checks the lengths of the lists that the end of Phase 1 has made.
    fn check_lengths(&self, counters: &Counters, finite: usize) -> Result<(), Error> {
        let (points, slots) = (self.device.params.infinite as usize, self.device.memory.buffers.simplices.len());
        let [ghosts, failed, uncertain, hull] =
            [counters.ghosts, counters.failed, counters.uncertain, counters.hull].map(|len| len as usize);
        // In 2D, simplices fail, and tests beyond the slots are only counted.
        let fits = finite.saturating_add(ghosts) <= slots
            && failed <= if D == 3 { points } else { slots }
            && (uncertain <= slots || D == 2)
            && hull <= points;
        if fits { Ok(()) } else { Err(self.gpu.wrong("a list of the mesh is longer than it can be")) }
    }

    /// Leaves what the run needed to the next one of as many points.
    fn keep_needed(&mut self) {
        self.kernels.kept.needed = self.plan.needed().unwrap_or(self.before);
    }
}

impl<const D: usize> Phase1<D>
where
    Dimension<D>: Finish<D>,
{
    /// Runs Phase 1.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::new`], [`Phase1Run::advance`] and [`Phase1Run::finish`].
    ///
    /// # Panics
    ///
    /// Those of [`Begin::of`].
    pub async fn run(
        &mut self,
        gpu: &Gpu,
        host: &mut impl Host<D>,
        settings: &Settings<D>,
        profiler: Option<&mut Profiler>,
    ) -> Result<Phase1Output<D>, Error> {
        let begin = Begin::of(host.ask(Fit::default()).await?);
        let mut run = Phase1Run::new(self, gpu, host, begin, *settings, profiler).await?;
        while run.advance().await? {}
        run.finish().await
    }
}

/// Keeps the buffers of a run for the next one. Returns what the run did.
fn keep<const D: usize>(
    kernels: &mut Phase1<D>,
    memory: Memory<D>,
    read_before: (usize, u64),
    mut stats: Phase1Stats,
) -> Phase1Stats
where
    Dimension<D>: Finish<D>,
{
    stats.readbacks = kernels.readback.count() - read_before.0;
    stats.bytes_read = kernels.readback.bytes() - read_before.1;
    stats.bytes = memory.bytes() + kernels.kept.points.as_ref().map_or(0, PointBuffers::bytes);
    kernels.kept.memory = Some(memory);
    stats
}

/// A run that has made the mesh, which is still on the device.
pub struct Ended<'a, const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(crate) kernels: &'a mut Phase1<D>,
    pub(crate) gpu: &'a Gpu,
    pub(crate) memory: Memory<D>,
    pub(crate) counters: Counters,
    /// The number of finite simplices.
    pub(crate) finite: usize,
    merged: Merged,
    pub(crate) workgroups: u32,
    rooms: Rooms<Corners<D>>,
    read_before: (usize, u64),
    pub(crate) stats: Phase1Stats,
}

/// The points that are merged into others, each with the other one.
enum Merged {
    /// They are being read.
    Coming(wgpu::SubmissionIndex, Pending<u32>),
    Known(Vec<[u32; 2]>),
}

impl<const D: usize> Ended<'_, D>
where
    Dimension<D>: Finish<D>,
{
    /// Returns the number of simplices of the mesh, the infinite ones included if it has them.
    pub(crate) fn len(&self) -> usize {
        Dimension::<D>::mesh_len(self.finite, &self.counters)
    }

    /// Reads the mesh back, and what is to be repaired or checked of it; and the points that are
    /// vertices of no simplex, as [`Phase1Output::merged`] has them.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(crate) async fn read(&mut self) -> Result<(<Dimension<D> as Finish<D>>::Result, Vec<[u32; 2]>), Error> {
        let mut clock = Stopwatch::start();
        let rooms = self.take_rooms();
        let (gpu, readback, Memory { buffers, bound }) = (self.gpu, &mut self.kernels.readback, &self.memory);
        let (submission, reading) = gpu
            .with_error_scope("the result of Phase 1", || {
                let mut copies = Copies { readback, gpu, recorder: Recorder::new(gpu, None) };
                let reading = Dimension::<D>::copy(&mut copies, buffers, &bound.aliases, &self.counters);
                Ok((copies.recorder.submit(gpu), reading))
            })
            .await?;
        let before = readback.count();
        let len = Dimension::<D>::mesh_len(self.finite, &self.counters);
        let arrays = readback.read_arrays(gpu, &bound.aliases.arrays(), rooms, len).await?;
        self.stats.submits += 1 + readback.count() - before;
        let mut copied = Copied { readback, gpu, submission };
        let result = Dimension::<D>::receive(&mut copied, reading, arrays, self.finite).await?;
        let merged = self.read_merged().await?;
        self.stats.readback_time += clock.lap();
        // The device has nothing to do while the host waits for the last submission.
        self.stats.stalls += 1;
        Ok((result, merged))
    }

    /// Returns the memory that there is for the simplices and for their neighbours by now.
    pub(crate) fn take_rooms(&mut self) -> [Vec<Corners<D>>; 2] {
        std::mem::take(&mut self.rooms).map(|room| room.map_or_else(Vec::new, Room::take))
    }

    /// Reads the points that are vertices of no simplex.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(crate) async fn read_merged(&mut self) -> Result<Vec<[u32; 2]>, Error> {
        let merged = match std::mem::replace(&mut self.merged, Merged::Known(Vec::new())) {
            Merged::Coming(submission, merged) => {
                let merged = pairs(self.kernels.readback.receive(self.gpu, &submission, merged).await?);
                let points = self.memory.buffers.points.pairs.len();
                if merged.iter().any(|&[_, first]| first as usize >= points) {
                    return Err(self.gpu.wrong("a point is merged into one that is none"));
                }
                merged
            }
            Merged::Known(merged) => merged,
        };
        self.merged = Merged::Known(merged.clone());
        Ok(merged)
    }

    /// Keeps the buffers for the next run. Returns what this one did.
    pub(crate) fn release(self) -> Phase1Stats {
        keep(self.kernels, self.memory, self.read_before, self.stats)
    }
}

/// Returns the points that are merged into others, each with the other one.
pub(super) fn pairs(merged_into: Vec<u32>) -> Vec<[u32; 2]> {
    parallel::joined(parallel::map_ranges(Threads::All, merged_into.len(), |range| {
        let merged = range.filter(|&point| merged_into[point] != NONE);
        merged.map(|point| [point as u32, merged_into[point]]).collect::<Vec<_>>()
    }))
}
