//! One device behind both dimensions: it is opened when it is first needed, and kept for later
//! inputs with what was compiled for it.

use crate::{
    backend::Backend,
    cpu::{self, MeshOf},
    dimension::Dimension,
    error::Error,
    gpu::{
        AdapterChoice, Gpu, Readback,
        device_mesh::{DeviceMesh, DeviceMesh2, DeviceMesh3, MeshArrays, with_len},
        engine::{Complete, Destination, GpuEngine, Made},
        phase1::Finish,
    },
    input::points::{Points, Points2, Points3},
    mesh::MeshInfo,
    options::Options,
    parallel,
    stats::{Fallback, Phase, Restart, UpdateStats},
};
use async_lock::Mutex;

/// The number of points in 3D from which on [`Backend::Auto`] takes the GPU engine if it is open.
///
/// A bound, measured on one NVIDIA H200
/// and one core of the Xeon beside it, 2026-11-21: the GPU engine takes 27 ms for 100,000 uniform
/// points, and never more for fewer; the CPU engine takes at least 2.0 µs per point, so it is no
/// faster from 14,000 points on. The rest is for devices that take longer to start. Against 4 and
/// against 16 threads the GPU is faster from 2,000 points on, 2026-11-24: 4.6 against 7 ms.
pub const MIN_POINTS_3D: usize = 24_000;

/// The number of points in 3D that the CPU engine triangulates in the time that it takes to open
/// the GPU and compile its kernels: 188 and 74 ms on the same machine, against 245 ms for 100,000
/// points. [`Backend::Auto`] opens it when it has seen so many in all that the GPU would have
/// taken, so opening never costs more than was lost by not having done so.
pub const OPENING_POINTS_3D: usize = 100_000;

/// The number of points in 2D from which on [`Backend::Auto`] takes the GPU engine if it is open:
/// on the same machine (2026-11-22), the GPU engine takes 8 ms
/// for 50,000 points, and the CPU engine 0.43 µs per point, so it is no faster from 19,000 points
/// on.
pub const MIN_POINTS_2D: usize = 30_000;

/// The number of points in 2D that the CPU engine triangulates while the GPU is opened and its
/// kernels compiled: 188 and 52 ms, at 0.43 µs per point.
pub const OPENING_POINTS_2D: usize = 560_000;

/// What clones of a [`Triangulator`](crate::Triangulator) share. The device does one run at a time;
/// others wait for it.
#[derive(Debug, Default)]
pub(super) struct SharedDevice {
    adapter: AdapterChoice,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
pub(super) struct State {
    d3: Slot<3>,
    /// On the same device.
    d2: Slot<2>,
    /// The device that was opened here, while it is open.
    opened: Option<Gpu>,
    /// The caller's device, which [`Backend::Auto`] may take though it is software, and which is
    /// not destroyed here.
    caller_supplied: Option<Gpu>,
    /// Why [`Backend::Auto`] does not try to open a device again.
    unusable: Option<Fallback>,
}

#[derive(Debug)]
pub(super) struct Slot<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    /// The GPU engine, while it is open.
    engine: Option<GpuEngine<D>>,
    /// The points of the inputs so far that it would have been taken for, had it been open.
    points_seen: usize,
}

impl<const D: usize> Default for Slot<D>
where
    Dimension<D>: Finish<D>,
{
    fn default() -> Self {
        Slot { engine: None, points_seen: 0 }
    }
}

/// What [`Backend::Auto`] has to know of a dimension.
pub(super) trait Choice<const D: usize>: Complete<D> + MeshArrays<D>
where
    Dimension<D>: Complete<D>,
{
    const MIN_POINTS: usize;
    const OPENING_POINTS: usize;

    fn slot(state: &mut State) -> &mut Slot<D>;
}

impl Choice<3> for Dimension<3> {
    const MIN_POINTS: usize = MIN_POINTS_3D;
    const OPENING_POINTS: usize = OPENING_POINTS_3D;

    fn slot(state: &mut State) -> &mut Slot<3> {
        &mut state.d3
    }
}

impl Choice<2> for Dimension<2> {
    const MIN_POINTS: usize = MIN_POINTS_2D;
    const OPENING_POINTS: usize = OPENING_POINTS_2D;

    fn slot(state: &mut State) -> &mut Slot<2> {
        &mut state.d2
    }
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
    async fn deliver(&self, mesh: Made<D>, gpu: Option<Gpu>) -> Result<Self::Output, Error>;
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

    async fn deliver(&self, mesh: Made<D>, _gpu: Option<Gpu>) -> Result<MeshOf<D>, Error> {
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

    async fn deliver(&self, mesh: Made<D>, gpu: Option<Gpu>) -> Result<DeviceMesh<D>, Error> {
        if let Some(gpu) = gpu {
            return mesh.into_device(&gpu).await;
        }
        let device = self.device;
        let mut state = device.state.lock().await;
        let gpu = state.device(&device.adapter).await?;
        let result = mesh.into_device(&gpu).await;
        state.forget_if_lost(&result);
        result
    }
}

/// To a function of the caller's: from where it was made, or from the device.
#[cfg(target_arch = "wasm32")]
struct ToCaller<'a, F, R, const D: usize> {
    on_device: Option<ToDevice<'a, D>>,
    take: F,
    result: std::marker::PhantomData<R>,
}

#[cfg(target_arch = "wasm32")]
impl<const D: usize, F, R> ToCaller<'_, F, R, D>
where
    Dimension<D>: Choice<D>,
{
    /// Returns the mesh of the points where they were, if they have moved.
    fn moved(&self) -> Option<&DeviceMesh<D>> {
        self.on_device.as_ref()?.moved
    }
}

#[cfg(target_arch = "wasm32")]
impl<const D: usize, R, F: AsyncFn(Made<D>) -> Result<R, Error>> Deliver<D> for ToCaller<'_, F, R, D>
where
    Dimension<D>: Choice<D>,
{
    type Output = R;

    fn destination(&mut self) -> Destination<'_, D> {
        Destination::Device(self.moved())
    }

    async fn deliver(&self, mesh: Made<D>, gpu: Option<Gpu>) -> Result<R, Error> {
        let mut mesh = match (mesh, &self.on_device) {
            (mesh @ Made::Host(_), Some(on_device)) => Made::Device(Box::new(on_device.deliver(mesh, gpu).await?)),
            (mesh, _) => mesh,
        };
        if self.moved().is_some() {
            mesh.stats_mut().update.get_or_insert_with(|| UpdateStats::from_scratch(Restart::NotResident));
        }
        (self.take)(mesh).await
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
    /// Creates the state for a device of this adapter.
    pub(super) fn new(adapter: AdapterChoice) -> Self {
        SharedDevice { adapter, ..SharedDevice::default() }
    }

    /// Creates the state for the caller's device. When that is lost, the default adapter replaces
    /// it.
    pub(super) fn from_gpu(gpu: Gpu) -> Self {
        let state = State { caller_supplied: Some(gpu), ..State::default() };
        SharedDevice { state: Mutex::new(state), ..SharedDevice::default() }
    }

    /// Returns the GPU, with the kernels for 3D compiled. Opens it if necessary.
    pub(super) async fn gpu(&self) -> Result<Gpu, Error> {
        let mut state = self.state.lock().await;
        Ok(state.open::<3>(&self.adapter).await?.gpu().clone())
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

    /// Triangulates `points`, and has `take` take the mesh where it was made, or, if `resident`, on
    /// the device; there it goes on from `moved`, the mesh of the points where they were, if there is
    /// one.
    #[cfg(target_arch = "wasm32")]
    pub(super) async fn deliver<const D: usize, R>(
        &self,
        points: Points<'_, D>,
        options: &Options,
        resident: bool,
        moved: Option<&DeviceMesh<D>>,
        take: impl AsyncFn(Made<D>) -> Result<R, Error>,
    ) -> Result<R, Error>
    where
        Dimension<D>: Choice<D>,
    {
        check_count(points, moved)?;
        let on_device = resident.then_some(ToDevice { device: self, moved });
        self.run(points, options, &mut ToCaller { on_device, take, result: std::marker::PhantomData }).await
    }

    /// Triangulates `points` in 3D, and leaves the mesh on the device.
    pub(super) async fn delaunay3d_on_device(
        &self,
        points: Points3<'_>,
        options: &Options,
    ) -> Result<DeviceMesh3, Error> {
        self.run(points, options, &mut ToDevice { device: self, moved: None }).await
    }

    /// Triangulates `points` in 2D, and leaves the mesh on the device.
    pub(super) async fn delaunay2d_on_device(
        &self,
        points: Points2<'_>,
        options: &Options,
    ) -> Result<DeviceMesh2, Error> {
        self.run(points, options, &mut ToDevice { device: self, moved: None }).await
    }

    /// Triangulates the points in a buffer of the device in 3D, and leaves the mesh there.
    pub(super) async fn delaunay3d_of_buffer(
        &self,
        points: &wgpu::Buffer,
        options: &Options,
    ) -> Result<DeviceMesh3, Error> {
        let points = self.read_points::<3>(points).await?;
        self.run((&points).into(), options, &mut ToDevice { device: self, moved: None }).await
    }

    /// Triangulates the points in a buffer of the device in 2D, and leaves the mesh there.
    pub(super) async fn delaunay2d_of_buffer(
        &self,
        points: &wgpu::Buffer,
        options: &Options,
    ) -> Result<DeviceMesh2, Error> {
        let points = self.read_points::<2>(points).await?;
        self.run((&points).into(), options, &mut ToDevice { device: self, moved: None }).await
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
        let gpu = self.state.lock().await.device(&self.adapter).await?;
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
        match options.backend {
            Backend::Cpu => to.deliver(Made::Host(cpu::delaunay(points, options)?), None).await,
            Backend::Gpu => {
                let mut state = self.state.lock().await;
                state.open::<D>(&self.adapter).await?;
                state.run(points, options, to).await
            }
            Backend::Auto => {
                let options = &options.monotone();
                let why = match self.try_gpu(points, options, to).await {
                    Ok(result) => return result,
                    Err(why) => why,
                };
                let mut mesh = cpu::delaunay(points, options)?;
                mesh.stats_mut().fallback = Some(why);
                to.deliver(Made::Host(mesh), None).await
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
        let min_points = Dimension::<D>::MIN_POINTS;
        if points.len() < min_points {
            return Err(Fallback::FewPoints { points: points.len(), least: min_points });
        }
        let mut state = self.state.lock().await;
        state.open_if_it_pays::<D>(&self.adapter, points.len()).await?;
        match state.run(points, options, to).await {
            Err(error) if error.is_of_the_gpu() => Err(Fallback::GpuFailed(error)),
            result => Ok(result),
        }
    }
}

impl State {
    /// Returns the GPU engine, opened if it is not.
    async fn open<const D: usize>(&mut self, adapter: &AdapterChoice) -> Result<&mut GpuEngine<D>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let engine = match Dimension::<D>::slot(self).engine.take() {
            Some(engine) => engine,
            None => GpuEngine::new(self.device(adapter).await?).await?,
        };
        Ok(Dimension::<D>::slot(self).engine.insert(engine))
    }

    /// Returns the device, opened if it is not.
    async fn device(&mut self, adapter: &AdapterChoice) -> Result<Gpu, Error> {
        match self.opened.as_ref().or(self.caller_supplied.as_ref()) {
            Some(gpu) => Ok(gpu.clone()),
            None => Ok(self.opened.insert(Gpu::open(adapter).await?).clone()),
        }
    }

    /// Forgets the device that was opened, and what was compiled.
    fn close(&mut self) {
        self.opened = None;
        self.d3.engine = None;
        self.d2.engine = None;
    }

    /// Opens the GPU engine for an input of `points` points if it is not open, or says why not to
    /// take it.
    async fn open_if_it_pays<const D: usize>(&mut self, adapter: &AdapterChoice, points: usize) -> Result<(), Fallback>
    where
        Dimension<D>: Choice<D>,
    {
        if let Some(why) = &self.unusable {
            return Err(why.clone());
        }
        if let Some(gpu) = &self.opened {
            self.check_usable(gpu)?;
        }
        if Dimension::<D>::slot(self).engine.is_some() {
            return Ok(());
        }
        let missing = Dimension::<D>::OPENING_POINTS.saturating_sub(Dimension::<D>::slot(self).points_seen);
        if points < missing && self.caller_supplied.is_none() {
            Dimension::<D>::slot(self).points_seen += points;
            return Err(Fallback::FewPoints { points, least: missing });
        }
        let opened = match self.device(adapter).await {
            Ok(gpu) => match self.check_usable(&gpu) {
                Ok(()) => GpuEngine::new(gpu).await.map_err(Fallback::NoGpu),
                Err(why) => Err(why),
            },
            Err(error) => Err(Fallback::NoGpu(error)),
        };
        match opened {
            Ok(engine) => {
                Dimension::<D>::slot(self).engine = Some(engine);
                Ok(())
            }
            Err(why) => {
                self.opened = None;
                Err(self.unusable.insert(why).clone())
            }
        }
    }

    /// Runs the GPU engine, which is open. If its device gets lost, the next run has to open
    /// another.
    async fn run<const D: usize, L: Deliver<D>>(
        &mut self,
        points: Points<'_, D>,
        options: &Options,
        to: &mut L,
    ) -> Result<L::Output, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let Some(engine) = &mut Dimension::<D>::slot(self).engine else {
            return Err(Error::NoAdapter { reason: "it is not open".to_owned() });
        };
        let options = &options.monotone();
        let result = async {
            let mesh = engine.make(points, options, to.destination()).await?;
            let delivered = to.deliver(mesh, Some(engine.gpu().clone())).await?;
            options.report(Phase::Finish, 1.0)?;
            Ok(delivered)
        };
        let result = result.await;
        self.forget_if_lost(&result);
        result
    }

    /// Forgets the device if `result` says that it is lost: the next run opens another.
    fn forget_if_lost<T>(&mut self, result: &Result<T, Error>) {
        if matches!(result, Err(Error::DeviceLost { .. })) {
            self.close();
            self.caller_supplied = None;
        }
    }

    /// Says why [`Backend::Auto`] cannot use this device: an adapter that is software is of no use
    /// to it, unless the caller supplied it.
    fn check_usable(&self, gpu: &Gpu) -> Result<(), Fallback> {
        match gpu.adapter().software && self.caller_supplied.is_none() {
            true => Err(Fallback::SoftwareGpu(gpu.adapter().name.clone())),
            false => Ok(()),
        }
    }
}
