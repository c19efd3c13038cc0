//! A run: what the host records, and what it reads back.

use crate::d2::gpu::{
    buffers::Buffers,
    kernels::{Bound, Kernels},
    layout::{EdgeFlip, PLANE_BLOCK, UncertainTest, blocks},
    phase1::{Input, Mesh, Plane, PlaneOutput, PlaneStats, Settings},
    vertex,
};
use crate::{
    Error,
    gpu::{
        Gpu, Pending, Profiler, Readback, Recorder,
        iterations::{Iterations, bid_bits},
        layout::{BLOCK, COUNTER_WORDS, Counters, NONE, PARAM_WORDS, Params},
        points::{DevicePoints, PointBuffers, PointInput},
        workgroups,
    },
    stats::{Round, Stopwatch},
};

/// What a run holds on the device.
#[derive(Debug)]
struct Memory {
    buffers: Buffers,
    bound: Bound,
}

/// What a run leaves to the next one with as many points of the same precision.
#[derive(Debug, Default)]
pub(crate) struct Kept {
    points: Option<PointBuffers>,
    memory: Option<Memory>,
}

impl Memory {
    /// What is kept, if it is for these points, else all of it anew.
    fn new(
        kernels: &Kernels,
        gpu: &Gpu,
        kept: Option<Memory>,
        points: DevicePoints,
        history: u32,
    ) -> Result<Self, Error> {
        let fits =
            |b: &Buffers| b.points.vertices.buffer() == points.vertices.buffer() && b.history.len() == history as usize;
        match kept {
            Some(memory) if fits(&memory.buffers) => Ok(memory),
            _ => {
                let buffers = Buffers::new(gpu, points, history)?;
                Ok(Memory { bound: kernels.bind(gpu, &buffers)?, buffers })
            }
        }
    }
}

/// A run that is under way.
pub struct Run<'a> {
    plane: &'a mut Plane,
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
    stats: PlaneStats,
    clock: Stopwatch,
    round_clock: Stopwatch,
}

impl<'a> Run<'a> {
    /// The most points: triangles are numbered in 30 bits, and there are two slots a point and some.
    pub const MAX_POINTS: usize = 500_000_000;

    /// Uploads the points and records their ordering.
    ///
    /// # Errors
    ///
    /// [`Error::TooManyPoints`]; [`Error::BufferTooLarge`] and [`Error::OutOfDeviceMemory`] when the device cannot hold
    /// the buffers.
    pub async fn new(
        plane: &'a mut Plane,
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
        // The buffers of the slots are the largest.
        let slot = size_of::<[u32; 4]>() as u64;
        let (bytes, limit) = (slot * u64::from(blocks(points) * BLOCK), gpu.max_storage_bytes());
        if bytes > limit {
            let fitting = (limit / slot).saturating_sub(2 * u64::from(BLOCK)) / u64::from(PLANE_BLOCK);
            let points = Some(fitting as usize);
            return Err(Error::BufferTooLarge { label: "triangles", bytes: bytes.into(), limit, points });
        }
        let bindable = gpu.max_storage_bytes() / size_of::<EdgeFlip>() as u64;
        let history = (u64::from(settings.history) * u64::from(points)).clamp(64, bindable.max(64)) as u32;
        // What is kept is lost if the run fails.
        let Kept { points: mut point_buffers, memory: kept } = std::mem::take(&mut plane.kept);
        let (memory, dispatches) = gpu
            .with_error_scope("the plane", || {
                // The device orders the points while the host makes the other buffers.
                let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
                let Input { points: input, lattice, start } = input;
                let wanted = [start.first[0], start.first[1], start.first[2], start.first[2]];
                let buffers = &mut point_buffers;
                let device = plane.points.record(
                    gpu,
                    &mut recorder,
                    buffers,
                    PointInput { points: input, lattice, wanted, sort: settings.sort },
                )?;
                let mut kernel_point = Vec::new();
                vertex::append_words(&mut kernel_point, lattice.width(), start.interior_point, false);
                device.vertices.write(gpu, count * kernel_point.len(), &kernel_point);
                let dispatches = recorder.dispatches();
                recorder.submit(gpu);
                Ok((Memory::new(&plane.kernels, gpu, kept, device, history)?, dispatches))
            })
            .await?;
        let blocks = blocks(points);
        Ok(Run {
            gpu,
            settings,
            profiler,
            params: Params {
                infinite: points,
                blocks,
                history,
                bid_bits: bid_bits(blocks),
                pick: settings.pick as u32,
                entries: points,
                ..Params::default()
            },
            counters: Counters { first_node: 1, next_node: 1, ..Counters::default() },
            points: point_buffers,
            memory,
            read_before: plane.readback.count(),
            plane,
            first: true,
            iterations: Iterations::new(),
            stats: PlaneStats { dispatches, submits: 1, ..PlaneStats::default() },
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

    /// Active triangles.
    pub fn active(&self) -> u32 {
        self.counters.active_len[(self.counters.iteration & 1) as usize]
    }

    /// Runs an insertion round, or, when all points are inserted, flip iterations. Returns whether there is more to do.
    ///
    /// # Errors
    ///
    /// [`Error::DeviceLost`] and [`Error::Gpu`].
    pub async fn round(&mut self) -> Result<bool, Error> {
        let gpu = self.gpu;
        let before = self.counters;
        let inserts = self.first || self.waiting() > 0;
        let (submission, pending) = gpu.with_error_scope("the plane", || self.submit_round(inserts)).await?;
        let words = self.plane.readback.receive(gpu, &submission, pending).await?;
        let read: Counters = *bytemuck::from_bytes(bytemuck::cast_slice(&words));
        self.counters = read;
        let used = self.iterations.plan(&before, &read, self.waiting());
        self.stats.submits += 1;
        self.stats.rounds.push(Round {
            inserted: read.inserted - before.inserted,
            active: self.active(),
            flips: read.flips_22 - before.flips_22,
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
        let few = self.settings.min_active.min(self.counters.inserted >> 10);
        self.params.min_active = if inserts { few } else { 0 };
        if std::mem::take(&mut self.first) {
            self.write_control();
            self.memory.buffers.record_clear(&mut recorder);
            self.plane.kernels.record_first(&mut recorder, &self.memory.bound, workgroups);
        } else {
            let waiting = self.waiting();
            self.params.entries_before = self.params.entries;
            // Compacting the list costs about as much as walking it a few times.
            if waiting < self.params.entries / 4 * 3 {
                let entries = self.params.entries;
                self.plane.kernels.record_compaction(gpu, &mut recorder, &self.memory.bound, entries, workgroups);
                self.params.entries = waiting;
            }
            self.counters.overflow = 0;
            self.write_control();
        }
        let Memory { buffers, bound } = &self.memory;
        self.plane.kernels.record_insertion(&mut recorder, bound, buffers, workgroups);
        if !(self.settings.insert_all && inserts) {
            self.record_flips(&mut recorder);
        }
        if inserts {
            self.plane.kernels.record_relocation(&mut recorder, &self.memory.bound, workgroups);
        }
        self.stats.dispatches += recorder.dispatches();
        let pending = self.read_counters(recorder.encoder());
        let submission = recorder.submit(gpu);
        self.profiler = profiler;
        Ok((submission, pending))
    }

    fn read_counters(&mut self, encoder: &mut wgpu::CommandEncoder) -> Pending<u32> {
        let control = &self.memory.buffers.control;
        self.plane.readback.copy(self.gpu, encoder, control, PARAM_WORDS, COUNTER_WORDS)
    }

    /// Parameters as the host knows them, counters as they were last read: no kernel runs between.
    fn write_control(&mut self) {
        self.memory.buffers.control.write(self.gpu, 0, bytemuck::cast_slice(&[self.params]));
        self.memory.buffers.control.write(self.gpu, PARAM_WORDS, bytemuck::cast_slice(&[self.counters]));
    }

    fn workgroups(&self) -> u32 {
        let most = self.settings.workgroups.min(self.gpu.max_workgroups());
        workgroups(self.params.blocks * BLOCK).min(most)
    }

    fn record_flips(&mut self, recorder: &mut Recorder<'_>) {
        let workgroups = self.workgroups();
        let (kernels, bound) = (&self.plane.kernels, &self.memory.bound);
        self.iterations.record(
            recorder,
            self.params.bid_bits,
            |recorder, iterations| kernels.record_flips(recorder, bound, iterations, workgroups),
            |recorder| kernels.record_clear_votes(recorder, bound, workgroups),
        );
    }

    /// Makes the answer and reads it back.
    ///
    /// # Errors
    ///
    /// As [`Run::round`].
    pub async fn finish(mut self) -> Result<PlaneOutput, Error> {
        let gpu = self.gpu;
        let workgroups = self.workgroups();
        let profiler = self.profiler.take();
        let (submission, counters, triangles) = gpu
            .with_error_scope("the end of the plane", || {
                let mut recorder = Recorder::new(gpu, profiler);
                self.plane.kernels.record_mesh(&mut recorder, &self.memory.bound, workgroups);
                self.stats.dispatches += recorder.dispatches();
                let encoder = recorder.encoder();
                let triangles = self.plane.readback.copy(gpu, encoder, self.memory.bound.sums(), Bound::COUNT, 1);
                let counters = self.read_counters(encoder);
                Ok((recorder.submit(gpu), counters, triangles))
            })
            .await?;
        let words = self.plane.readback.receive(gpu, &submission, counters).await?;
        let triangles = self.plane.readback.receive(gpu, &submission, triangles).await?[0] as usize;
        self.counters = *bytemuck::from_bytes(bytemuck::cast_slice(&words));
        self.stats.milliseconds = self.clock.lap() * 1e3;

        let Run { plane, params, counters, points, memory, read_before, mut stats, mut clock, .. } = self;
        let readback = &mut plane.readback;
        let (mesh, questions) = read_answer(gpu, readback, &memory.buffers, triangles, &counters).await?;
        let aside = if counters.merged > 0 { params.infinite as usize } else { 0 };
        let merged = readback.read(gpu, &memory.buffers.points.merged_into, 0, aside).await?;
        stats.readback_milliseconds = clock.lap() * 1e3;
        stats.counters = counters;
        stats.submits += 2;
        stats.readbacks = readback.count() - read_before;
        stats.bytes = memory.buffers.bytes() + memory.bound.bytes() + points.as_ref().map_or(0, PointBuffers::bytes);
        plane.kept = Kept { points, memory: Some(memory) };
        Ok(PlaneOutput {
            mesh,
            questions,
            merged: (0..).zip(merged).filter(|&(_, other)| other != NONE).map(|(i, other)| [i, other]).collect(),
            stats,
        })
    }
}

/// The mesh, and the questions if there was room for them.
async fn read_answer(
    gpu: &Gpu,
    readback: &mut Readback,
    b: &Buffers,
    triangles: usize,
    counters: &Counters,
) -> Result<(Mesh, Option<Vec<UncertainTest>>), Error> {
    let asked = counters.uncertain as usize;
    let has_room = asked <= b.triangles.len();
    let (first, vertices, submission, halfedges, hull, questions) = gpu
        .with_error_scope("the result of the plane", || {
            // The host takes the first part while the device sends the second.
            let mut recorder = Recorder::new(gpu, None);
            let vertices = readback.copy(gpu, recorder.encoder(), &b.messages.seen_as(), 0, triangles);
            let first = recorder.submit(gpu);
            let mut recorder = Recorder::new(gpu, None);
            let encoder = recorder.encoder();
            let halfedges = readback.copy(gpu, encoder, &b.status.seen_as(), 0, triangles);
            let hull = readback.copy(gpu, encoder, &b.waiting.seen_as(), 0, counters.hull as usize);
            let asked = if has_room { asked } else { 0 };
            let questions = readback.copy(gpu, encoder, &b.active.seen_as(), 0, asked);
            Ok((first, vertices, recorder.submit(gpu), halfedges, hull, questions))
        })
        .await?;
    let mesh = Mesh {
        triangles: readback.receive(gpu, &first, vertices).await?,
        halfedges: readback.receive(gpu, &submission, halfedges).await?,
        hull: readback.receive(gpu, &submission, hull).await?,
    };
    let questions = readback.receive(gpu, &submission, questions).await?;
    Ok((mesh, has_room.then_some(questions)))
}
