//! One device behind both dimensions: it is opened when it is first needed, and kept for later inputs with what was compiled
//! for it.

use crate::{
    Backend, Error, Mesh2, Mesh3, Options, Points,
    d2::{self, gpu::engine::Hybrid2},
    d3::{cpu, gpu::engine::Hybrid},
    gpu::{AdapterChoice, Gpu},
    input::points::Points2,
    stats::{Fallback, Stats},
};
use async_lock::Mutex;

/// From so many points in space on, [`Backend::Auto`] takes the GPU engine if it is open.
///
/// A bound, from `cargo bench --features cli --bench experiments -- crossing` on one NVIDIA H200 and one core of the Xeon beside
/// it, 2026-11-21: the GPU engine takes 27 ms for 100,000 uniform points, and never more for fewer; the CPU engine takes 2.0 µs
/// a point at least, so it is no faster from 14,000 points on. The rest is for devices that take longer to start.
pub const MIN_POINTS: usize = 24_000;

/// The points in space that the CPU engine triangulates in the time that it takes to open the GPU and compile its kernels: 188 and 74 ms
/// on the same machine, against 245 ms for 100,000 points. [`Backend::Auto`] opens it when it has been asked for so many in all
/// that the GPU would have taken, so opening never costs more than was lost by not having done so.
pub const OPENING_POINTS: usize = 100_000;

/// As [`MIN_POINTS`] in the plane: there, on the same machine (`cargo bench --bench measure_2d`, 2026-11-22), the GPU
/// engine takes 8 ms for 50,000 points, and the CPU engine 0.43 µs a point, so it is no faster from 19,000 points on.
pub const MIN_POINTS_2: usize = 30_000;

/// As [`OPENING_POINTS`] in the plane: 188 and 52 ms, at 0.43 µs a point.
pub const OPENING_POINTS_2: usize = 560_000;

/// What clones of a [`Triangulator`](crate::Triangulator) share. The device does one run at a time; others wait for it.
#[derive(Debug, Default)]
pub(super) struct SharedDevice {
    adapter: AdapterChoice,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    space: Slot<Hybrid>,
    /// On the same device.
    plane: Slot<Hybrid2>,
    /// The caller's device, which [`Backend::Auto`] may take though it is software, and which is not destroyed here.
    caller_supplied: Option<Gpu>,
    /// Why [`Backend::Auto`] does not try to open a device again.
    unusable: Option<Fallback>,
}

#[derive(Debug)]
struct Slot<E> {
    /// The GPU engine, while it is open.
    engine: Option<E>,
    /// Points of the inputs that it would have been taken for, had it been open.
    missed: usize,
}

impl<E> Default for Slot<E> {
    fn default() -> Self {
        Slot { engine: None, missed: 0 }
    }
}

/// A GPU engine, and the CPU engine that stands in for it: in space, and in the plane.
trait GpuEngine<const D: usize>: Sized + 'static {
    type Mesh;
    const MIN_POINTS: usize;
    const OPENING_POINTS: usize;

    fn slot(state: &mut State) -> &mut Slot<Self>;
    fn stats(mesh: &mut Self::Mesh) -> &mut Stats;
    async fn compile(gpu: Gpu) -> Result<Self, Error>;
    async fn triangulate(&mut self, points: Points<'_, D>, options: &Options) -> Result<Self::Mesh, Error>;
    fn on_cpu(points: Points<'_, D>, options: &Options) -> Result<Self::Mesh, Error>;
}

impl GpuEngine<3> for Hybrid {
    type Mesh = Mesh3;
    const MIN_POINTS: usize = MIN_POINTS;
    const OPENING_POINTS: usize = OPENING_POINTS;

    fn slot(state: &mut State) -> &mut Slot<Self> {
        &mut state.space
    }

    fn stats(mesh: &mut Mesh3) -> &mut Stats {
        &mut mesh.stats
    }

    async fn compile(gpu: Gpu) -> Result<Self, Error> {
        Hybrid::new(gpu).await
    }

    async fn triangulate(&mut self, points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
        self.delaunay3d(points, options).await
    }

    fn on_cpu(points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
        cpu::delaunay3d(points, options)
    }
}

impl GpuEngine<2> for Hybrid2 {
    type Mesh = Mesh2;
    const MIN_POINTS: usize = MIN_POINTS_2;
    const OPENING_POINTS: usize = OPENING_POINTS_2;

    fn slot(state: &mut State) -> &mut Slot<Self> {
        &mut state.plane
    }

    fn stats(mesh: &mut Mesh2) -> &mut Stats {
        &mut mesh.stats
    }

    async fn compile(gpu: Gpu) -> Result<Self, Error> {
        Hybrid2::new(gpu).await
    }

    async fn triangulate(&mut self, points: Points2<'_>, options: &Options) -> Result<Mesh2, Error> {
        self.delaunay2d(points, options).await
    }

    fn on_cpu(points: Points2<'_>, options: &Options) -> Result<Mesh2, Error> {
        d2::cpu::delaunay2d(points, options)
    }
}

impl SharedDevice {
    /// Creates the state for a device of this adapter.
    pub(super) fn new(adapter: AdapterChoice) -> Self {
        SharedDevice { adapter, ..SharedDevice::default() }
    }

    /// Creates the state for the caller's device. When that is lost, the default adapter replaces it.
    pub(super) fn from_gpu(gpu: Gpu) -> Self {
        let state = State { caller_supplied: Some(gpu), ..State::default() };
        SharedDevice { state: Mutex::new(state), ..SharedDevice::default() }
    }

    /// Returns the GPU, with the kernels for 3D compiled. Opens it if necessary.
    pub(super) async fn gpu(&self) -> Result<Gpu, Error> {
        let mut state = self.state.lock().await;
        Ok(state.open::<Hybrid, 3>(&self.adapter).await?.gpu().clone())
    }

    /// Gives the device back now rather than with the last reference to it. The next run reopens it.
    pub(super) async fn close(&self) {
        let mut state = self.state.lock().await;
        match (&state.caller_supplied, state.open_device()) {
            (None, Some(gpu)) => gpu.device().destroy(),
            (Some(_), _) | (None, None) => {}
        }
        state.close();
    }

    /// Triangulates `points` in 3D.
    pub(super) async fn delaunay3d(&self, points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
        self.run::<Hybrid, 3>(points, options).await
    }

    /// Triangulates `points` in 2D.
    pub(super) async fn delaunay2d(&self, points: Points2<'_>, options: &Options) -> Result<Mesh2, Error> {
        self.run::<Hybrid2, 2>(points, options).await
    }

    async fn run<E: GpuEngine<D>, const D: usize>(
        &self,
        points: Points<'_, D>,
        options: &Options,
    ) -> Result<E::Mesh, Error> {
        match options.backend {
            Backend::Cpu => E::on_cpu(points, options),
            Backend::Gpu => {
                let mut state = self.state.lock().await;
                state.open::<E, D>(&self.adapter).await?;
                state.run::<E, D>(points, options).await
            }
            Backend::Auto => {
                let options = &options.monotone();
                let why = match self.try_gpu::<E, D>(points, options).await {
                    Ok(result) => return result,
                    Err(why) => why,
                };
                let mut mesh = E::on_cpu(points, options)?;
                E::stats(&mut mesh).fallback = Some(why);
                Ok(mesh)
            }
        }
    }

    /// What the GPU engine makes of the points, or why the CPU engine has to.
    async fn try_gpu<E: GpuEngine<D>, const D: usize>(
        &self,
        points: Points<'_, D>,
        options: &Options,
    ) -> Result<Result<E::Mesh, Error>, Fallback> {
        if points.len() < E::MIN_POINTS {
            return Err(Fallback::FewPoints { points: points.len(), least: E::MIN_POINTS });
        }
        let mut state = self.state.lock().await;
        state.open_if_it_pays::<E, D>(&self.adapter, points.len()).await?;
        match state.run::<E, D>(points, options).await {
            Err(error) if error.is_of_the_gpu() => Err(Fallback::GpuFailed(error)),
            result => Ok(result),
        }
    }
}

impl State {
    /// The GPU engine, opened if it is not.
    async fn open<E: GpuEngine<D>, const D: usize>(&mut self, adapter: &AdapterChoice) -> Result<&mut E, Error> {
        let engine = match E::slot(self).engine.take() {
            Some(engine) => engine,
            None => E::compile(self.device(adapter).await?).await?,
        };
        Ok(E::slot(self).engine.insert(engine))
    }

    /// The device of the engines that are open: they share one.
    fn open_device(&self) -> Option<Gpu> {
        let space = self.space.engine.as_ref().map(Hybrid::gpu);
        space.or(self.plane.engine.as_ref().map(Hybrid2::gpu)).cloned()
    }

    /// That device, or a new one.
    async fn device(&self, adapter: &AdapterChoice) -> Result<Gpu, Error> {
        match self.open_device().or_else(|| self.caller_supplied.clone()) {
            Some(gpu) => Ok(gpu),
            None => Gpu::open(adapter).await,
        }
    }

    /// Forgets what was compiled for the device.
    fn close(&mut self) {
        self.space.engine = None;
        self.plane.engine = None;
    }

    /// Opens the GPU engine for an input of `points` points if it is not open, or says why not to take it.
    async fn open_if_it_pays<E: GpuEngine<D>, const D: usize>(
        &mut self,
        adapter: &AdapterChoice,
        points: usize,
    ) -> Result<(), Fallback> {
        if let Some(why) = &self.unusable {
            return Err(why.clone());
        }
        if let Some(gpu) = self.open_device() {
            self.usable(&gpu)?;
        }
        if E::slot(self).engine.is_some() {
            return Ok(());
        }
        let least = E::OPENING_POINTS.saturating_sub(E::slot(self).missed);
        if points < least && self.caller_supplied.is_none() {
            E::slot(self).missed += points;
            return Err(Fallback::FewPoints { points, least });
        }
        let opened = match self.device(adapter).await {
            Ok(gpu) => match self.usable(&gpu) {
                Ok(()) => E::compile(gpu).await.map_err(Fallback::NoGpu),
                Err(why) => Err(why),
            },
            Err(error) => Err(Fallback::NoGpu(error)),
        };
        match opened {
            Ok(engine) => {
                E::slot(self).engine = Some(engine);
                Ok(())
            }
            Err(why) => Err(self.unusable.insert(why).clone()),
        }
    }

    /// Runs the GPU engine, which is open. If its device gets lost, the next run has to open another.
    async fn run<E: GpuEngine<D>, const D: usize>(
        &mut self,
        points: Points<'_, D>,
        options: &Options,
    ) -> Result<E::Mesh, Error> {
        let Some(engine) = &mut E::slot(self).engine else {
            return Err(Error::NoAdapter { reason: "it is not open".to_owned() });
        };
        let result = engine.triangulate(points, options).await;
        if matches!(result, Err(Error::DeviceLost { .. })) {
            self.close();
            self.caller_supplied = None;
        }
        result
    }

    /// An adapter that is none is no use to [`Backend::Auto`], unless the caller brought it.
    fn usable(&self, gpu: &Gpu) -> Result<(), Fallback> {
        match gpu.adapter().software && self.caller_supplied.is_none() {
            true => Err(Fallback::SoftwareGpu(gpu.adapter().name.clone())),
            false => Ok(()),
        }
    }
}
