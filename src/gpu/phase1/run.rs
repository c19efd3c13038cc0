//! A run of Phase 1: what the host records ahead, and what it reads back.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Pending, Profiler, Recorder, Room,
        device_mesh::DeviceMesh,
        dim::{Corners, Dim, Flip},
        iterations::{Iterations, Known, Needed},
        layout::{BLOCK, COUNTER_WORDS, Counters, DONE, LOGGED, NONE, PARAM_WORDS, Params, SLOT_SHIFT, SLOTS_FULL},
        parts,
        phase1::{
            buffers::{Buffers, Sizes, largest_bytes},
            finish::{self, Copies, Finish},
            kernels::Phase1,
            memory::{Kept, Memory},
            round::Round as RoundPlan,
            settings::Settings,
            stages::Stage,
            stats::Phase1Stats,
        },
        points::{PointBuffers, PointInput},
        primitives::scan::GROUPS,
        start::{Start, StartMesh},
    },
    input::{lattice::Lattice, points::Points},
    options::Winding,
    parallel::{self, Threads},
    stats::{Round, Stopwatch},
};
use std::collections::VecDeque;

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
    /// Whether as a rule no points are inserted, because [`Run::take`] comes next: then what they
    /// would be inserted into is made only by [`Run::forget`].
    pub starts_later: bool,
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
    host: <Dimension<D> as Finish<D>>::Host,
    first: Start<D>,
    start: StartMesh,
    /// Whether there is a triangulation of all points on the device, so that no round inserts any.
    has_moved: bool,
    /// Readbacks before this run, and their bytes.
    read_before: (usize, u64),
    /// Batches of rounds whose counters are not read yet, oldest first.
    submitted: VecDeque<Batch>,
    /// About the most points that can be inserted after the rounds that were submitted.
    inserted_at_most: u32,
    /// The rounds that were submitted.
    rounds_submitted: u32,
    /// Whether facets are to be removed in the next one.
    removes: bool,
    /// Those of them that were submitted before slots were added.
    rounds_before_growth: u32,
    iterations: Iterations,
    /// What the run before that inserted as many points needed.
    before: Needed,
    /// Memory for the simplices and their neighbours, if the host is to have them.
    rooms: Rooms<D>,
    stats: Phase1Stats,
    clock: Stopwatch,
    round_clock: Stopwatch,
}

/// Memory for the simplices of a mesh, and for their neighbours.
type Rooms<const D: usize> = [Option<Room<Corners<D>>>; 2];

/// Rounds that were submitted together.
struct Batch {
    submission: wgpu::SubmissionIndex,
    counters: Pending<u32>,
    /// The flip iterations that were recorded for each round, a dispatch per pass.
    recorded: Vec<u32>,
    /// Whether facets are removed in one of the rounds if nothing else is left to do.
    removes: bool,
}

/// How many points a round inserts per point that is inserted, as a rule at most: hardly more of
/// its simplices have points to pick from.
const GROWTH: u32 = 5;

/// Flip iterations are done in one workgroup until this many times as many simplices are active as
/// when it begins with that.
const FEW_LIMIT: u32 = 4;

/// The most flip iterations that one workgroup does in a dispatch: more than a round of an ordinary
/// input takes, and so few that a run is not far beyond them when it is found to be slow.
const FEW_ITERATIONS: u32 = 128;

/// The flip iterations that are recorded at first where points have moved, a dispatch per pass: a
/// million points that moved by a five-hundredth of their spacing take so many.
const MOVED_ITERATIONS: u32 = 12;

/// Votes are cleared when the lowest bid is so high: a quarter of the numbers that are left by then
/// suffices for all rounds that may be submitted before.
const CLEAR_VOTES_FROM: u32 = 1 << 30;

/// The status of a simplex has 30 bits for the number of a node, plus 1.
const MAX_NODES: u64 = (1 << 30) - 1;

/// Simplices are numbered in 30 bits.
const MAX_SIMPLICES: u32 = 1 << 30;
const _: () = assert!(DONE >> SLOT_SHIFT >= MAX_SIMPLICES, "a flip notes the slot that it gives back");

/// The most unused slots per 1,024 simplices of a mesh that is taken: so few that their product with
/// 1,024 fits 32 bits.
const MAX_SPREAD: u64 = 1 << 20;

/// Nodes of the history, however few the points are.
const MIN_HISTORY: u64 = 64;

/// Returns the largest number of points whose buffers a device can bind.
fn max_points<const D: usize>(limit: u64, settings: &Settings<D>) -> usize
where
    Dimension<D>: Dim<D>,
{
    let fits = |points: &u32| largest_bytes(settings.first_blocks(*points)) <= limit.into();
    let (mut fitting, mut too_many) = (0, Dimension::<D>::MAX_POINTS as u32 + 1);
    while too_many - fitting > 1 {
        let middle = fitting + (too_many - fitting) / 2;
        *(if fits(&middle) { &mut fitting } else { &mut too_many }) = middle;
    }
    fitting as usize
}

/// Returns the counters before the first round, where so many points wait.
fn first_counters(waiting: u32) -> Counters {
    Counters { bid_base: 1, entries: waiting, ..Counters::default() }
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
        let blocks = settings.first_blocks(points);
        let parts = kernels.parts;
        let (bytes, limit) = (largest_bytes(blocks), parts::limit(gpu, parts));
        if bytes > limit.into() {
            let points = Some(max_points(limit, &settings));
            return Err(Error::BufferTooLarge { label: Dimension::<D>::SIMPLICES, bytes, limit, points });
        }
        let bindable = MAX_NODES.min(limit / size_of::<Flip<D>>() as u64);
        let wanted = u64::from(settings.history) * u64::from(points);
        let history = wanted.clamp(MIN_HISTORY, bindable.max(MIN_HISTORY)) as u32;
        // What is kept is lost if the run fails.
        let Kept { points: mut point_buffers, memory: kept, needed, host } = std::mem::take(&mut kernels.kept);
        let before = if needed.points == points { needed } else { Needed::default() };
        let Input { points: input, lattice, start: first, starts_later } = input;
        let start_points = settings.start_points(count);
        let triangulate = || match starts_later {
            true => StartMesh::of_first(&first),
            false => StartMesh::new(input, lattice, &first, start_points),
        };
        let upload = || {
            // The device orders the points while the host makes the other buffers.
            let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
            let input = PointInput { points: input, lattice, sort: settings.sort };
            let device = kernels.points.record(gpu, &mut recorder, &mut point_buffers, input)?;
            let mut words = Vec::new();
            Dimension::<D>::append_vertex(&mut words, lattice.width(), first.interior_point, points, false);
            device.vertices.write(gpu, count * words.len(), &words);
            let dispatches = recorder.dispatches();
            recorder.submit(gpu);
            Ok((
                Memory::new(&kernels.stages, gpu, kept, device, Sizes { blocks, history, start_points, parts })?,
                dispatches,
            ))
        };
        let (mut start, (memory, dispatches)) = gpu
            .with_error_scope("Phase 1", || {
                let (uploaded, start) = parallel::beside(upload, vec![triangulate]);
                Ok((start, uploaded?))
            })
            .await?;
        let start = start.swap_remove(0);
        let blocks = memory.buffers.blocks();
        let few = if kernels.stages.can(Stage::FlipFew) { settings.few } else { 0 };
        Ok(Run {
            gpu,
            settings,
            profiler,
            params: Params {
                infinite: points,
                blocks,
                history,
                few,
                few_limit: few.saturating_mul(FEW_LIMIT),
                few_iterations: FEW_ITERATIONS,
                max_min_active: settings.min_active.min(points >> 4),
                insert_all: u32::from(settings.insert_all),
                pick: settings.pick as u32,
                clockwise: u32::from(settings.winding == Winding::Clockwise),
                start_points: start.points.len() as u32,
                start_simplices: start.simplices.len() as u32,
                start_stride: start.stride(points),
                ..Params::default()
            },
            counters: first_counters(points),
            points: point_buffers,
            memory,
            host,
            read_before: (kernels.readback.count(), kernels.readback.bytes()),
            kernels,
            submitted: VecDeque::new(),
            inserted_at_most: start.points.len() as u32,
            stats: Phase1Stats { start_points: start.points.len(), dispatches, submits: 1, ..Phase1Stats::default() },
            first,
            start,
            has_moved: false,
            rounds_submitted: 0,
            removes: false,
            rounds_before_growth: 0,
            iterations: Iterations::new(Dimension::<D>::FIRST_ITERATIONS, before),
            before,
            rooms: [None, None],
            clock,
            round_clock,
        })
    }

    /// Has threads look for memory for the mesh, which the host is to read, unless that of the lists `used`
    /// will do.
    pub(crate) fn prepare_room(&mut self, used: [Vec<Corners<D>>; 2]) {
        let len = self.params.infinite as usize * Dimension::<D>::MESH_PER_POINT;
        self.rooms = used.map(|used| Room::new(used, len));
    }

    /// Returns the device.
    pub(crate) fn gpu(&self) -> &'a Gpu {
        self.gpu
    }

    /// Returns whether the run goes on from a mesh whose points have moved.
    pub(crate) fn has_moved(&self) -> bool {
        self.has_moved
    }

    /// Takes the memory of the host that the run before left.
    pub(crate) fn take_host(&mut self) -> <Dimension<D> as Finish<D>>::Host {
        std::mem::take(&mut self.host)
    }

    /// Returns the settings.
    pub(crate) fn settings(&self) -> &Settings<D> {
        &self.settings
    }

    /// Returns the buffers, for tests.
    pub fn buffers(&self) -> &Buffers<D> {
        &self.memory.buffers
    }

    /// Returns the parameters, and the counters as they were last read.
    pub fn control(&self) -> (Params, Counters) {
        (self.params, self.counters)
    }

    /// Returns the number of points that are not inserted yet.
    pub fn waiting(&self) -> u32 {
        self.params.infinite - self.counters.inserted - self.counters.merged
    }

    /// Returns the number of active simplices.
    pub fn active(&self) -> u32 {
        self.counters.active()
    }

    /// Takes the simplices of `mesh`, the triangulation of the points where they were, in place of
    /// the rounds that insert points, and finds out what is wrong with them. Returns the number of
    /// those that are not positively oriented, and that of facets that are not locally Delaunay;
    /// `None` if the arrays of the mesh do not fit each other.
    ///
    /// The flips that follow repair what they can. If `flips_at_once`, the first of them are submitted
    /// with it; the device leaves them out beyond [`Limits`](crate::gpu::update::Limits).
    /// [`Run::forget`] has the points inserted instead.
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`].
    pub(crate) async fn take(
        &mut self,
        mesh: &DeviceMesh<D>,
        flips_at_once: bool,
    ) -> Result<Option<[usize; 2]>, Error> {
        let gpu = self.gpu;
        let profiler = self.profiler.take();
        let (simplices, hull) = (mesh.simplex_count(), mesh.hull_count());
        let all = (simplices + hull) as u32;
        let (submission, counters) = gpu
            .with_error_scope("the mesh of points that have moved", || {
                let mut recorder = Recorder::new(gpu, profiler);
                // A sixteenth of the slots is left to flips.
                let blocks = (all + all / 16).div_ceil(BLOCK) + self.settings.tail_blocks(self.params.infinite);
                if D == 3 && blocks > self.params.blocks {
                    self.grow_to(&mut recorder, blocks)?;
                }
                // In 2D, the last slot is never used.
                let free = self.params.blocks * BLOCK - all - 1;
                self.params.blocks_before = 0;
                self.params.moved_simplices = simplices as u32;
                self.params.moved_ghosts = hull as u32;
                [self.params.moved_inverted, self.params.moved_violated] = self.settings.limits.most(simplices as f64);
                self.params.moved_spread = (u64::from(free) * 1024 / u64::from(all.max(1))).min(MAX_SPREAD) as u32;
                let buffers = &self.memory.buffers;
                buffers.control.write(gpu, 0, bytemuck::cast_slice(&[self.params]));
                buffers.control.write(gpu, PARAM_WORDS, bytemuck::cast_slice(&[first_counters(0)]));
                buffers.record_clear(&mut recorder);
                let workgroups = self.workgroups();
                self.memory.bound.record(&mut recorder, Stage::FillFree, workgroups);
                let mut bindings = buffers.bindings();
                bindings.extend([("moved_simplices", mesh.simplices()), ("moved_neighbors", mesh.neighbors())]);
                self.kernels.stages.moved.bind(gpu, &bindings).record(&mut recorder, workgroups);
                self.stats.dispatches += recorder.dispatches();
                self.stats.submits += 1;
                let counters = self.read_counters(recorder.encoder());
                Ok((recorder.submit(gpu), counters))
            })
            .await?;
        self.has_moved = true;
        self.iterations = Iterations::new(MOVED_ITERATIONS, Needed::default());
        self.inserted_at_most = self.params.infinite;
        self.stats.start_points = 0;
        if flips_at_once {
            self.submit().await?;
        }
        let words = self.kernels.readback.receive(gpu, &submission, counters).await?;
        self.counters = counters_in(&words);
        let Counters { inverted, violated, .. } = self.counters;
        Ok((inverted < MAX_SIMPLICES).then_some([inverted as usize, violated as usize]))
    }

    /// Forgets the mesh that was taken: all points of the input wait to be inserted.
    pub(crate) fn forget(&mut self, input: &Input<'_, D>) {
        let Input { points, lattice, start, starts_later, .. } = input;
        let start = match starts_later {
            true => StartMesh::new(*points, lattice, start, self.settings.start_points(points.len())),
            false => std::mem::take(&mut self.start),
        };
        self.begin_with(start);
    }

    /// Has all points of the input wait to be inserted into `start`.
    fn begin_with(&mut self, start: StartMesh) {
        self.has_moved = false;
        self.params = Params {
            moved_simplices: 0,
            moved_ghosts: 0,
            start_points: start.points.len() as u32,
            start_simplices: start.simplices.len() as u32,
            start_stride: start.stride(self.params.infinite),
            ..self.params
        };
        let long_walks = self.counters.long_walks;
        self.counters = Counters { long_walks, ..first_counters(self.params.infinite) };
        self.iterations = Iterations::new(Dimension::<D>::FIRST_ITERATIONS, self.before);
        self.submitted.clear();
        (self.rounds_submitted, self.rounds_before_growth) = (0, 0);
        self.inserted_at_most = self.params.start_points;
        self.stats.rounds.clear();
        self.stats.start_points = start.points.len();
        self.start = start;
    }

    /// Reads the points that are vertices of no simplex, as [`Phase1Output::merged`] has them, after
    /// [`Run::take`].
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`].
    pub(crate) async fn read_merged(&mut self) -> Result<Vec<[u32; 2]>, Error> {
        if self.counters.merged == 0 {
            return Ok(Vec::new());
        }
        let merged_into = &self.memory.buffers.points.merged_into;
        self.stats.submits += 1;
        self.stats.stalls += 1;
        Ok(pairs(self.kernels.readback.read(self.gpu, merged_into, 0, merged_into.len()).await?))
    }

    /// Runs rounds of insertion and flips, and, when all points are inserted, flip iterations,
    /// until it knows of the next batch what was done. Returns whether there is more to do.
    ///
    /// While the device works on a batch, the next one is submitted, so that the device never waits; but not behind
    /// the batch that the run before ended with.
    ///
    /// # Errors
    ///
    /// [`Error::BufferTooLarge`] and [`Error::OutOfDeviceMemory`] when there are more tetrahedra
    /// than the device can hold; [`Error::DeviceLost`] and [`Error::Gpu`].
    pub async fn advance(&mut self) -> Result<bool, Error> {
        // One batch of flips is as a rule enough for points that have moved.
        let batches = if self.has_moved { 1 } else { self.settings.batches.max(1) as usize };
        while self.submitted.len() < batches {
            if !self.submitted.is_empty() && self.iterations.may_be_done(self.rounds_submitted) {
                break;
            }
            self.submit().await?;
        }
        let Some(Batch { submission, counters, recorded, .. }) = self.submitted.pop_front() else {
            return Ok(false);
        };
        let words = self.kernels.readback.receive(self.gpu, &submission, counters).await?;
        let before = std::mem::replace(&mut self.counters, counters_in(&words));
        let read = self.counters;
        let time = self.round_clock.lap() / recorded.len() as u32;
        if read.long_walks > 0 && self.start.points.len() > D + 1 {
            // A point may lie in no simplex of the start, which the host and the device see with
            // different perturbations. It lies in one of those around the first simplex.
            self.begin_with(StartMesh::of_first(&self.first));
            return Ok(true);
        }
        let mut last = before.progress();
        for (round, recorded) in (before.round + 1..).zip(recorded) {
            // The state after the last round of a batch is that which was read.
            let is_last = round == read.round;
            let now = if is_last { read.progress() } else { read.log[round as usize % LOGGED] };
            let [inserted, active, flips, iterations, few] = now;
            let [inserted_before, _, flips_before, iterations_before, few_before] = last;
            let used = iterations - iterations_before;
            self.stats.rounds.push(Round {
                inserted: inserted - inserted_before,
                active,
                flips: flips - flips_before,
                iterations: used,
                time,
            });
            let waiting = self.params.infinite - inserted - read.merged;
            let left = waiting.saturating_mul(D as u32 + 1).saturating_add(active);
            let is_few = left <= self.params.few_limit;
            let few = few - few_before;
            let used = used - few;
            let min_active = self.min_active(inserted_before);
            self.iterations.plan(Known {
                used,
                few,
                recorded,
                active,
                min_active,
                inserted_before,
                inserted,
                waiting,
                is_few,
                removes: is_last && read.removals > before.removals,
            });
            if inserted == inserted_before && inserted + read.merged < self.params.infinite {
                return Err(Error::Gpu { message: "an insertion round inserted nothing".to_owned() });
            }
            last = now;
        }
        self.iterations.plan_exact(read.exact.wrapping_sub(before.exact), read.visits.wrapping_sub(before.visits));
        let is_done = self.waiting() == 0 && self.active() == 0;
        // What could not be flipped is removed, once.
        let is_to_remove = is_done && self.can_remove() && read.removals == 0;
        self.removes = is_to_remove && !self.submitted.iter().any(|batch| batch.removes);
        let goes_on = !is_done || is_to_remove;
        // When nothing is left, the device waits for the host anyway, which `end` counts.
        self.stats.stalls += usize::from(goes_on && self.submitted.is_empty());
        Ok(goes_on)
    }

    /// Submits a batch.
    async fn submit(&mut self) -> Result<(), Error> {
        let batch = self.gpu.with_error_scope("Phase 1", || self.submit_batch()).await?;
        self.submitted.push_back(batch);
        self.stats.submits += 1;
        Ok(())
    }

    fn submit_batch(&mut self) -> Result<Batch, Error> {
        let gpu = self.gpu;
        let mut profiler = self.profiler.take();
        let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
        if self.rounds_submitted == 0 && !self.has_moved {
            self.memory.buffers.control.write(gpu, 0, bytemuck::cast_slice(&[self.params]));
            let (inserted, active) = (self.params.start_points, self.params.start_simplices);
            let counters = Counters { inserted, active_len: [active, 0], ..self.counters };
            self.memory.buffers.control.write(gpu, PARAM_WORDS, bytemuck::cast_slice(&[counters]));
            self.memory.buffers.start_points.write(gpu, 0, &self.start.points);
            self.memory.buffers.start_simplices.write(gpu, 0, &self.start.simplices);
            self.memory.buffers.record_clear(&mut recorder);
            let (bound, workgroups) = (&self.memory.bound, self.workgroups());
            bound.record(&mut recorder, Stage::FillFree, workgroups);
            bound.record(&mut recorder, Stage::Start, workgroups);
        } else {
            // Rounds that were submitted before the slots were added can say that there were too
            // few.
            if self.counters.overflow & SLOTS_FULL != 0 && self.counters.round > self.rounds_before_growth {
                self.grow(&mut recorder)?;
            }
            if self.counters.bid_base > CLEAR_VOTES_FROM {
                self.memory.bound.record(&mut recorder, Stage::ClearVotes, self.workgroups());
            }
        }
        let (mut recorded, mut goes_on, mut removes_any) = (Vec::new(), true, false);
        let limit = (self.settings.rounds as usize).clamp(1, LOGGED);
        while recorded.len() < limit || (self.settings.batches > 1 && goes_on && recorded.len() < LOGGED) {
            // All flips of the first rounds of few points are few.
            let active = self.inserted_at_most.saturating_mul(GROWTH * (D as u32 + 1));
            let are_few = active <= self.params.few_limit;
            goes_on = are_few || self.iterations.flips_wait(self.rounds_submitted);
            let iterations = if are_few { 0 } else { self.iterations.planned(self.rounds_submitted) };
            self.inserted_at_most = self.inserted_at_most.saturating_mul(1 + GROWTH);
            let removes = std::mem::take(&mut self.removes)
                || (self.can_remove() && self.iterations.removes(self.rounds_submitted));
            removes_any |= removes;
            self.record_round(&mut recorder, iterations, removes);
            self.rounds_submitted += 1;
            recorded.push(iterations);
        }
        self.stats.dispatches += recorder.dispatches();
        let counters = self.read_counters(recorder.encoder());
        let submission = recorder.submit(gpu);
        self.profiler = profiler;
        Ok(Batch { submission, counters, recorded, removes: removes_any })
    }

    /// Returns whether the run can remove facets that could not be flipped.
    fn can_remove(&self) -> bool {
        self.settings.removes && !self.has_moved && self.kernels.stages.can(Stage::Remove)
    }

    /// Records a round, in which facets are removed if nothing else is left to do.
    fn record_round(&self, recorder: &mut Recorder<'_>, iterations: u32, removes: bool) {
        let Memory { buffers, bound } = &self.memory;
        let workgroups = self.workgroups();
        let round = RoundPlan {
            has_moved: self.has_moved,
            removes,
            iterations,
            exact_every: self.iterations.exact_every(),
            takes_few: self.params.few > 0 && self.iterations.may_be_few(self.rounds_submitted),
        };
        if !self.has_moved {
            buffers.messages.record_clear(recorder.encoder());
        }
        round.stages().into_iter().for_each(|stage| bound.record(recorder, stage, workgroups));
    }

    /// Returns with fewer than how many active simplices the iterations of a round end that begins with so many
    /// points inserted.
    fn min_active(&self, inserted: u32) -> u32 {
        let waits = inserted + self.counters.merged < self.params.infinite;
        let min_active = if waits { self.counters.min_active(&self.params, inserted) } else { 0 };
        min_active.max(self.params.few.saturating_add(1))
    }

    fn read_counters(&mut self, encoder: &mut wgpu::CommandEncoder) -> Pending<u32> {
        let control = &self.memory.buffers.control;
        self.kernels.readback.copy(self.gpu, encoder, control, PARAM_WORDS, COUNTER_WORDS)
    }

    /// Returns the workgroups of a kernel with an invocation per slot.
    pub(crate) fn workgroups(&self) -> u32 {
        let slots = self.params.blocks.saturating_mul(BLOCK);
        self.gpu.workgroups(slots as usize).min(self.settings.workgroups)
    }

    /// Adds slots to the tail.
    fn grow(&mut self, recorder: &mut Recorder<'_>) -> Result<(), Error> {
        let more = self.settings.tail_blocks(self.params.infinite);
        self.grow_to(recorder, self.params.blocks.saturating_add(more))
    }

    /// Adds slots to the tail, so that there are so many blocks.
    fn grow_to(&mut self, recorder: &mut Recorder<'_>, blocks: u32) -> Result<(), Error> {
        let before = self.params.blocks;
        let blocks = blocks.min(MAX_SIMPLICES / BLOCK - 1);
        if blocks <= before {
            return Err(Error::TooManySimplices { limit: MAX_SIMPLICES as usize });
        }
        let parts = self.kernels.parts;
        let (bytes, limit) = (largest_bytes(blocks), parts::limit(self.gpu, parts));
        if bytes > limit.into() {
            // Points that lie like these.
            let points = u128::from(self.params.infinite) * u128::from(limit) / bytes;
            let points = Some(points as usize);
            return Err(Error::BufferTooLarge { label: Dimension::<D>::SIMPLICES, bytes, limit, points });
        }
        let stages = &self.kernels.stages;
        self.memory = self.memory.with_blocks(stages, self.gpu, recorder, blocks, parts)?;
        (self.params.blocks_before, self.params.blocks) = (before, blocks);
        self.rounds_before_growth = self.rounds_submitted;
        self.memory.buffers.control.write(self.gpu, 0, bytemuck::cast_slice(&[self.params]));
        self.memory.bound.record(recorder, Stage::FillFree, self.workgroups());
        Ok(())
    }

    /// Returns what the next run that inserts as many points is to know.
    fn needed(&self) -> Needed {
        if self.has_moved { self.before } else { self.iterations.needed(self.params.infinite) }
    }

    /// Ends the run without a mesh, and keeps its buffers for the next one. Returns what it did as
    /// far as that is known.
    pub fn abandon(self) -> Phase1Stats {
        let needed = self.needed();
        let Run { kernels, points, memory, host, read_before, counters, mut stats, mut clock, .. } = self;
        stats.time = clock.lap();
        stats.counters = counters;
        stats.readbacks = kernels.readback.count() - read_before.0;
        stats.bytes_read = kernels.readback.bytes() - read_before.1;
        stats.bytes = memory.bytes() + points.as_ref().map_or(0, PointBuffers::bytes);
        kernels.kept = Kept { points, memory: Some(memory), needed, host };
        stats
    }

    /// Makes the mesh and reads it back.
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`].
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
    /// Those of [`Run::advance`].
    pub(crate) async fn end<T, U>(
        mut self,
        more: impl FnOnce(&mut Copies<'_>, &Memory<D>) -> T,
        meanwhile: impl FnOnce() -> U,
    ) -> Result<(Ended<'a, D>, wgpu::SubmissionIndex, T, U), Error> {
        let gpu = self.gpu;
        let workgroups = self.workgroups();
        let profiler = self.profiler.take();
        let is_merged = self.counters.merged > 0;
        let (submission, counters, finite, merged, more) = gpu
            .with_error_scope("the end of Phase 1", || {
                let (memory, readback) = (&self.memory, &mut self.kernels.readback);
                let mut copies = Copies { readback, gpu, recorder: Recorder::new(gpu, profiler) };
                memory.bound.record_end(&mut copies.recorder, workgroups);
                let more = more(&mut copies, memory);
                let finite = copies.copy_from(memory.bound.sums(), GROUPS, 1);
                let counters = copies.copy_from(&memory.buffers.control, PARAM_WORDS, COUNTER_WORDS);
                let merged_into = &memory.buffers.points.merged_into;
                let merged = is_merged.then(|| copies.copy(merged_into, merged_into.len()));
                self.stats.dispatches += copies.recorder.dispatches();
                self.stats.submits += 1;
                Ok((copies.recorder.submit(gpu), counters, finite, merged, more))
            })
            .await?;
        let prepared = meanwhile();
        // What was submitted beyond the end had nothing to do, and came before.
        for Batch { submission, counters, .. } in std::mem::take(&mut self.submitted) {
            self.kernels.readback.receive(gpu, &submission, counters).await?;
        }
        self.stats.stalls += 1;
        let words = self.kernels.readback.receive(gpu, &submission, counters).await?;
        let finite = self.kernels.readback.receive(gpu, &submission, finite).await?[0] as usize;
        let counters = counters_in(&words);
        debug_assert_eq!(is_merged, counters.merged > 0, "points are merged before the first round");
        self.stats.time = self.clock.lap();
        self.stats.counters = counters;
        let needed = self.needed();
        let ended = Ended {
            gpu,
            needed,
            counters,
            finite,
            merging: merged.map(|merged| (submission.clone(), merged)),
            merged: Vec::new(),
            workgroups,
            kernels: self.kernels,
            memory: self.memory,
            host: self.host,
            points: self.points,
            rooms: self.rooms,
            read_before: self.read_before,
            stats: self.stats,
            clock: self.clock,
        };
        Ok((ended, submission, more, prepared))
    }
}

/// A run that has made the mesh, which is still on the device.
pub struct Ended<'a, const D: usize>
where
    Dimension<D>: Finish<D>,
{
    pub(crate) kernels: &'a mut Phase1<D>,
    pub(crate) gpu: &'a Gpu,
    pub(crate) memory: Memory<D>,
    /// The memory of the host that the next run gets.
    pub(crate) host: <Dimension<D> as Finish<D>>::Host,
    points: Option<PointBuffers>,
    needed: Needed,
    pub(crate) counters: Counters,
    /// The number of finite simplices.
    pub(crate) finite: usize,
    /// Which points are merged into others, if any are and nobody has asked yet.
    merging: Option<(wgpu::SubmissionIndex, Pending<u32>)>,
    /// The same, since somebody has asked.
    merged: Vec<[u32; 2]>,
    pub(crate) workgroups: u32,
    rooms: Rooms<D>,
    read_before: (usize, u64),
    pub(crate) stats: Phase1Stats,
    clock: Stopwatch,
}

impl<'a, const D: usize> Ended<'a, D>
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
    /// Those of [`Run::advance`].
    pub(crate) async fn read(&mut self) -> Result<(<Dimension<D> as Finish<D>>::Result, Vec<[u32; 2]>), Error> {
        let (readback, memory) = (&mut self.kernels.readback, &self.memory);
        self.clock.lap();
        let rooms = take_rooms(&mut self.rooms);
        let (result, submissions) =
            finish::read(self.gpu, readback, memory, self.finite, &self.counters, rooms).await?;
        let merged = self.read_merged().await?;
        self.stats.readback_time += self.clock.lap();
        self.stats.submits += submissions;
        self.stats.stalls += finish::STALLS;
        Ok((result, merged))
    }

    /// Reads the points that are vertices of no simplex.
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`].
    pub(crate) async fn read_merged(&mut self) -> Result<Vec<[u32; 2]>, Error> {
        if let Some((submission, merged)) = self.merging.take() {
            self.merged = pairs(self.kernels.readback.receive(self.gpu, &submission, merged).await?);
        }
        Ok(self.merged.clone())
    }

    /// Keeps the buffers for the next run. Returns what this one did.
    pub(crate) fn release(self) -> Phase1Stats {
        let Ended { kernels, points, memory, host, needed, read_before, mut stats, .. } = self;
        stats.readbacks = kernels.readback.count() - read_before.0;
        stats.bytes_read = kernels.readback.bytes() - read_before.1;
        stats.bytes = memory.bytes() + points.as_ref().map_or(0, PointBuffers::bytes);
        kernels.kept = Kept { points, memory: Some(memory), needed, host };
        stats
    }
}

/// Returns the memory that there is for the simplices and for their neighbours by now.
fn take_rooms<const D: usize>(rooms: &mut Rooms<D>) -> [Vec<Corners<D>>; 2]
where
    Dimension<D>: Dim<D>,
{
    std::mem::take(rooms).map(|room| room.map_or_else(Vec::new, Room::take))
}

/// Returns the points that are merged into others, each with the other one.
fn pairs(merged_into: Vec<u32>) -> Vec<[u32; 2]> {
    parallel::joined(parallel::map_ranges(Threads::All, merged_into.len(), |range| {
        let merged = range.filter(|&point| merged_into[point] != NONE);
        merged.map(|point| [point as u32, merged_into[point]]).collect::<Vec<_>>()
    }))
}

impl<const D: usize> Phase1<D>
where
    Dimension<D>: Finish<D>,
{
    /// Runs Phase 1.
    ///
    /// # Errors
    ///
    /// Those of [`Run::new`], [`Run::advance`] and [`Run::finish`].
    pub async fn run(
        &mut self,
        gpu: &Gpu,
        input: Input<'_, D>,
        settings: &Settings<D>,
        profiler: Option<&mut Profiler>,
    ) -> Result<Phase1Output<D>, Error> {
        let mut run = Run::new(self, gpu, input, *settings, profiler).await?;
        while run.advance().await? {}
        run.finish().await
    }
}
