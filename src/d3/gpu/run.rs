//! A run of Phase 1: what the host records, and what it reads back.

use bytemuck::Zeroable;

use crate::{
    Error,
    d3::gpu::{finish::BoundFinish, vertex},
    gpu::{
        Gpu, Pending, Profiler, Recorder,
        iterations::{Iterations, bid_bits},
        layout::{BLOCK, Counters, FlipNode, NONE, Params, SLOTS_FULL},
        points::{PointBuffers, PointInput},
        workgroups,
    },
    stats::{Round, Stopwatch},
};
use crate::{
    d3::gpu::{
        buffers::{Buffers, largest_bytes},
        memory::{Kept, Memory},
        phase1::{Input, Phase1, Phase1Output, Phase1Stats, Settings},
    },
    gpu::layout::{COUNTER_WORDS, PARAM_WORDS},
};

/// Where few signs are left open, exact checks wait for each other: one alone takes longer than all filters of an iteration.
/// Where they are many, there would be no progress. So they follow the filter in every so many iterations, when the
/// filter leaves at most one sign open for so many visited tetrahedra.
const EXACT_EVERY: [(u32, u64); 2] = [(4, 16), (2, 3)];

/// A run that is under way.
pub struct Run<'a> {
    kernels: &'a mut Phase1,
    gpu: &'a Gpu,
    settings: Settings,
    profiler: Option<&'a mut Profiler>,
    params: Params,
    counters: Counters,
    points: Option<PointBuffers>,
    memory: Memory,
    /// Readbacks before this run.
    read_before: usize,
    /// Nothing is located yet.
    first: bool,
    iterations: Iterations,
    /// Exact checks follow the filter in every so many iterations of a round.
    exact_every: u32,
    stats: Phase1Stats,
    clock: Stopwatch,
    round_clock: Stopwatch,
}

/// The blocks for so many points: theirs, that of infinity, and a tail.
fn first_blocks(points: u32, settings: &Settings) -> u32 {
    points + 1 + tail_blocks(points, settings)
}

/// The most points whose buffers a device can bind.
fn max_points(limit: u64, settings: &Settings) -> usize {
    let fits = |points: &u32| largest_bytes(first_blocks(*points, settings)) <= limit.into();
    let (mut fitting, mut too_many) = (0, Run::MAX_POINTS as u32 + 1);
    while too_many - fitting > 1 {
        let middle = fitting + (too_many - fitting) / 2;
        *(if fits(&middle) { &mut fitting } else { &mut too_many }) = middle;
    }
    fitting as usize
}

/// Blocks that are added to the tail at a time: at least 64, so that few points do not need many steps.
fn tail_blocks(points: u32, settings: &Settings) -> u32 {
    64 + points / settings.points_per_tail_block.max(1)
}

impl<'a> Run<'a> {
    /// The most points: tetrahedra are numbered in 30 bits, and there are eight slots a point and some.
    pub const MAX_POINTS: usize = 120_000_000;

    /// Uploads the points and records their ordering.
    ///
    /// # Errors
    ///
    /// [`Error::TooManyPoints`]; [`Error::BufferTooLarge`] and [`Error::OutOfDeviceMemory`] when the device cannot hold
    /// the buffers.
    pub async fn new(
        kernels: &'a mut Phase1,
        gpu: &'a Gpu,
        input: Input<'_>,
        settings: Settings,
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
            return Err(Error::BufferTooLarge { label: "tetrahedra", bytes, limit, points });
        }
        let bindable = gpu.max_storage_bytes() / size_of::<FlipNode>() as u64;
        let history = (u64::from(settings.history) * u64::from(points)).clamp(64, bindable.max(64)) as u32;
        // What is kept is lost if the run fails.
        let Kept { points: mut point_buffers, memory: kept } = std::mem::take(&mut kernels.kept);
        let (memory, dispatches) = gpu
            .with_error_scope("Phase 1", || {
                // The device orders the points while the host makes the other buffers.
                let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
                let Input { points: input, lattice, start } = input;
                let buffers = &mut point_buffers;
                let input = PointInput { points: input, lattice, wanted: start.first, sort: settings.sort };
                let device = kernels.points.record(gpu, &mut recorder, buffers, input)?;
                let mut kernel_point = Vec::new();
                vertex::append_words(&mut kernel_point, lattice.width(), start.interior_point, points);
                let kernel_point = kernel_point.as_flattened();
                device.vertices.write(gpu, count * kernel_point.len(), kernel_point);
                let dispatches = recorder.dispatches();
                recorder.submit(gpu);
                Ok((Memory::new(kernels, gpu, kept, device, blocks, history)?, dispatches))
            })
            .await?;
        let blocks = memory.blocks();
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
                ..Params::default()
            },
            counters: Counters { first_node: 1, next_node: 1, ..Counters::default() },
            points: point_buffers,
            memory,
            read_before: kernels.readback.count(),
            kernels,
            first: true,
            iterations: Iterations::new(),
            exact_every: EXACT_EVERY[0].0,
            stats: Phase1Stats { dispatches, submits: 1, ..Phase1Stats::default() },
            clock,
            round_clock,
        })
    }

    /// The buffers, for tests.
    pub fn buffers(&self) -> &Buffers {
        &self.memory.buffers
    }

    /// The parameters and the counters as of the last round, for tests.
    pub fn control(&self) -> (Params, Counters) {
        (self.params, self.counters)
    }

    /// Points that are not inserted yet.
    pub fn waiting(&self) -> u32 {
        self.params.infinite - self.counters.inserted - self.counters.merged
    }

    /// Active tetrahedra.
    pub fn active(&self) -> u32 {
        self.counters.active_len[(self.counters.iteration & 1) as usize]
    }

    /// Runs an insertion round, or, when all points are inserted, flip iterations. Returns whether there is more to do.
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooLarge`] and [`Error::OutOfDeviceMemory`] when there are more tetrahedra than the device can
    /// hold; [`Error::DeviceLost`] and [`Error::Gpu`].
    pub async fn round(&mut self) -> Result<bool, Error> {
        let gpu = self.gpu;
        let before = self.counters;
        let inserts = self.first || self.waiting() > 0;
        let (submission, pending) = gpu.with_error_scope("Phase 1", || self.submit_round(inserts)).await?;
        let words = self.kernels.readback.receive(gpu, &submission, pending).await?;
        let read: Counters = *bytemuck::from_bytes(bytemuck::cast_slice(&words));
        self.counters = read;
        let used = self.iterations.plan(&before, &read, self.waiting());
        let exact = u64::from(read.exact.wrapping_sub(before.exact));
        let visits = u64::from(read.visits.wrapping_sub(before.visits));
        self.exact_every =
            EXACT_EVERY.iter().find(|(_, for_one)| exact * for_one <= visits).map_or(1, |&(every, _)| every);
        self.stats.submits += 1;
        self.stats.rounds.push(Round {
            inserted: read.inserted - before.inserted,
            active: self.active(),
            flips: read.flips_23 + read.flips_32 - before.flips_23 - before.flips_32,
            iterations: used,
            milliseconds: self.round_clock.lap() * 1e3,
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
        if std::mem::take(&mut self.first) {
            self.write_control();
            self.memory.buffers.record_clear(&mut recorder);
            recorder.stage("locate");
            recorder.dispatch(&self.kernels.fill_free, &self.memory.fill_free, workgroups);
            self.kernels.insert.record_first(&mut recorder, &self.memory.insert, workgroups);
        } else {
            let waiting = self.waiting();
            self.params.entries_before = self.params.entries;
            // Compacting the list costs about as much as walking it a few times.
            if waiting < self.params.entries / 4 * 3 {
                let (entries, bound) = (self.params.entries, &self.memory.relocate);
                self.kernels.relocate.record_compaction(gpu, &mut recorder, bound, entries, workgroups);
                self.params.entries = waiting;
            }
            self.counters.overflow = 0;
            self.write_control();
        }
        let Memory { buffers, insert, .. } = &self.memory;
        self.kernels.insert.record(&mut recorder, insert, buffers, workgroups);
        if !(self.settings.insert_all && inserts) {
            self.record_flips(&mut recorder);
        }
        if inserts {
            self.kernels.relocate.record(&mut recorder, &self.memory.relocate, workgroups);
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

    /// Parameters as the host knows them, counters as they were last read: no kernel runs between.
    fn write_control(&mut self) {
        self.memory.buffers.control.write(self.gpu, 0, bytemuck::cast_slice(&[self.params]));
        self.memory.buffers.control.write(self.gpu, PARAM_WORDS, bytemuck::cast_slice(&[self.counters]));
    }

    fn workgroups(&self) -> u32 {
        let most = self.settings.workgroups.min(self.gpu.max_workgroups());
        workgroups(self.params.blocks.saturating_mul(BLOCK)).min(most)
    }

    fn record_flips(&mut self, recorder: &mut Recorder<'_>) {
        let workgroups = self.workgroups();
        let (kernels, bound, exact_every) = (&self.kernels.flip, &self.memory.flip, self.exact_every);
        let compacts = self.settings.slots_per_active > 0;
        self.iterations.record(
            recorder,
            self.params.bid_bits,
            |recorder, iterations| kernels.record(recorder, bound, iterations, exact_every, compacts, workgroups),
            |recorder| kernels.record_clear_votes(recorder, bound, workgroups),
        );
    }

    /// More slots in the tail.
    fn grow(&mut self, recorder: &mut Recorder<'_>) -> Result<(), Error> {
        let before = self.params.blocks;
        let more = tail_blocks(self.params.infinite, &self.settings);
        let blocks = before.saturating_add(more).min((1 << 30) / BLOCK - 1);
        if blocks == before {
            return Err(Error::TooManyTetrahedra { limit: 1 << 30 });
        }
        let (bytes, limit) = (largest_bytes(blocks), self.gpu.max_storage_bytes());
        if bytes > limit.into() {
            // Points that lie like these.
            let points = u128::from(self.params.infinite) * u128::from(limit) / bytes;
            return Err(Error::BufferTooLarge { label: "tetrahedra", bytes, limit, points: Some(points as usize) });
        }
        self.memory = self.memory.with_blocks(self.kernels, self.gpu, recorder, blocks)?;
        (self.params.blocks_before, self.params.blocks) = (before, blocks);
        self.params.bid_bits = bid_bits(blocks);
        recorder.stage("grow");
        recorder.dispatch(&self.kernels.fill_free, &self.memory.fill_free, self.workgroups());
        // Bids have another form now.
        self.kernels.flip.record_clear_votes(recorder, &self.memory.flip, self.workgroups());
        self.iterations.restart();
        Ok(())
    }

    /// Finds the failed vertices, and reads the mesh back.
    ///
    /// # Errors
    ///
    /// As [`Run::round`].
    pub async fn finish(mut self) -> Result<Phase1Output, Error> {
        let gpu = self.gpu;
        let blocks = self.params.blocks;
        let workgroups = self.workgroups();
        let profiler = self.profiler.take();
        let (submission, counters, finite) = gpu
            .with_error_scope("the end of Phase 1", || {
                let mut recorder = Recorder::new(gpu, profiler);
                let bound = &self.memory.finish;
                self.kernels.finish.record(gpu, &mut recorder, bound, blocks, workgroups);
                self.stats.dispatches += recorder.dispatches();
                let encoder = recorder.encoder();
                let finite = self.kernels.readback.copy(gpu, encoder, &bound.sums, BoundFinish::FINITE, 1);
                let counters = self.read_counters(encoder);
                Ok((recorder.submit(gpu), counters, finite))
            })
            .await?;
        let counters = self.kernels.readback.receive(gpu, &submission, counters).await?;
        let finite = self.kernels.readback.receive(gpu, &submission, finite).await?[0] as usize;
        let mut read = Counters::zeroed();
        bytemuck::bytes_of_mut(&mut read).copy_from_slice(bytemuck::cast_slice(&counters));
        self.counters = read;
        self.stats.milliseconds = self.clock.lap() * 1e3;

        let Run { kernels, params, counters, points, memory, read_before, mut stats, mut clock, .. } = self;
        let count = params.infinite as usize;
        let tets = finite + counters.ghosts as usize;
        let aside = if counters.merged > 0 { count } else { 0 };
        let readback = &mut kernels.readback;
        let (first, tets, submission, neighbors, tet_of, failed, merged, uncertain) = gpu
            .with_error_scope("the result of Phase 1", || {
                // The host takes the first part while the device sends the second.
                let bound = &memory.finish;
                let mut recorder = Recorder::new(gpu, None);
                let tets_read = readback.copy(gpu, recorder.encoder(), &bound.tets, 0, tets);
                let first = recorder.submit(gpu);
                let mut recorder = Recorder::new(gpu, None);
                let encoder = recorder.encoder();
                let neighbors = readback.copy(gpu, encoder, &bound.neighbors, 0, tets);
                let tet_of = readback.copy(gpu, encoder, &bound.tet_of, 0, count + 1);
                let failed = readback.copy(gpu, encoder, &bound.failed, 0, counters.failed as usize);
                let merged = readback.copy(gpu, encoder, &memory.buffers.points.merged_into, 0, aside);
                let uncertain = readback.copy(gpu, encoder, &bound.uncertain, 0, counters.uncertain as usize);
                Ok((first, tets_read, recorder.submit(gpu), neighbors, tet_of, failed, merged, uncertain))
            })
            .await?;
        let tets = readback.receive(gpu, &first, tets).await?;
        let neighbors = readback.receive(gpu, &submission, neighbors).await?;
        let mut tet_of = readback.receive(gpu, &submission, tet_of).await?;
        let mut failed = readback.receive(gpu, &submission, failed).await?;
        let merged = readback.receive(gpu, &submission, merged).await?;
        let uncertain = readback.receive(gpu, &submission, uncertain).await?;

        tet_of.iter_mut().for_each(|t: &mut u32| *t = t.wrapping_sub(1));
        failed.sort_unstable();
        let mut uncertain: Vec<[u32; 2]> = uncertain.into_iter().map(|a| [a.tet, a.outcome]).collect();
        uncertain.sort_unstable();
        stats.readback_milliseconds = clock.lap() * 1e3;
        stats.counters = counters;
        stats.submits += 2;
        stats.readbacks = readback.count() - read_before;
        stats.bytes = memory.bytes() + points.as_ref().map_or(0, PointBuffers::bytes);
        kernels.kept = Kept { points, memory: Some(memory) };
        Ok(Phase1Output {
            tets,
            neighbors,
            finite,
            failed,
            tet_of,
            merged: (0..)
                .zip(merged)
                .filter(|&(_, other)| other != NONE)
                .map(|(point, other)| [point, other])
                .collect(),
            uncertain,
            stats,
        })
    }
}
