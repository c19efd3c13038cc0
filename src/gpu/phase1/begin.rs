//! The beginning of a run: points are uploaded and ordered, while the host makes the start.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Profiler, Recorder,
        device::ErrorScope,
        dim::Dim,
        host::{Fitted, Host, MakeStart},
        layout::Params,
        phase1::{
            buffers::Sizes,
            capacity::first_sizes,
            finish::Finish,
            kernels::Phase1,
            memory::{Kept, Memory},
            plan::{Plan, Rules},
            record::DeviceRun,
            run::Phase1Run,
            settings::Settings,
            stages::Stage,
            stats::{Meter, Phase1Stats},
        },
        points::InputParams,
        start::{StartMesh, StartSimplex},
    },
    options::Winding,
    platform,
    stats::Stopwatch,
};
use std::{collections::VecDeque, time::Duration};

/// Flip iterations are done in one workgroup until this many times as many simplices are active as
/// when it begins with that.
const FEW_LIMIT: u32 = 4;

/// The most flip iterations that one workgroup does in a dispatch: more than a round of an ordinary
/// input takes, and so few that a run is not far beyond them when it is found to be slow.
const FEW_ITERATIONS: u32 = 128;

/// How a run begins.
#[derive(Debug, Clone, Copy)]
pub struct Begin<const D: usize>
where
    Dimension<D>: Dim<D>,
{
    /// Where the points are on the lattice.
    pub params: InputParams,
    /// The first simplex, by input indices.
    pub first: StartSimplex<D>,
    /// Whether as a rule no points are inserted, because [`Phase1Run::update`] comes next: then what they
    /// would be inserted into is made only by [`Phase1Run::forget`].
    pub starts_later: bool,
}

impl<const D: usize> Begin<D>
where
    Dimension<D>: Dim<D>,
{
    /// Returns how a run on points begins that span all dimensions.
    ///
    /// # Panics
    ///
    /// Panics if they do not.
    pub fn of(Fitted { params, start }: Fitted<D>) -> Self {
        Begin { params, first: start.expect("the points span all dimensions"), starts_later: false }
    }
}

impl<'a, const D: usize> Phase1Run<'a, D>
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
        host: &mut impl Host<D>,
        begin: Begin<D>,
        settings: Settings<D>,
        mut profiler: Option<&'a mut Profiler>,
    ) -> Result<Self, Error> {
        let (clock, round_clock) = (Stopwatch::start(), Stopwatch::start());
        let count = host.point_count();
        let sizes = first_sizes(gpu, kernels.parts, &settings, count)?;
        // What is kept is lost if the run fails.
        let Kept { points: kept_points, memory: kept, needed } = std::mem::take(&mut kernels.kept);
        let before = if needed.points == count as u32 { needed } else { Default::default() };
        let Begin { params: on_lattice, first, starts_later } = begin;
        let points = match kept_points.filter(|kept| kept.fits(&on_lattice)) {
            Some(kept) => kept,
            None => gpu.with_error_scope("the points", || kernels.points.buffers(gpu, &on_lattice)).await?,
        };
        host.upload(gpu, points.input()).await?;
        // The device orders the points while the host makes the other buffers.
        let mut uploaded = None;
        let upload = || {
            let scope = ErrorScope::open(gpu, "Phase 1");
            let mut recorder = Recorder::new(gpu, profiler.as_deref_mut());
            let device = kernels.points.record(gpu, &mut recorder, &points, on_lattice, settings.sort);
            let mut words = Vec::new();
            let (width, inside) = (on_lattice.width(), first.interior_point);
            Dimension::<D>::append_vertex(&mut words, width, inside, count as u32, false);
            device.vertices.write(gpu, count * words.len(), &words);
            let dispatches = recorder.dispatches();
            recorder.submit(gpu);
            let memory = Memory::new(&kernels.stages, gpu, kept, device, sizes);
            uploaded = Some((memory, dispatches, scope.close()));
        };
        let start = if starts_later {
            upload();
            StartMesh::of_first(&first)
        } else {
            host.ask_while(MakeStart { wanted: sizes.start_points }, upload).await?
        };
        let (memory, dispatches, report) = uploaded.ok_or(Error::Cancelled)?;
        report.await?;
        let memory = memory?;
        let few = if kernels.stages.can(Stage::FlipFew) { settings.few } else { 0 };
        let params = params(&settings, Sizes { blocks: memory.buffers.blocks(), ..sizes }, count as u32, few);
        let mut device = DeviceRun { params, memory, points: Some(points), settings, parts: kernels.parts };
        device.set_start(&start);
        let rules = Rules {
            params: device.params,
            corners: D as u32 + 1,
            first_iterations: Dimension::<D>::FIRST_ITERATIONS,
            rounds: settings.rounds as usize,
            together: platform::gpu::INSERTED_TOGETHER,
            batches: settings.batches as usize,
            removes: kernels.stages.can(Stage::Remove),
        };
        let start_points = start.points.len();
        Ok(Phase1Run {
            gpu,
            profiler,
            device,
            meter: Meter {
                stats: Phase1Stats { start_points, dispatches, submits: 1, ..Phase1Stats::default() },
                read_before: (kernels.readback.count(), kernels.readback.bytes()),
                clock,
                round_clock,
                dispatch_time: Duration::ZERO,
            },
            kernels,
            plan: Plan::new(rules, start_points as u32, before),
            before,
            submitted: VecDeque::new(),
            first,
            start,
            rooms: [None, None],
        })
    }
}

/// Returns the parameters of the kernels for so many points, without those of the start.
fn params<const D: usize>(settings: &Settings<D>, sizes: Sizes, points: u32, few: u32) -> Params {
    Params {
        infinite: points,
        blocks: sizes.blocks,
        history: sizes.history,
        few,
        few_limit: few.saturating_mul(FEW_LIMIT),
        few_iterations: FEW_ITERATIONS,
        max_min_active: settings.min_active.min(points >> 4),
        insert_all: u32::from(settings.insert_all),
        pick: settings.pick as u32,
        clockwise: u32::from(settings.winding == Winding::Clockwise),
        ..Params::default()
    }
}
