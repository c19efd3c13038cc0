//! A run of Phase 1: what the host records, and what it reads back.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Pending, Profiler, Recorder,
        dim::{Dim, Flip},
        iterations::{Iterations, bid_bits},
        layout::{BLOCK, COUNTER_WORDS, Counters, NONE, PARAM_WORDS, Params, SLOTS_FULL},
        phase1::{
            buffers::{Buffers, largest_bytes},
            finish::{BoundFinish, Finish},
            flip::FlipPlan,
            kernels::Phase1,
            memory::{Kept, Memory},
            settings::Settings,
            stats::Phase1Stats,
        },
        points::{PointBuffers, PointInput},
        primitives::scan::GROUPS,
        start::Start,
        workgroups,
    },
    input::{lattice::Lattice, points::Points},
    options::Winding,
    stats::{Round, Stopwatch},
};

/// The points of a run.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a, const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// The points, in input order.
    pub points: Points<'a, D>,
    /// The lattice that is fitted to them.
    pub lattice: &'a Lattice<D>,
    /// The first simplex, by input indices.
    pub start: Start<D>,
}

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

/// A run in progress.
pub struct Run<'a, const D: usize>
where
    Dimension<D>: Finish<D>,
{
    kernels: &'a mut Phase1<D>,
    gpu: &'a Gpu,
    settings: Settings<D>,
    profiler: Option<&'a mut Profiler>,
    params: Params,
    counters: Counters,
    points: Option<PointBuffers>,
    memory: Memory<D>,
    /// Readbacks before this run.
    read_before: usize,
    /// Whether nothing is located yet.
    first: bool,
    iterations: Iterations,
    stats: Phase1Stats,
    clock: Stopwatch,
    round_clock: Stopwatch,
}

/// Simplices are numbered in 30 bits.
const MAX_SIMPLICES: u32 = 1 << 30;

/// Blocks in the tail for no points: so many that few points do not need many steps to grow.
const MIN_TAIL_BLOCKS: u32 = 64;

/// Nodes of the history, however few the points are.
const MIN_HISTORY: u64 = 64;

/// Returns the blocks that are added to the tail at a time.
fn tail_blocks<const D: usize>(points: u32, settings: &Settings<D>) -> u32 {
    MIN_TAIL_BLOCKS + points / settings.points_per_tail_block.max(1)
}

/// Returns the blocks for so many points, with the first tail.
fn first_blocks<const D: usize>(points: u32, settings: &Settings<D>) -> u32
where
    Dimension<D>: Dim<D>,
{
    Dimension::<D>::blocks(points, tail_blocks(points, settings))
}

/// Returns the largest number of points whose buffers a device can bind.
fn max_points<const D: usize>(limit: u64, settings: &Settings<D>) -> usize
where
    Dimension<D>: Dim<D>,
{
    let fits = |points: &u32| largest_bytes(first_blocks(*points, settings)) <= limit.into();
    let (mut fitting, mut too_many) = (0, Dimension::<D>::MAX_POINTS as u32 + 1);
    while too_many - fitting > 1 {
        let middle = fitting + (too_many - fitting) / 2;
        *(if fits(&middle) { &mut fitting } else { &mut too_many }) = middle;
    }
    fitting as usize
}

/// Returns the counters in the words that were read back.
fn counters_in(words: &[u32]) -> Counters {
    *bytemuck::from_bytes(bytemuck::cast_slice(words))
}

impl<'a, const D: usize> Run<'a, D>
where
    Dimension<D>: Finish<D>,
{
    /// The largest number of points.
    pub const MAX_POINTS: usize = Dimension::<D>::MAX_POINTS;

    /// Uploads the points and records their ordering.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManyPoints`]; [`Error::BufferTooLarge`] and [`Error::OutOfDeviceMemory`]
    /// when the device cannot hold the buffers.
    pub async fn new(
        kernels: &'a mut Phase1<D>,
        gpu: &'a Gpu,
        input: Input<'_, D>,
        settings: Settings<D>,
        mut profiler: Option<&'a mut Profiler>,
    ) -> Result<Self, Error> {
        let (clock, round_clock) = (Stopwatch::start(), Stopwatch::start());
        let count = input.points.len();
        if count > Self::MAX_POINTS {
            return Err(Error::TooManyPoints { points: count, limit: Self::MAX_POINTS });
        }
        let points = count as u32;
        let blocks = first_blocks(points, &settings);
        let (bytes, limit) = (largest_bytes(blocks), gpu.max_storage_bytes());
        if bytes > limit.into() {
            let points = Some(max_points(limit, &settings));
            return Err(Error::BufferTooLarge { label: Dimension::<D>::SIMPLICES, bytes, limit, points });
        }
        let bindable = gpu.max_storage_bytes() / size_of::<Flip<D>>() as u64;
        let wanted = u64::from(settings.history) * u64::from(points);
        let history = wanted.clamp(MIN_HISTORY, bindable.max(MIN_HISTORY)) as u32;
        // What is kept is lost if the run fails.
        let Kept { points: mut point_buffers, memory: kept } = std::mem::take(&mut kernels.kept);
        let (memory, dispatches) = gpu
            .with_error_scope("Phase 1", || {
                // The device orders the points while the host makes the other buffers.
                let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
                let Input { points: input, lattice, start } = input;
                // Three of a triangle's, the last one twice.
                let first = start.first.as_ref();
                let wanted = std::array::from_fn(|k| first[k.min(D)]);
                let input = PointInput { points: input, lattice, wanted, sort: settings.sort };
                let device = kernels.points.record(gpu, &mut recorder, &mut point_buffers, input)?;
                let mut words = Vec::new();
                Dimension::<D>::append_vertex(&mut words, lattice.width(), start.interior_point, points, false);
                device.vertices.write(gpu, count * words.len(), &words);
                let dispatches = recorder.dispatches();
                recorder.submit(gpu);
                Ok((Memory::new(&kernels.stages, gpu, kept, device, blocks, history)?, dispatches))
            })
            .await?;
        let blocks = memory.buffers.blocks();
        Ok(Run {
            gpu,
            settings,
            profiler,
            params: Params {
                infinite: points,
                blocks,
                history,
                bid_bits: bid_bits(blocks),
                min_active: settings.min_active,
                pick: settings.pick as u32,
                entries: points,
                clockwise: u32::from(settings.winding == Winding::Clockwise),
                ..Params::default()
            },
            counters: Counters { first_node: 1, next_node: 1, ..Counters::default() },
            points: point_buffers,
            memory,
            read_before: kernels.readback.count(),
            kernels,
            first: true,
            iterations: Iterations::new(),
            stats: Phase1Stats { dispatches, submits: 1, ..Phase1Stats::default() },
            clock,
            round_clock,
        })
    }

    /// Returns the buffers, for tests.
    pub fn buffers(&self) -> &Buffers<D> {
        &self.memory.buffers
    }

    /// Returns the parameters and the counters as of the last round.
    pub fn control(&self) -> (Params, Counters) {
        (self.params, self.counters)
    }

    /// Returns the number of points that are not inserted yet.
    pub fn waiting(&self) -> u32 {
        self.params.infinite - self.counters.inserted - self.counters.merged
    }

    /// Returns the number of active simplices.
    pub fn active(&self) -> u32 {
        self.counters.active_len[(self.counters.iteration & 1) as usize]
    }

    /// Runs an insertion round, or, when all points are inserted, flip iterations. Returns whether
    /// there is more to do.
    ///
    /// # Errors
    ///
    /// Returns [`Error::BufferTooLarge`] and [`Error::OutOfDeviceMemory`] when there are more
    /// tetrahedra than the device can hold; [`Error::DeviceLost`] and [`Error::Gpu`].
    pub async fn round(&mut self) -> Result<bool, Error> {
        let gpu = self.gpu;
        let before = self.counters;
        let inserts = self.first || self.waiting() > 0;
        let (submission, pending) = gpu.with_error_scope("Phase 1", || self.submit_round(inserts)).await?;
        let words = self.kernels.readback.receive(gpu, &submission, pending).await?;
        let read = counters_in(&words);
        self.counters = read;
        let used = self.iterations.plan(&before, &read, self.waiting());
        self.stats.submits += 1;
        self.stats.rounds.push(Round {
            inserted: read.inserted - before.inserted,
            active: self.active(),
            flips: read.flips() - before.flips(),
            iterations: used,
            time: self.round_clock.lap(),
        });
        if inserts && read.inserted == before.inserted && self.waiting() > 0 {
            return Err(Error::Gpu { message: "an insertion round inserted nothing".to_owned() });
        }
        Ok(self.waiting() > 0 || self.active() > 0)
    }

    fn submit_round(&mut self, inserts: bool) -> Result<(wgpu::SubmissionIndex, Pending<u32>), Error> {
        let gpu = self.gpu;
        let workgroups = self.workgroups();
        let mut profiler = self.profiler.take();
        let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
        // In a small triangulation every flip that waits costs failed vertices in the end.
        let few = self.settings.min_active.min(self.counters.inserted >> 10);
        self.params.min_active = if inserts { few } else { 0 };
        let slots = self.params.blocks * BLOCK;
        self.params.compact_from = slots.checked_div(self.settings.slots_per_active).map_or(u32::MAX, |n| n.max(1));
        if self.counters.overflow & SLOTS_FULL != 0 {
            self.grow(&mut recorder)?;
        }
        let stages = &self.kernels.stages;
        if std::mem::take(&mut self.first) {
            self.write_control();
            self.memory.buffers.record_clear(&mut recorder);
            stages.insert.record_first(&mut recorder, &self.memory.bound.insert, workgroups);
        } else {
            let waiting = self.waiting();
            self.params.entries_before = self.params.entries;
            // Compacting the list costs about as much as walking it a few times.
            if waiting < self.params.entries / 4 * 3 {
                let (entries, bound) = (self.params.entries, &self.memory.bound.relocate);
                stages.relocate.record_compaction(gpu, &mut recorder, bound, entries, workgroups);
                self.params.entries = waiting;
            }
            self.counters.overflow = 0;
            self.write_control();
        }
        let Memory { buffers, bound } = &self.memory;
        stages.insert.record(&mut recorder, &bound.insert, buffers, workgroups);
        if !(self.settings.insert_all && inserts) {
            self.record_flips(&mut recorder);
        }
        if inserts {
            self.kernels.stages.relocate.record(&mut recorder, &self.memory.bound.relocate, workgroups);
        }
        self.stats.dispatches += recorder.dispatches();
        let pending = self.read_counters(recorder.encoder());
        let submission = recorder.submit(gpu);
        self.profiler = profiler;
        Ok((submission, pending))
    }

    fn read_counters(&mut self, encoder: &mut wgpu::CommandEncoder) -> Pending<u32> {
        let control = &self.memory.buffers.control;
        self.kernels.readback.copy(self.gpu, encoder, control, PARAM_WORDS, COUNTER_WORDS)
    }

    /// Writes the parameters as the host knows them, and the counters as they were last read: no
    /// kernel runs between.
    fn write_control(&self) {
        self.memory.buffers.control.write(self.gpu, 0, bytemuck::cast_slice(&[self.params]));
        self.memory.buffers.control.write(self.gpu, PARAM_WORDS, bytemuck::cast_slice(&[self.counters]));
    }

    fn workgroups(&self) -> u32 {
        let max = self.settings.workgroups.min(self.gpu.max_workgroups());
        workgroups(self.params.blocks.saturating_mul(BLOCK)).min(max)
    }

    fn record_flips(&mut self, recorder: &mut Recorder<'_>) {
        let workgroups = self.workgroups();
        let (flip, bound) = (&self.kernels.stages.flip, &self.memory.bound.flip);
        let exact_every = self.iterations.exact_every();
        let compacts = self.settings.slots_per_active > 0;
        self.iterations.record(
            recorder,
            self.params.bid_bits,
            |recorder, iterations| {
                let plan = FlipPlan { iterations, exact_every, compacts };
                flip.record(recorder, bound, plan, workgroups);
            },
            |recorder| flip.record_clear_votes(recorder, bound, workgroups),
        );
    }

    /// Adds slots to the tail.
    fn grow(&mut self, recorder: &mut Recorder<'_>) -> Result<(), Error> {
        let before = self.params.blocks;
        let more = tail_blocks(self.params.infinite, &self.settings);
        let blocks = before.saturating_add(more).min(MAX_SIMPLICES / BLOCK - 1);
        if blocks == before {
            return Err(Error::TooManySimplices { limit: MAX_SIMPLICES as usize });
        }
        let (bytes, limit) = (largest_bytes(blocks), self.gpu.max_storage_bytes());
        if bytes > limit.into() {
            // Points that lie like these.
            let points = u128::from(self.params.infinite) * u128::from(limit) / bytes;
            let points = Some(points as usize);
            return Err(Error::BufferTooLarge { label: Dimension::<D>::SIMPLICES, bytes, limit, points });
        }
        let stages = &self.kernels.stages;
        self.memory = self.memory.with_blocks(stages, self.gpu, recorder, blocks)?;
        (self.params.blocks_before, self.params.blocks) = (before, blocks);
        self.params.bid_bits = bid_bits(blocks);
        let (bound, workgroups) = (&self.memory.bound, self.workgroups());
        stages.insert.record_fill_free(recorder, &bound.insert, "grow", workgroups);
        // Bids now have a different form.
        stages.flip.record_clear_votes(recorder, &bound.flip, workgroups);
        self.iterations.restart();
        Ok(())
    }

    /// Makes the mesh and reads it back.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Run::round`].
    pub async fn finish(mut self) -> Result<Phase1Output<D>, Error> {
        let gpu = self.gpu;
        let workgroups = self.workgroups();
        let profiler = self.profiler.take();
        let (submission, counters, finite) = gpu
            .with_error_scope("the end of Phase 1", || {
                let mut recorder = Recorder::new(gpu, profiler);
                let (finish, bound) = (&self.kernels.stages.finish, &self.memory.bound.finish);
                finish.record(&mut recorder, bound, workgroups);
                self.stats.dispatches += recorder.dispatches();
                self.stats.submits += 1;
                let encoder = recorder.encoder();
                let finite = self.kernels.readback.copy(gpu, encoder, bound.sums(), GROUPS, 1);
                let counters = self.read_counters(encoder);
                Ok((recorder.submit(gpu), counters, finite))
            })
            .await?;
        let words = self.kernels.readback.receive(gpu, &submission, counters).await?;
        let finite = self.kernels.readback.receive(gpu, &submission, finite).await?[0] as usize;
        let counters = counters_in(&words);
        self.stats.time = self.clock.lap();

        let Run { kernels, points, memory, read_before, mut stats, mut clock, .. } = self;
        let readback = &mut kernels.readback;
        let (result, merged_into) = memory.bound.finish.read(gpu, readback, &memory.buffers, finite, &counters).await?;
        stats.readback_time = clock.lap();
        stats.counters = counters;
        stats.submits += BoundFinish::<D>::SUBMITS;
        stats.readbacks = readback.count() - read_before;
        stats.bytes = memory.bytes() + points.as_ref().map_or(0, PointBuffers::bytes);
        kernels.kept = Kept { points, memory: Some(memory) };
        let merged = (0..).zip(merged_into).filter(|&(_, other)| other != NONE);
        Ok(Phase1Output { result, merged: merged.map(|(point, other)| [point, other]).collect(), stats })
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
    /// Returns the errors of [`Run::new`], [`Run::round`] and [`Run::finish`].
    pub async fn run(
        &mut self,
        gpu: &Gpu,
        input: Input<'_, D>,
        settings: &Settings<D>,
        profiler: Option<&mut Profiler>,
    ) -> Result<Phase1Output<D>, Error> {
        let mut run = Run::new(self, gpu, input, *settings, profiler).await?;
        while run.round().await? {}
        run.finish().await
    }
}
