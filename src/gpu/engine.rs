//! The GPU engine: Phase 1 on the device, and on the CPU what it leaves open (the paper's §3 and
//! §5.6).
//!
//! `points → lattice → Phase 1 → what it may have missed → mesh`

use std::fmt::Debug;

use crate::{
    backend::Backend,
    cpu::{self, Incremental, MeshOf},
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu,
        device_mesh::{DeviceMesh, MeshArrays},
        dim::{Corners, Dim},
        host::{Answer, Fit, Fitted, Here, Host, Merged, Work},
        mesh_check::{self, Samples, count_vertices, euler2, samples_of},
        phase1::{Begin, Finish, Phase1, Phase1Run, Phase1Stats, Settings, WayToHost},
        progress,
        update::PARTED,
    },
    index::NONE,
    input::{lattice::Width, points::Points},
    mesh::MeshInfo,
    options::Options,
    parallel::{self, Threads},
    platform::{self, gpu::Task},
    stats::{Fallback, Phase, Restart, Stats, Stopwatch, UpdateStats},
};

/// How a dimension's engine completes what Phase 1 leaves.
#[expect(async_fn_in_trait, reason = "only this crate implements it, and no caller is generic over threads")]
pub trait Complete<const D: usize>: Finish<D> + MeshArrays<D> + Answer<D>
where
    Dimension<D>: Finish<D> + MeshArrays<D>,
{
    /// Collects what [`Options::trace`] asks for.
    type Tracer;

    /// Why input without a first simplex is left to the CPU engine.
    const DEGENERATE: Fallback;
    /// The share of a run that the rounds of Phase 1 take, as progress reports it.
    const ROUNDS_SHARE: f64;

    /// Takes the lists of the simplices of the mesh and of their neighbours, for their memory.
    fn take_lists(mesh: &mut MeshOf<D>) -> [Vec<Corners<D>>; 2];

    /// Returns the tracer of a run with these options.
    fn tracer(options: &Options) -> Self::Tracer;

    /// Traces a round.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Readback::read`](crate::gpu::Readback::read).
    async fn trace_round(tracer: &mut Self::Tracer, gpu: &Gpu, run: &Phase1Run<'_, D>) -> Result<(), Error>;

    /// Makes the mesh of what Phase 1 leaves, or says why the CPU engine has to; its statistics are
    /// set by the caller.
    ///
    /// # Errors
    ///
    /// Returns [`Error::Cancelled`], [`Error::OutOfMemory`], and those of the device.
    async fn complete<H: Host<D>>(
        run: Phase1Run<'_, D>,
        near: Near<'_, H, D>,
        tracer: Self::Tracer,
    ) -> Result<Result<MadeMesh<D>, Fallback>, Error>;
}

/// A mesh where the engine has made it.
pub enum MadeMesh<const D: usize>
where
    Dimension<D>: Incremental<D>,
{
    /// In the memory of the host.
    Host(MeshOf<D>),
    /// On the device.
    Device(Box<DeviceMesh<D>>),
}

impl<const D: usize> MadeMesh<D>
where
    Dimension<D>: MeshArrays<D>,
{
    /// Returns the mesh in the memory of the host.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`DeviceMesh::read_vertex_simplex_async`].
    pub(crate) async fn into_host(self) -> Result<MeshOf<D>, Error> {
        match self {
            MadeMesh::Host(mesh) => Ok(mesh),
            MadeMesh::Device(mesh) => mesh.into_host().await,
        }
    }

    pub(crate) fn stats_mut(&mut self) -> &mut Stats {
        match self {
            MadeMesh::Host(mesh) => mesh.stats_mut(),
            MadeMesh::Device(mesh) => mesh.stats_mut(),
        }
    }

    /// Returns the mesh on the device, which is `gpu`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`].
    pub(crate) async fn into_device(self, gpu: &Gpu) -> Result<DeviceMesh<D>, Error> {
        match self {
            MadeMesh::Host(mesh) => DeviceMesh::upload(gpu, mesh).await,
            MadeMesh::Device(mesh) => Ok(*mesh),
        }
    }
}

/// Where a mesh is to be made.
pub enum Destination<'a, const D: usize>
where
    Dimension<D>: Incremental<D>,
{
    /// In the memory of the host: that of the arrays of this mesh, as far as it suffices.
    Host(MeshOf<D>),
    /// On the device. The mesh goes on from that of the points where they were, if there is one and that
    /// pays.
    Device(Option<&'a DeviceMesh<D>>),
}

/// What is known of a mesh whose points have moved.
pub(crate) struct Moved<'a, const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// Its duplicates, each with the vertex that stands for it.
    pub(crate) duplicates: Vec<[u32; 2]>,
    /// The vertices of a simplex that is positively oriented where the points are now.
    pub(crate) spanning: Corners<D>,
    /// Receives what was done.
    pub(crate) update: &'a mut UpdateStats,
}

/// What goes with a run of Phase 1 that is to be completed.
pub struct Near<'a, H, const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// Whoever has the coordinates.
    pub(crate) host: &'a mut H,
    /// The options of the run.
    pub(crate) options: &'a Options,
    /// The name of the adapter.
    pub(crate) adapter: &'a str,
    /// Whether the device makes the arrays of the mesh, which may stay there.
    pub(crate) resident: bool,
    /// For a mesh whose points have moved, what is known of it.
    pub(crate) moved: Option<Moved<'a, D>>,
    /// Receives the statistics.
    pub(crate) stats: &'a mut Stats,
    /// Times the phases.
    pub(crate) stopwatch: &'a mut Stopwatch,
}

impl<H: Host<D>, const D: usize> Near<'_, H, D>
where
    Dimension<D>: Answer<D>,
{
    /// Takes what Phase 1 did into the statistics, at its end.
    pub(crate) fn end_of_phase1(&mut self, phase1: &Phase1Stats) {
        let readback = phase1.readback_time;
        self.stats.gpu = Some(phase1.summary(self.adapter));
        self.stats.phases.push((Phase::Phase1, self.stopwatch.lap().saturating_sub(readback)));
        if !readback.is_zero() {
            self.stats.phases.push((Phase::Readback, readback));
        }
    }

    /// Returns the points that share their place on the lattice with these vertices, for the host.
    pub(crate) fn merged(&mut self, merged: Vec<[u32; 2]>) -> Merged {
        Merged { merged, duplicates: self.moved.as_mut().map(|moved| std::mem::take(&mut moved.duplicates)) }
    }

    /// Notes how many points of a mesh that has moved were inserted.
    pub(crate) fn note_inserted(&mut self, points: usize) {
        if let Some(moved) = &mut self.moved {
            moved.update.inserted = points;
        }
    }
}

/// What a run has come to.
pub enum Outcome<const D: usize>
where
    Dimension<D>: Incremental<D>,
{
    /// The mesh.
    Made(MadeMesh<D>),
    /// The CPU engine has to make the mesh; [`Stats::fallback`] says why, and the others what was done before.
    LeftToCpu(Box<Stats>),
}

/// A device with the kernels of `D` dimensions compiled for it: create one and use it for many
/// inputs.
#[derive(Debug)]
pub struct GpuEngine<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    gpu: Gpu,
    wide: Phase1<D>,
    /// The kernels for points on the narrow lattice, compiled when such points first come, because
    /// compiling takes long.
    narrow: Option<Phase1<D>>,
    /// What compiles these beside other work.
    compiling_narrow: Option<Task<Result<Phase1<D>, Error>>>,
    /// Whether runs take the wide kernels until the narrow ones are compiled, rather than wait.
    compiles_meanwhile: bool,
    /// The kernels for large arrays in parts, for points of one width, since the last input that needed
    /// them.
    in_parts: Option<(Width, Phase1<D>)>,
    settings: Settings<D>,
    /// What the host keeps between runs.
    work: <Dimension<D> as Work<D>>::Work,
}

impl<const D: usize> GpuEngine<D>
where
    Dimension<D>: Complete<D>,
{
    /// Compiles the kernels for `gpu`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`].
    pub async fn new(gpu: Gpu) -> Result<Self, Error> {
        let wide = Phase1::new(&gpu, Width::Wide).await?;
        Ok(GpuEngine {
            gpu,
            wide,
            narrow: None,
            compiling_narrow: None,
            compiles_meanwhile: false,
            in_parts: None,
            settings: Settings::default(),
            work: Default::default(),
        })
    }

    /// Returns when also the kernels are compiled that a first run does without.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Gpu::with_error_scope`].
    pub async fn finish_compiling(&self) -> Result<(), Error> {
        self.wide.finish_compiling(&self.gpu).await?;
        match &self.narrow {
            Some(narrow) => narrow.finish_compiling(&self.gpu).await,
            None => Ok(()),
        }
    }

    /// Makes runs with narrow coordinates take the wide kernels until the narrow ones are compiled, rather than wait.
    pub fn compile_meanwhile(&mut self) {
        self.compiles_meanwhile = true;
    }

    /// Changes the settings for Phase 1, for experiments: they change the time, and not the set of
    /// simplices.
    pub fn set_settings(&mut self, settings: Settings<D>) {
        self.settings = settings;
    }

    /// Returns the device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Triangulates `points`: every engine returns the same set of simplices.
    ///
    /// Input that does not suit a device, because its points lie on a line (2D) or in a plane (3D)
    /// or nearly so, and input for which completing Phase 1 takes too much work, is left to the CPU
    /// engine; [`Stats::fallback`] then says why.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](crate::delaunay3d), and those of the device.
    pub async fn triangulate(&mut self, points: Points<'_, D>, options: &Options) -> Result<MeshOf<D>, Error> {
        let mut mesh = MeshOf::<D>::default();
        self.triangulate_into(points, options, &mut mesh).await?;
        Ok(mesh)
    }

    /// Triangulates `points` into the memory of the arrays of `mesh`, as far as it suffices. After an error
    /// the mesh is empty.
    ///
    /// # Errors
    ///
    /// Those of [`GpuEngine::triangulate`].
    pub async fn triangulate_into(
        &mut self,
        points: Points<'_, D>,
        options: &Options,
        mesh: &mut MeshOf<D>,
    ) -> Result<(), Error> {
        let options = &options.monotone();
        let to = Destination::Host(std::mem::take(mesh));
        *mesh = self.make(points, options, to).await?.into_host().await?;
        options.report(Phase::Finish, 1.0)
    }

    /// Triangulates `points`, and leaves the mesh on the device, or takes it there.
    ///
    /// # Errors
    ///
    /// Those of [`GpuEngine::triangulate`].
    pub async fn triangulate_resident(
        &mut self,
        points: Points<'_, D>,
        options: &Options,
    ) -> Result<DeviceMesh<D>, Error> {
        let options = &options.monotone();
        let mesh = self.make(points, options, Destination::Device(None)).await?.into_device(&self.gpu).await?;
        options.report(Phase::Finish, 1.0)?;
        Ok(mesh)
    }

    /// Triangulates `points`, which are those of `mesh` after they have moved, and leaves the new
    /// mesh on the device, or takes it there.
    ///
    /// # Errors
    ///
    /// Those of [`GpuEngine::triangulate`], and [`Error::PointCount`].
    pub async fn update_resident(
        &mut self,
        mesh: &DeviceMesh<D>,
        points: Points<'_, D>,
        options: &Options,
    ) -> Result<DeviceMesh<D>, Error> {
        let options = &options.monotone();
        let mesh = self.make(points, options, Destination::Device(Some(mesh))).await?.into_device(&self.gpu).await?;
        options.report(Phase::Finish, 1.0)?;
        Ok(mesh)
    }

    /// Triangulates `points`, and leaves the mesh where it is made, which is the destination if that is the
    /// host, or if the device can make it. The last report of progress is the caller's.
    ///
    /// # Errors
    ///
    /// Those of [`GpuEngine::update_resident`].
    pub(crate) async fn make(
        &mut self,
        points: Points<'_, D>,
        options: &Options,
        to: Destination<'_, D>,
    ) -> Result<MadeMesh<D>, Error> {
        let mut host = platform::any_host(Here::new(points, options, std::mem::take(&mut self.work)));
        let outcome = self.drive(&mut host, options, to).await;
        self.work = host.into_work();
        match outcome? {
            Outcome::Made(made) => Ok(made),
            Outcome::LeftToCpu(before) => {
                let mut mesh = cpu::delaunay(points, options)?;
                let stats = mesh.stats_mut();
                (stats.fallback, stats.gpu, stats.update) = (before.fallback, before.gpu, before.update);
                Ok(MadeMesh::Host(mesh))
            }
        }
    }

    /// Drives the device, which makes the mesh of the points that `host` has.
    ///
    /// # Errors
    ///
    /// Those of [`GpuEngine::update_resident`], and of [`Host::ask`].
    pub async fn drive(
        &mut self,
        host: &mut impl Host<D>,
        options: &Options,
        to: Destination<'_, D>,
    ) -> Result<Outcome<D>, Error> {
        let (mut used, moved) = match to {
            Destination::Host(used) => (Some(used), None),
            Destination::Device(moved) => (None, moved),
        };
        let mut stopwatch = Stopwatch::start();
        options.report(Phase::Lattice, 0.0)?;
        let points = host.point_count();
        if let Some(mesh) = moved.filter(|mesh| mesh.point_count() != points) {
            return Err(Error::PointCount { points, expected: mesh.point_count() });
        }
        let mut update = moved.map(|_| UpdateStats::default());
        let mut from = moved.filter(|mesh| self.settings.budget.limits.looks_after(mesh.begun_anew()));
        if let Some((mesh, update)) = moved.zip(update.as_mut()).filter(|_| from.is_none()) {
            update.restarted = mesh.stats().update.and_then(|update| update.restarted);
        }
        let mut outcome = loop {
            let before = from.zip(update.as_mut());
            match self.attempt(host, options, used.as_mut(), before, &mut stopwatch).await? {
                Ok(outcome) => break outcome,
                Err(why) => {
                    if let Some(update) = &mut update {
                        update.restarted = Some(why);
                    }
                    from = None;
                }
            }
        };
        if let Outcome::Made(MadeMesh::Host(mesh)) = &outcome {
            mesh_check::check(host, &self.gpu, samples_of_mesh::<D>(mesh)).await?;
        }
        let stats = match &mut outcome {
            Outcome::Made(made) => made.stats_mut(),
            Outcome::LeftToCpu(stats) => stats,
        };
        if let Some(update) = &mut update {
            if update.restarted.is_none() {
                update.stars = stats.splay.as_ref().map_or(0, |splay| splay.built);
            }
            stats.update = Some(*update);
        }
        if let (Outcome::Made(MadeMesh::Device(mesh)), Some(before)) = (&mut outcome, moved) {
            mesh.count_restarts(before);
        }
        Ok(outcome)
    }

    /// Does the same, in the memory of the mesh `used` if the destination is the host, or says why it takes a
    /// run from scratch.
    async fn attempt(
        &mut self,
        host: &mut impl Host<D>,
        options: &Options,
        used: Option<&mut MeshOf<D>>,
        moved: Option<(&DeviceMesh<D>, &mut UpdateStats)>,
        stopwatch: &mut Stopwatch,
    ) -> Result<Result<Outcome<D>, Restart>, Error> {
        let points = host.point_count();
        // Points that had moved too far before will do so again, as a rule.
        let stays = |mesh: &&DeviceMesh<D>| mesh.begun_anew() == 0;
        let repaired = moved.as_ref().map(|&(mesh, _)| mesh).filter(stays);
        let first = repaired.map_or_else(Vec::new, |mesh| mesh.first().to_vec());
        let mut wide = false;
        let Fitted { params, start } = loop {
            let fitted = host.ask(Fit { first: first.clone(), wide }).await?;
            wide = fitted.params.width() == Width::Narrow && !self.has_narrow().await?;
            if !wide {
                break fitted;
            }
        };
        let mut stats = Stats::new(Backend::Gpu);
        let Some(first) = start else {
            if let Some((_, update)) = moved {
                update.restarted = Some(Restart::Degenerate);
            }
            return Ok(Ok(left_to_cpu(Dimension::<D>::DEGENERATE, stats)));
        };
        let mut tracer = Dimension::<D>::tracer(options);
        stats.phases.push((Phase::Lattice, stopwatch.lap()));

        options.report(Phase::Phase1, progress::PHASE_1)?;
        let mut settings = Settings { winding: options.winding, ..self.settings };
        if options.trace {
            // What is traced is the triangulation after each round.
            (settings.rounds, settings.batches, settings.start_points) = (1, 1, Some(0));
        }
        let (gpu, phase1) = self.kernels(params.width(), points).await?;
        let begin = Begin { params, first, starts_later: repaired.is_some() };
        let mut run = Phase1Run::new(phase1, gpu, host, begin, settings, None).await?;
        let mut moved = match moved {
            Some((mesh, update)) => begin_update(&mut run, host, &begin, mesh, update).await?,
            None => None,
        };
        let resident = used.is_none() || settings.way_to_host == Some(WayToHost::MadeOnDevice);
        if let Some(used) = used.filter(|_| !resident) {
            run.prepare_room(Dimension::<D>::take_lists(used));
        }
        let mut more = moved.is_none() || run.active() > 0;
        while more {
            more = run.advance().await?;
            Dimension::<D>::trace_round(&mut tracer, gpu, &run).await?;
            let inserted = 1.0 - f64::from(run.waiting()) / points as f64;
            options.report(Phase::Phase1, progress::PHASE_1 + Dimension::<D>::ROUNDS_SHARE * inserted)?;
            if more && Settings::<D>::is_endless(&run.control().1, points) {
                return Err(gpu.wrong("the rounds do not come to an end"));
            }
            if more && settings.is_slow(&run.control().1) {
                stats.gpu = Some(run.abandon().summary(&self.gpu.adapter().name));
                return Ok(match moved {
                    Some(_) => Err(Restart::Stuck),
                    None => Ok(left_to_cpu(Fallback::Flips, stats)),
                });
            }
        }
        if let Some(moved) = &mut moved {
            moved.update.flips = run.control().1.flips().into();
        }
        let has_moved = moved.is_some();
        let adapter = &gpu.adapter().name;
        let near = Near { host, options, adapter, resident, moved, stats: &mut stats, stopwatch };
        Ok(match Dimension::<D>::complete(run, near, tracer).await? {
            Ok(mut made) => {
                *made.stats_mut() = stats;
                if let MadeMesh::Device(mesh) = &mut made {
                    mesh.set_first(first.first.as_ref());
                }
                Ok(Outcome::Made(made))
            }
            Err(Fallback::Splaying) if has_moved => Err(Restart::Changed),
            Err(_) if has_moved => Err(Restart::Stuck),
            Err(why) => Ok(left_to_cpu(why, stats)),
        })
    }

    /// Returns whether a run with narrow coordinates can use the kernels for these: if they are compiled, or it has to wait
    /// for that. Begins to compile them else; the wide ones serve meanwhile.
    async fn has_narrow(&mut self) -> Result<bool, Error> {
        if !self.compiles_meanwhile || self.narrow.is_some() {
            return Ok(true);
        }
        match self.compiling_narrow.take() {
            Some(mut task) => match task.is_done() {
                true => self.narrow = Some(task.result().await?),
                false => self.compiling_narrow = Some(task),
            },
            None => {
                let gpu = self.gpu.clone();
                let compile = async move { Phase1::new(&gpu, Width::Narrow).await };
                self.compiling_narrow = Some(Task::begin(compile).await);
            }
        }
        Ok(self.narrow.is_some())
    }

    /// Returns the device with the kernels for so many points of this width, compiled if they are not,
    /// and gives the buffers of the other ones back, because points of another kind are unlikely to
    /// come soon.
    pub(crate) async fn kernels(&mut self, width: Width, points: usize) -> Result<(&Gpu, &mut Phase1<D>), Error> {
        if let Some(parts) = self.settings.parts(&self.gpu, points) {
            self.wide.release();
            self.narrow.iter_mut().for_each(Phase1::release);
            let kept = self.in_parts.take().filter(|(of, kept)| *of == width && kept.parts == Some(parts));
            let kernels = match kept {
                Some(kept) => kept,
                None => (width, Phase1::in_parts(&self.gpu, width, Some(parts)).await?),
            };
            return Ok((&self.gpu, &mut self.in_parts.insert(kernels).1));
        }
        if let Some((_, in_parts)) = &mut self.in_parts {
            in_parts.release();
        }
        let phase1 = match width {
            Width::Narrow => {
                self.wide.release();
                match &mut self.narrow {
                    Some(narrow) => narrow,
                    none => none.insert(Phase1::new(&self.gpu, Width::Narrow).await?),
                }
            }
            Width::Wide => {
                if let Some(narrow) = &mut self.narrow {
                    narrow.release();
                }
                &mut self.wide
            }
        };
        // Where no other thread compiles the kernels that the first run does without, the second one waits.
        if !platform::gpu::COMPILES_BESIDE && phase1.kept.memory.is_some() {
            phase1.finish_compiling(&self.gpu).await?;
        }
        Ok((&self.gpu, phase1))
    }
}

/// Begins a run with `mesh` in place of a first simplex, if that pays. Returns what the update needs later.
async fn begin_update<'a, const D: usize>(
    run: &mut Phase1Run<'_, D>,
    host: &mut impl Host<D>,
    begin: &Begin<D>,
    mesh: &DeviceMesh<D>,
    update: &'a mut UpdateStats,
) -> Result<Option<Moved<'a, D>>, Error>
where
    Dimension<D>: Complete<D>,
{
    // The device orders the points now.
    let duplicates = duplicates(mesh.duplicate_of());
    let restarted = if usize::from(mesh.dimension()) != D {
        Err(Restart::Degenerate)
    } else if !mesh.gpu().is_same(run.gpu()) {
        Err(Restart::NotResident)
    } else {
        match run.update(mesh, begin.starts_later).await? {
            None => Err(Restart::Broken),
            Some([inverted, changed]) => {
                (update.inverted, update.not_locally_delaunay) = (inverted, changed);
                let pays =
                    run.settings().budget.limits.check(inverted as f64, changed as f64, mesh.simplex_count() as f64);
                match pays {
                    Ok(()) => check_duplicates(mesh, &duplicates, &run.read_merged().await?),
                    Err(why) => Err(why),
                }
            }
        }
    };
    match restarted {
        Ok(()) => Ok(Some(Moved { duplicates, spanning: begin.first.first, update })),
        Err(why) => {
            update.restarted = Some(why);
            run.forget(host, begin.starts_later).await?;
            Ok(None)
        }
    }
}

/// Returns samples of a mesh in memory, or what is wrong with it.
fn samples_of_mesh<const D: usize>(mesh: &MeshOf<D>) -> Result<Samples, &'static str>
where
    Dimension<D>: MeshArrays<D>,
{
    let [simplices, neighbors, hull] = Dimension::<D>::words(mesh);
    if D == 2 {
        euler2(count_vertices(mesh.duplicate_of()), simplices.len() / 3, hull.len())?;
    }
    Ok(samples_of::<D>(simplices, neighbors))
}

/// Returns the duplicates, each with the vertex that stands for it.
fn duplicates(duplicate_of: &[u32]) -> Vec<[u32; 2]> {
    let parts = parallel::map_ranges(Threads::All, duplicate_of.len(), |range| {
        let of_range = range.clone().zip(&duplicate_of[range]);
        let duplicates = of_range.filter(|&(_, &first)| first != NONE);
        duplicates.map(|(v, &first)| [v as u32, first]).collect::<Vec<_>>()
    });
    parallel::joined(parts)
}

/// Returns why a mesh cannot be repaired that had these duplicates, where these points are at the
/// same places of the lattice now.
fn check_duplicates<const D: usize>(
    mesh: &DeviceMesh<D>,
    duplicates: &[[u32; 2]],
    merged: &[[u32; 2]],
) -> Result<(), Restart> {
    if merged.iter().any(|&[v, _]| mesh.duplicate_of()[v as usize] == NONE) {
        return Err(Restart::Coincident);
    }
    // All of these were duplicates.
    if duplicates.len() - merged.len() > mesh.point_count() / PARTED {
        return Err(Restart::Parted);
    }
    Ok(())
}

/// Returns that the CPU engine has to make the mesh, with what the GPU did before.
fn left_to_cpu<const D: usize>(why: Fallback, before: Stats) -> Outcome<D>
where
    Dimension<D>: Incremental<D>,
{
    Outcome::LeftToCpu(Box::new(Stats { fallback: Some(why), ..before }))
}
