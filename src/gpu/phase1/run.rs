//! A run of Phase 1: what the host records, and what it reads back.

use bytemuck::Zeroable;

use super::buffers::largest_bytes;
use super::{Buffers, COUNTER_WORDS, Input, PARAM_WORDS, Phase1, Phase1Output, Phase1Stats, Settings};
use crate::{
    Error,
    gpu::{
        Gpu, Pending, Profiler, Readback, Recorder,
        layout::{BLOCK, Counters, FlipNode, NONE, Params, SLOTS_FULL},
        stages::{finish::Compacted, flip::BoundFlip, insert::BoundInsert, relocate::BoundRelocate},
        vertex, workgroups,
    },
    stats::{Round, Stopwatch},
};

/// A run that is under way.
pub struct Run<'a> {
    kernels: &'a Phase1,
    gpu: &'a Gpu,
    settings: Settings,
    profiler: Option<&'a mut Profiler>,
    readback: Readback,
    params: Params,
    counters: Counters,
    buffers: Buffers,
    insert: BoundInsert,
    flip: BoundFlip,
    relocate: BoundRelocate,
    /// Nothing is located yet.
    first: bool,
    /// Flip iterations to record for a round.
    iterations: u32,
    /// An upper bound of the iteration that the kernels count.
    counted: u32,
    stats: Phase1Stats,
    clock: Stopwatch,
    round_clock: Stopwatch,
}

/// The bits of a bidder's number: twice as many as there are slots, because the upper half is for marks.
fn bid_bits(blocks: u32) -> u32 {
    33 - (blocks * BLOCK).leading_zeros()
}

/// The blocks for so many points: theirs, that of infinity, and a tail.
fn first_blocks(points: u32, settings: &Settings) -> u32 {
    points + 1 + tail_blocks(points, settings)
}

/// The most points whose buffers a device can bind.
fn most_points(limit: u64, settings: &Settings) -> usize {
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
        kernels: &'a Phase1,
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
            let points = Some(most_points(limit, &settings));
            return Err(Error::BufferTooLarge { label: "tetrahedra", bytes, limit, points });
        }
        let bindable = gpu.max_storage_bytes() / size_of::<FlipNode>() as u64;
        let params = Params {
            infinite: points,
            blocks,
            history: (u64::from(settings.history) * u64::from(points)).clamp(64, bindable.max(64)) as u32,
            bid_bits: bid_bits(blocks),
            min_active: settings.min_active,
            pick: settings.pick as u32,
            entries: points,
            ..Params::default()
        };
        let mut run = gpu
            .catching("Phase 1", || {
                // The device orders the points while the host makes the other buffers.
                let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
                let Input { points, lattice, start } = input;
                let points = kernels.points.record(gpu, &mut recorder, points, lattice, start.first)?;
                let mut kernel_point = Vec::new();
                vertex::append_words(&mut kernel_point, lattice.width(), start.kernel, params.infinite);
                points.vertices.write(gpu, count * kernel_point.len(), &kernel_point);
                let dispatches = recorder.dispatches();
                recorder.submit(gpu);
                let buffers = Buffers::new(gpu, points, blocks, params.history)?;
                Ok(Run {
                    insert: kernels.insert.bind(gpu, &buffers),
                    flip: kernels.flip.bind(gpu, &buffers),
                    relocate: kernels.relocate.bind(gpu, &buffers)?,
                    kernels,
                    gpu,
                    settings,
                    profiler: None,
                    readback: Readback::default(),
                    params,
                    counters: Counters { first_node: 1, next_node: 1, ..Counters::default() },
                    buffers,
                    first: true,
                    iterations: 20,
                    counted: 0,
                    stats: Phase1Stats { dispatches, submits: 1, ..Phase1Stats::default() },
                    clock,
                    round_clock,
                })
            })
            .await?;
        run.profiler = profiler;
        Ok(run)
    }

    /// The buffers, for tests.
    pub fn buffers(&self) -> &Buffers {
        &self.buffers
    }

    /// The parameters and the counters as of the last round, for tests.
    pub fn control(&self) -> (Params, Counters) {
        (self.params, self.counters)
    }

    /// Points that are not inserted yet.
    pub fn waiting(&self) -> u32 {
        self.params.infinite - self.counters.inserted - self.counters.aside
    }

    /// Active tetrahedra.
    pub fn active(&self) -> u32 {
        self.counters.listed[(self.counters.iteration & 1) as usize]
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
        let (submission, pending) = gpu.catching("Phase 1", || self.submit_round(inserts)).await?;
        let words = self.readback.receive(gpu, &submission, pending).await?;
        let read: Counters = *bytemuck::from_bytes(bytemuck::cast_slice(&words));
        self.counters = read;
        self.counted = read.iteration;
        let used = read.iterations - before.iterations;
        // Rounds grow at first: a flip that waits for the next round costs more than an idle iteration.
        self.iterations = if used >= self.iterations { (2 * used).min(64) } else { (used + used / 2).clamp(20, 64) };
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
        if self.counters.overflow & SLOTS_FULL != 0 {
            self.grow(&mut recorder)?;
        }
        if std::mem::take(&mut self.first) {
            self.write_control();
            let fill = self.kernels.fill_free.bind(gpu, &[self.buffers.control.buffer(), self.buffers.free.buffer()]);
            recorder.stage("locate");
            recorder.dispatch(&self.kernels.fill_free, &fill, workgroups);
            self.kernels.insert.record_first(&mut recorder, &self.insert, workgroups);
        } else {
            let waiting = self.waiting();
            self.params.entries_before = self.params.entries;
            // Compacting the list costs about as much as walking it a few times.
            if waiting < self.params.entries / 4 * 3 {
                let entries = self.params.entries;
                self.kernels.relocate.record_compaction(
                    gpu,
                    &mut recorder,
                    &self.relocate,
                    &self.buffers,
                    entries,
                    workgroups,
                );
                self.params.entries = waiting;
            }
            self.counters.overflow = 0;
            self.write_control();
        }
        self.kernels.insert.record(&mut recorder, &self.insert, &self.buffers, workgroups);
        if !(self.settings.insert_all && inserts) {
            self.record_flips(&mut recorder);
        }
        if inserts {
            self.kernels.relocate.record(&mut recorder, &self.relocate, workgroups);
        }
        self.stats.dispatches += recorder.dispatches();
        let pending = self.readback.copy(gpu, recorder.encoder(), &self.buffers.control, PARAM_WORDS, COUNTER_WORDS);
        let submission = recorder.submit(gpu);
        self.profiler = profiler;
        Ok((submission, pending))
    }

    /// Parameters as the host knows them, counters as they were last read: no kernel runs between.
    fn write_control(&mut self) {
        self.buffers.control.write(self.gpu, 0, bytemuck::cast_slice(&[self.params]));
        self.buffers.control.write(self.gpu, PARAM_WORDS, bytemuck::cast_slice(&[self.counters]));
    }

    fn workgroups(&self) -> u32 {
        workgroups(self.params.blocks.saturating_mul(BLOCK)).min(self.settings.workgroups)
    }

    fn record_flips(&mut self, recorder: &mut Recorder<'_>) {
        let last = (1u32 << (32 - self.params.bid_bits)) - 2;
        let mut left = self.iterations;
        while left > 0 {
            if self.counted >= last {
                self.kernels.flip.record_clear_votes(recorder, &self.flip, self.workgroups());
                self.counted = 1;
            }
            let now = left.min(last - self.counted);
            self.kernels.flip.record(recorder, &self.flip, now, self.workgroups());
            self.counted += now;
            left -= now;
        }
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
        self.buffers = self.buffers.with_blocks(self.gpu, recorder, blocks)?;
        (self.params.blocks_before, self.params.blocks) = (before, blocks);
        self.params.bid_bits = bid_bits(blocks);
        self.insert = self.kernels.insert.bind(self.gpu, &self.buffers);
        self.flip = self.kernels.flip.bind(self.gpu, &self.buffers);
        self.relocate = self.kernels.relocate.bind(self.gpu, &self.buffers)?;
        let (control, free) = (self.buffers.control.buffer(), self.buffers.free.buffer());
        let fill = self.kernels.fill_free.bind(self.gpu, &[control, free]);
        recorder.stage("grow");
        recorder.dispatch(&self.kernels.fill_free, &fill, self.workgroups());
        // Bids have another form now.
        self.kernels.flip.record_clear_votes(recorder, &self.flip, self.workgroups());
        self.counted = 1;
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
        let (compacted, submission, counters, count) = gpu
            .catching("the end of Phase 1", || {
                let mut recorder = Recorder::new(gpu, profiler);
                let compacted = self.kernels.finish.record(gpu, &mut recorder, &self.buffers, blocks, workgroups)?;
                self.stats.dispatches += recorder.dispatches();
                let encoder = recorder.encoder();
                let counters = self.readback.copy(gpu, encoder, &self.buffers.control, PARAM_WORDS, COUNTER_WORDS);
                let count = self.readback.copy(gpu, encoder, &compacted.sums, Compacted::COUNT, 1);
                Ok((compacted, recorder.submit(gpu), counters, count))
            })
            .await?;
        let counters = self.readback.receive(gpu, &submission, counters).await?;
        let count = self.readback.receive(gpu, &submission, count).await?[0] as usize;
        let mut read = Counters::zeroed();
        bytemuck::bytes_of_mut(&mut read).copy_from_slice(bytemuck::cast_slice(&counters));
        self.counters = read;
        self.stats.milliseconds = self.clock.lap() * 1e3;

        let points = self.params.infinite as usize;
        let aside = if self.counters.aside > 0 { points } else { 0 };
        let failed = if self.counters.failed > 0 { points } else { 0 };
        let open = self.counters.uncertain as usize;
        let (submission, tets, neighbors, tet_of, pairs, failed, united, uncertain) = gpu
            .catching("the result of Phase 1", || {
                let mut recorder = Recorder::new(gpu, None);
                let encoder = recorder.encoder();
                let tets = self.readback.copy(gpu, encoder, &compacted.tets, 0, count);
                let neighbors = self.readback.copy(gpu, encoder, &compacted.neighbors, 0, count);
                let tet_of = self.readback.copy(gpu, encoder, &compacted.tet_of, 0, points + 1);
                let pairs = self.readback.copy(gpu, encoder, &self.buffers.points.pairs, 0, points);
                let failed = self.readback.copy(gpu, encoder, &self.buffers.failed, 0, failed);
                let united = self.readback.copy(gpu, encoder, &self.buffers.points.united_with, 0, aside);
                let uncertain = self.readback.copy(gpu, encoder, &compacted.uncertain, 0, open);
                Ok((recorder.submit(gpu), tets, neighbors, tet_of, pairs, failed, united, uncertain))
            })
            .await?;
        let tets = self.readback.receive(gpu, &submission, tets).await?;
        let neighbors = self.readback.receive(gpu, &submission, neighbors).await?;
        let tet_of = self.readback.receive(gpu, &submission, tet_of).await?;
        let pairs = self.readback.receive(gpu, &submission, pairs).await?;
        let failed = self.readback.receive(gpu, &submission, failed).await?;
        let united = self.readback.receive(gpu, &submission, united).await?;

        let uncertain = self.readback.receive(gpu, &submission, uncertain).await?;
        let mut uncertain: Vec<[u32; 2]> = uncertain.into_iter().map(|a| [a.tet, a.outcome]).collect();
        uncertain.sort_unstable();

        let mut stats = self.stats;
        stats.readback_milliseconds = self.clock.lap() * 1e3;
        stats.counters = self.counters;
        stats.submits += 2;
        stats.readbacks = self.readback.count();
        stats.bytes = self.buffers.bytes() + compacted.neighbors.bytes() + 2 * compacted.neighbors.bytes() / 4;
        Ok(Phase1Output {
            tets,
            neighbors,
            order: pairs.into_iter().map(|[_, point]| point).collect(),
            failed: (0..).zip(failed).filter(|&(_, failed)| failed != 0).map(|(v, _)| v).collect(),
            tet_of: tet_of.into_iter().map(|t: u32| t.wrapping_sub(1)).collect(),
            united: (0..)
                .zip(united)
                .filter(|&(_, other)| other != NONE)
                .map(|(point, other)| [point, other])
                .collect(),
            uncertain,
            stats,
        })
    }
}
