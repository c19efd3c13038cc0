//! One device behind both dimensions: it is opened when it is first needed, and kept for later
//! inputs with what was compiled for it.

use crate::{
    backend::Backend,
    cpu::{self, MeshOf},
    dimension::Dimension,
    error::Error,
    gpu::{
        AdapterChoice, Gpu, Readback,
        device_mesh::{DeviceMesh, with_len},
        engine::{Destination, MadeMesh},
    },
    input::points::Points,
    mesh::MeshInfo,
    options::Options,
    parallel,
    platform::{self, Instant},
    stats::{Fallback, Phase, Restart, Stats, UpdateStats},
    triangulator::{
        state::{Choice, Input, Setup, State, millis},
        wait::CANNOT_WAIT,
    },
};
use async_lock::Mutex;
use std::{
    num::NonZeroUsize,
    sync::{Arc, atomic::Ordering},
};

#[cfg(target_arch = "wasm32")]
mod web;

/// What clones of a [`Triangulator`](crate::Triangulator) share. The device does one run at a time;
/// others wait for it.
#[derive(Debug, Default)]
pub(super) struct SharedDevice {
    setup: Setup,
    /// Whether the device was the caller's from the beginning.
    is_callers: bool,
    /// Whether an adapter was chosen nevertheless.
    is_contradictory: bool,
    state: Mutex<State>,
}

/// Where a caller wants the mesh. A trait rather than closures, whose futures could not be sent to
/// other threads.
trait Deliver<const D: usize>
where
    Dimension<D>: Choice<D>,
{
    type Output;

    /// Returns where the mesh is to be made.
    fn destination(&mut self) -> Destination<'_, D>;

    /// Takes the mesh there from where it was made, with the GPU if it was used.
    async fn deliver(&self, mesh: MadeMesh<D>, gpu: Option<Gpu>) -> Result<Self::Output, Error>;
}

/// To the memory of the host, that of the arrays of this mesh as far as it suffices.
struct ToHost<const D: usize>(MeshOf<D>)
where
    Dimension<D>: Choice<D>;

impl<const D: usize> Deliver<D> for ToHost<D>
where
    Dimension<D>: Choice<D>,
{
    type Output = MeshOf<D>;

    fn destination(&mut self) -> Destination<'_, D> {
        Destination::Host(std::mem::take(&mut self.0))
    }

    async fn deliver(&self, mesh: MadeMesh<D>, _gpu: Option<Gpu>) -> Result<MeshOf<D>, Error> {
        mesh.into_host().await
    }
}

/// To the device.
struct ToDevice<'a, const D: usize> {
    device: &'a SharedDevice,
    /// The mesh of the points where they were, if they have moved.
    moved: Option<&'a DeviceMesh<D>>,
}

impl<const D: usize> Deliver<D> for ToDevice<'_, D>
where
    Dimension<D>: Choice<D>,
{
    type Output = DeviceMesh<D>;

    fn destination(&mut self) -> Destination<'_, D> {
        Destination::Device(self.moved)
    }

    async fn deliver(&self, mesh: MadeMesh<D>, gpu: Option<Gpu>) -> Result<DeviceMesh<D>, Error> {
        if let Some(gpu) = gpu {
            return mesh.into_device(&gpu).await;
        }
        let device = self.device;
        let mut state = device.state.lock().await;
        let gpu = state.device(&device.setup.adapter).await?;
        let result = mesh.into_device(&gpu).await;
        state.forget_if_lost(&result);
        result
    }
}

/// Checks that there are as many points as before they moved.
fn check_count<const D: usize>(points: Points<'_, D>, moved: Option<&DeviceMesh<D>>) -> Result<(), Error> {
    match moved.map(DeviceMesh::point_count) {
        Some(expected) if expected != points.len() => Err(Error::PointCount { points: points.len(), expected }),
        _ => Ok(()),
    }
}

impl SharedDevice {
    /// Creates the state for a device of this adapter, in place of this state.
    pub(super) fn with_adapter(&self, adapter: AdapterChoice) -> Self {
        let setup = self.setup.with_adapter(adapter);
        SharedDevice { setup, is_contradictory: self.is_callers, ..SharedDevice::default() }
    }

    /// Creates the state for the caller's device. When that is lost, the default adapter replaces
    /// it.
    pub(super) fn from_gpu(gpu: Gpu) -> Self {
        let setup = Setup::default();
        // Whoever gives a software device wants it to be used.
        setup.known.set_learning(!gpu.adapter().software);
        let state = State { caller_supplied: Some(gpu), ..State::default() };
        SharedDevice { setup, is_callers: true, state: Mutex::new(state), ..SharedDevice::default() }
    }

    /// Sets whether devices are tested before they are used.
    pub(super) fn set_self_test(&self, self_test: bool) {
        self.setup.set_self_test(self_test);
    }

    /// Returns what calls that block use: where nobody can wait for a GPU, a state without one.
    pub(super) fn for_blocking(self: &Arc<Self>, backend: Backend) -> Result<Arc<Self>, Error> {
        if platform::CAN_WAIT || backend == Backend::Cpu {
            return Ok(self.clone());
        }
        let unavailable = Error::GpuUnavailable { reason: CANNOT_WAIT };
        if backend == Backend::Gpu {
            return Err(unavailable);
        }
        let state = State { unusable: Some(Fallback::NoGpu(unavailable)), ..State::default() };
        Ok(shared(SharedDevice { state: Mutex::new(state), ..SharedDevice::default() }))
    }

    /// Returns an error if both a device and an adapter were given.
    fn check(&self) -> Result<(), Error> {
        if self.is_contradictory { Err(Error::AdapterOfDevice) } else { Ok(()) }
    }

    /// Opens the device unless it is open.
    pub(super) async fn open(&self) -> Result<(), Error> {
        self.check()?;
        self.state.lock().await.device(&self.setup.adapter).await?;
        Ok(())
    }

    /// Returns the GPU, with the kernels for 3D compiled. Opens it if necessary.
    pub(super) async fn gpu(&self) -> Result<Gpu, Error> {
        self.check()?;
        let mut state = self.state.lock().await;
        Ok(state.open::<3>(&self.setup).await?.gpu().clone())
    }

    /// Gives the device back now rather than with the last reference to it. The next run reopens
    /// it.
    pub(super) async fn close(&self) {
        let mut state = self.state.lock().await;
        if let Some(gpu) = &state.opened {
            gpu.device().destroy();
        }
        state.close();
    }

    /// Makes `mesh` that of `points`, in the memory of its arrays as far as it suffices. After an error the mesh
    /// is empty.
    pub(super) async fn triangulate<const D: usize>(
        &self,
        points: Points<'_, D>,
        options: &Options,
        mesh: &mut MeshOf<D>,
    ) -> Result<(), Error>
    where
        Dimension<D>: Choice<D>,
    {
        let used = std::mem::take(mesh);
        *mesh = self.run(points, options, &mut ToHost(used)).await?;
        Ok(())
    }

    /// Triangulates `points`, and leaves the mesh on the device.
    pub(super) async fn resident<const D: usize>(
        &self,
        points: Points<'_, D>,
        options: &Options,
    ) -> Result<DeviceMesh<D>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        self.run(points, options, &mut ToDevice { device: self, moved: None }).await
    }

    /// Makes `mesh` that of `points`, which have moved.
    pub(super) async fn update<const D: usize>(
        &self,
        mesh: &mut DeviceMesh<D>,
        points: Points<'_, D>,
        options: &Options,
    ) -> Result<(), Error>
    where
        Dimension<D>: Choice<D>,
    {
        check_count(points, Some(mesh))?;
        let mut made = self.run(points, options, &mut ToDevice { device: self, moved: Some(mesh) }).await?;
        made.stats_mut().update.get_or_insert_with(|| UpdateStats::from_scratch(Restart::NotResident));
        // Its lists of points are large, and freeing them takes longer than some updates.
        parallel::dispose(std::mem::replace(mesh, made));
        Ok(())
    }

    /// Reads points, which the host needs for the lattice and for exact predicates.
    pub(super) async fn read_points<const D: usize>(&self, points: &wgpu::Buffer) -> Result<Vec<[f32; D]>, Error> {
        let bytes = points.size();
        let point_bytes = (D * size_of::<f32>()) as u64;
        if !bytes.is_multiple_of(point_bytes) {
            return Err(Error::NotWholePoints { length: (bytes / 4) as usize, dimension: D });
        }
        let gpu = self.state.lock().await.device(&self.setup.adapter).await?;
        let mut array = Vec::new();
        let target = with_len::<[f32; D]>(&mut array, (bytes / point_bytes) as usize)?;
        Readback::default().read_into(&gpu, vec![(points, target)]).await?;
        Ok(array)
    }

    /// Triangulates `points`, and delivers the mesh. If the backend is [`Backend::Auto`] and the GPU
    /// fails before that is done, the mesh of the CPU is delivered.
    async fn run<const D: usize, L: Deliver<D>>(
        &self,
        points: Points<'_, D>,
        options: &Options,
        to: &mut L,
    ) -> Result<L::Output, Error>
    where
        Dimension<D>: Choice<D>,
    {
        self.check()?;
        match options.backend {
            Backend::Cpu => to.deliver(MadeMesh::Host(self.by_cpu(points, options)?), None).await,
            Backend::Gpu => {
                let mut state = self.state.lock().await;
                self.by_gpu(&mut state, points, options, to).await
            }
            Backend::Auto => {
                let options = &options.monotone();
                let why = match self.try_gpu(points, options, to).await {
                    Ok(result) => return result,
                    Err(why) => why,
                };
                let mut mesh = self.by_cpu(points, options)?;
                let stats = mesh.stats_mut();
                (stats.fallback, stats.wrong_meshes) = (Some(why), self.setup.known.of::<D>().wrong_meshes());
                to.deliver(MadeMesh::Host(mesh), None).await
            }
        }
    }

    /// Delivers what the GPU engine makes of the points, or says why the CPU engine has to.
    async fn try_gpu<const D: usize, L: Deliver<D>>(
        &self,
        points: Points<'_, D>,
        options: &Options,
        to: &mut L,
    ) -> Result<Result<L::Output, Error>, Fallback>
    where
        Dimension<D>: Choice<D>,
    {
        let input = Input { points: points.len(), threads: options.threads.map(NonZeroUsize::get) };
        let mut state = self.state.lock().await;
        state.open_if_it_pays::<D>(&self.setup, input).await?;
        match self.by_gpu(&mut state, points, options, to).await {
            Err(error) if error.is_of_the_gpu() => Err(Fallback::GpuFailed(error)),
            result => Ok(result),
        }
    }

    /// Returns the mesh of the CPU engine, and notes how long it takes.
    fn by_cpu<const D: usize>(&self, points: Points<'_, D>, options: &Options) -> Result<MeshOf<D>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let began = Instant::now();
        let mesh = cpu::delaunay(points, options)?;
        self.setup.cpu_runs.fetch_add(1, Ordering::Relaxed);
        if options.threads.is_none() {
            self.setup.known.of::<D>().note_cpu(points.len(), millis(began));
        }
        Ok(mesh)
    }

    /// Delivers the mesh of the GPU engine, opened if it is not, and notes how long it takes. If its device gets lost, the
    /// next run has to open another.
    async fn by_gpu<const D: usize, L: Deliver<D>>(
        &self,
        state: &mut State,
        points: Points<'_, D>,
        options: &Options,
        to: &mut L,
    ) -> Result<L::Output, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let engine = state.open::<D>(&self.setup).await?;
        let began = Instant::now();
        let options = &options.monotone();
        let result = async {
            let mut mesh = engine.make(points, options, to.destination()).await?;
            mesh.stats_mut().wrong_meshes = self.setup.known.of::<D>().wrong_meshes();
            let Stats { fallback, update, trace, .. } = mesh.stats_mut();
            let is_usual = fallback.is_none() && update.is_none() && trace.is_none();
            let delivered = to.deliver(mesh, Some(engine.gpu().clone())).await?;
            options.report(Phase::Finish, 1.0)?;
            if is_usual {
                self.setup.known.of::<D>().note_gpu(points.len(), millis(began));
            }
            Ok(delivered)
        };
        let result = result.await;
        state.note_failure::<D, _>(&self.setup, &result);
        result
    }
}

/// Shares a device among clones.
#[cfg_attr(
    target_arch = "wasm32",
    expect(clippy::arc_with_non_send_sync, reason = "only in browsers do wgpu's types belong to one thread")
)]
pub(super) fn shared(device: SharedDevice) -> Arc<SharedDevice> {
    Arc::new(device)
}
