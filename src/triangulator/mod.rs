//! Triangulations with options, on the CPU or the GPU.

mod constrained;
#[cfg(feature = "gpu")]
mod crossing;
#[cfg(feature = "gpu")]
mod device;
mod editable;
mod edits;
#[cfg(not(feature = "gpu"))]
mod no_device;
mod regular;
#[cfg(feature = "gpu")]
mod shared_device;
#[cfg(feature = "gpu")]
mod state;
mod tin;
mod transport;
mod wait;

#[cfg(feature = "gpu")]
pub use device::DeviceTriangulator;
pub use editable::Editable;
#[cfg(not(feature = "gpu"))]
use no_device::{Choice, SharedDevice};
#[cfg(feature = "gpu")]
use shared_device::{SharedDevice, shared};
#[cfg(feature = "gpu")]
use state::Choice;

#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
use crate::gpu::AdapterSummary;
#[cfg(feature = "gpu")]
use crate::gpu::{AdapterChoice, Gpu};
use crate::{
    backend::Backend,
    cpu::MeshOf,
    d2::Mesh2,
    d3::Mesh3,
    dimension::Dimension,
    error::Error,
    input::points::{Points, Points2, Points3},
    options::{Options, Progress, Winding},
};
use std::{num::NonZeroUsize, ops::ControlFlow, sync::Arc};
use wait::wait;

/// Triangulates with options: which backend computes, what learns of the progress, which device is
/// used.
///
/// A triangulator opens the GPU when it is first needed, and keeps it, with the kernels compiled
/// for it, until the last clone of the triangulator is dropped. So create one and use it for many
/// inputs. Clones are cheap and share the device, which does one run at a time; options set on a
/// clone do not change the original.
///
/// # Examples
///
/// ```
/// use gdel::{Backend, Triangulator};
///
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// let triangulator = Triangulator::new().backend(Backend::Cpu);
/// let mesh = triangulator.delaunay3d(&points)?;
/// assert_eq!(mesh.tetrahedra.len(), 1);
/// # Ok::<(), gdel::Error>(())
/// ```
///
/// Methods that end in `_async` wait for the GPU without blocking the thread: for browsers, where
/// nothing may block, and for executors. What the CPU has to do they do in the calling thread.
#[derive(Debug, Clone, Default)]
pub struct Triangulator {
    options: Options,
    device: Arc<SharedDevice>,
}

impl Triangulator {
    /// Creates a triangulator with [`Backend::Auto`] on the adapter that the system recommends.
    pub fn new() -> Self {
        Triangulator::default()
    }

    /// Returns a triangulator for each GPU of this machine that is hardware, in the order of [`adapters`]; none if there
    /// is only software. Where a GPU has several drivers, only one counts.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Triangulator, tiles::Tile};
    /// # fn step(tiles: &mut [Tile<3, 4>]) -> Result<(), gdel::Error> {
    /// // Each GPU takes the next step of a tile.
    /// let gpus = Triangulator::of_each_gpu();
    /// std::thread::scope(|scope| {
    ///     let steps = gpus.iter().zip(tiles).map(|(gpu, tile)| scope.spawn(|| tile.step_on(gpu, Vec::new())));
    ///     steps.collect::<Vec<_>>();
    /// });
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn of_each_gpu() -> Vec<Triangulator> {
        let adapters = adapters();
        let Some(first) = adapters.iter().find(|adapter| !adapter.software) else { return Vec::new() };
        let numbered = adapters.iter().enumerate();
        let is_one = |&(_, adapter): &(usize, &AdapterSummary)| !adapter.software && adapter.backend == first.backend;
        let choices = numbered.filter(is_one).map(|(index, _)| AdapterChoice::Index(index));
        choices.map(|choice| Triangulator::new().adapter(choice)).collect()
    }

    /// Returns the triangulator of the functions [`delaunay3d`](crate::delaunay3d) and
    /// [`delaunay2d`](crate::delaunay2d), whose device serves the whole process.
    pub(crate) fn of_process() -> Self {
        #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
        {
            static OF_PROCESS: std::sync::LazyLock<Triangulator> = std::sync::LazyLock::new(Triangulator::new);
            OF_PROCESS.clone()
        }
        #[cfg(not(all(feature = "gpu", not(target_arch = "wasm32"))))]
        Triangulator::new()
    }

    /// Creates a triangulator that uses an existing device, for example that of a renderer.
    ///
    /// The limits of the device are taken as they are: WebGPU's defaults suffice, larger buffers
    /// allow larger inputs. Where it has the feature `SHADER_INT64`, exact signs take less time.
    /// [`Backend::Auto`] uses the device even if it is software. Its handlers
    /// for errors and loss remain the caller's, so that losing it is reported as [`Error::Gpu`].
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Error, Triangulator, wgpu};
    ///
    /// # fn triangulate(device: wgpu::Device, queue: wgpu::Queue) -> Result<(), Error> {
    /// let triangulator = Triangulator::from_device(device, queue).backend(Backend::Gpu);
    /// let mesh = triangulator.delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f32]])?;
    /// assert_eq!(mesh.triangles.len(), 1);
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(feature = "gpu")]
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        Triangulator::from_gpu(Gpu::from_device(device, queue))
    }

    #[doc(hidden)]
    #[cfg(feature = "gpu")]
    pub fn from_gpu(gpu: Gpu) -> Self {
        Triangulator { device: shared(SharedDevice::from_gpu(gpu)), ..Triangulator::default() }
    }

    /// Sets which backend computes. The default is [`Backend::Auto`].
    #[must_use]
    pub fn backend(mut self, backend: Backend) -> Self {
        self.options.backend = backend;
        self
    }

    /// Sets how many threads the CPU backend uses, for which it then has a pool of its own; one
    /// thread is the calling one. The default is all threads of
    /// [rayon](https://docs.rs/rayon)'s pool, and so what the environment variable
    /// `RAYON_NUM_THREADS` says. In WebAssembly, and without the feature `threads`, there is always
    /// one. What remains to the CPU of a run on the GPU uses rayon's pool.
    ///
    /// The mesh does not depend on the number, except for the order of its simplices, which with
    /// several threads may differ from run to run.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    /// use std::num::NonZeroUsize;
    ///
    /// let alone = Triangulator::new().backend(Backend::Cpu).threads(NonZeroUsize::MIN);
    /// assert_eq!(alone.delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?.triangles.len(), 1);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[must_use]
    pub fn threads(mut self, threads: NonZeroUsize) -> Self {
        self.options.threads = Some(threads);
        self
    }

    /// Sets which adapter to open. The triangulator no longer shares its device with those that it
    /// was cloned from. If it was [created from a device](Triangulator::from_device), its runs return
    /// [`Error::AdapterOfDevice`].
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{AdapterChoice, Triangulator};
    ///
    /// let triangulator = Triangulator::new().adapter(AdapterChoice::Name("nvidia".to_owned()));
    /// # let _ = triangulator;
    /// ```
    #[cfg(feature = "gpu")]
    #[must_use]
    pub fn adapter(mut self, adapter: AdapterChoice) -> Self {
        self.device = shared(self.device.with_adapter(adapter));
        self
    }

    /// Sets whether a device has to compute meshes that are known before it is used, for this triangulator and those
    /// that share its device. By default hardware has to, once: what has passed is remembered in the user's cache
    /// directory, as long as the driver and this crate stay the same. With `true`, software has to as well. A device
    /// that fails is an [`Error::WrongResults`], and [`Backend::Auto`] takes the CPU.
    ///
    /// # Examples
    ///
    /// ```
    /// let triangulator = gdel::Triangulator::new().self_test(false);
    /// # let _ = triangulator;
    /// ```
    #[cfg(feature = "gpu")]
    #[must_use]
    pub fn self_test(self, self_test: bool) -> Self {
        self.device.set_self_test(self_test);
        self
    }

    /// Sets a function that is called a few hundred times per run: in the calling thread, or in one
    /// of the [`threads`](Triangulator::threads) if their number was set.
    /// [`ControlFlow::Break`] cancels the run, which then returns [`Error::Cancelled`].
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Error, Triangulator};
    /// use std::ops::ControlFlow;
    ///
    /// let cancelled = Triangulator::new()
    ///     .on_progress(|progress| {
    ///         println!("{}: {:.0} %", progress.phase, 100.0 * progress.fraction);
    ///         ControlFlow::Break(())
    ///     })
    ///     .delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]]);
    /// assert_eq!(cancelled.unwrap_err(), Error::Cancelled);
    /// ```
    #[must_use]
    pub fn on_progress(mut self, report: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static) -> Self {
        self.options.on_progress = Some(Arc::new(report));
        self
    }

    /// Sets whether a 3D run on the GPU keeps [`Stats::trace`](crate::stats::Stats::trace).
    ///
    /// All tetrahedra are then read back after every round and their facets tested once more, so a
    /// run takes several times as long. Meant for small inputs.
    #[must_use]
    pub fn trace(mut self, trace: bool) -> Self {
        self.options.trace = trace;
        self
    }

    #[doc(hidden)]
    #[must_use]
    pub fn winding(mut self, winding: Winding) -> Self {
        self.options.winding = winding;
        self
    }

    /// Returns the 3D Delaunay triangulation of `points`. Blocks the thread; in browsers it
    /// therefore uses the CPU only.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](crate::delaunay3d). If the backend is [`Backend::Gpu`],
    /// also those of the GPU: [`Error::GpuUnavailable`], [`Error::NoAdapter`],
    /// [`Error::AdapterNotFound`], [`Error::AdapterOfDevice`], [`Error::DeviceLost`],
    /// [`Error::OutOfDeviceMemory`], [`Error::BufferTooLarge`] and [`Error::Gpu`].
    pub fn delaunay3d<'a>(&self, points: impl Into<Points3<'a>>) -> Result<Mesh3, Error> {
        let mut mesh = Mesh3::default();
        self.delaunay3d_into(points, &mut mesh)?;
        Ok(mesh)
    }

    /// Returns the 2D Delaunay triangulation of `points`. Blocks the thread; in browsers it
    /// therefore uses the CPU only.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub fn delaunay2d<'a>(&self, points: impl Into<Points2<'a>>) -> Result<Mesh2, Error> {
        let mut mesh = Mesh2::default();
        self.delaunay2d_into(points, &mut mesh)?;
        Ok(mesh)
    }

    /// Returns the 3D Delaunay triangulation of `points` without blocking the thread while the GPU
    /// works.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
    /// // Any executor will do.
    /// let mesh = pollster::block_on(gdel::Triangulator::new().delaunay3d_async(&points))?;
    /// assert_eq!(mesh.tetrahedra.len(), 1);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub async fn delaunay3d_async<'a>(&self, points: impl Into<Points3<'a>>) -> Result<Mesh3, Error> {
        let mut mesh = Mesh3::default();
        self.triangulate(points.into(), &mut mesh).await?;
        Ok(mesh)
    }

    /// Returns the 2D Delaunay triangulation of `points` without blocking the thread while the GPU
    /// works.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub async fn delaunay2d_async<'a>(&self, points: impl Into<Points2<'a>>) -> Result<Mesh2, Error> {
        let mut mesh = Mesh2::default();
        self.triangulate(points.into(), &mut mesh).await?;
        Ok(mesh)
    }

    /// Makes `mesh` the 3D Delaunay triangulation of `points`, whatever it was before, and blocks the
    /// thread.
    ///
    /// The GPU backend writes the tetrahedra and their neighbours into the memory of their vectors, as
    /// far as it suffices. That saves a program with many inputs from taking fresh memory for each.
    /// The CPU backend makes new vectors. After an error the mesh is empty.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Mesh3, Triangulator};
    ///
    /// let triangulator = Triangulator::new();
    /// let mut mesh = Mesh3::default();
    /// for height in [1.0, 2.0f64] {
    ///     let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, height]];
    ///     triangulator.delaunay3d_into(&points, &mut mesh)?;
    ///     assert_eq!(mesh.canonical(), [[0, 1, 2, 3]]);
    /// }
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub fn delaunay3d_into<'a>(&self, points: impl Into<Points3<'a>>, mesh: &mut Mesh3) -> Result<(), Error> {
        wait(self.for_blocking()?.triangulate(points.into(), mesh))
    }

    /// Makes `mesh` the 2D Delaunay triangulation of `points`, as
    /// [`delaunay3d_into`](Triangulator::delaunay3d_into) does in 3D.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub fn delaunay2d_into<'a>(&self, points: impl Into<Points2<'a>>, mesh: &mut Mesh2) -> Result<(), Error> {
        wait(self.for_blocking()?.triangulate(points.into(), mesh))
    }

    /// Opens the device, unless that was done, and returns what triangulates into meshes that stay
    /// there, with these options. Blocks the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of the GPU, as [`Triangulator::delaunay3d`] lists them.
    #[cfg(feature = "gpu")]
    pub fn device(&self) -> Result<DeviceTriangulator, Error> {
        wait(self.device_async())
    }

    /// Does the same as [`device`](Triangulator::device) without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::device`].
    #[cfg(feature = "gpu")]
    pub async fn device_async(&self) -> Result<DeviceTriangulator, Error> {
        DeviceTriangulator::open(self.clone()).await
    }

    /// Returns the triangulator that calls use which block.
    fn for_blocking(&self) -> Result<Self, Error> {
        let device = self.device.for_blocking(self.options.backend)?;
        Ok(Triangulator { options: self.options.clone(), device })
    }

    /// Makes `mesh` that of `points`. After an error the mesh is empty.
    async fn triangulate<const D: usize>(&self, points: Points<'_, D>, mesh: &mut MeshOf<D>) -> Result<(), Error>
    where
        Dimension<D>: Choice<D>,
    {
        self.device.triangulate(points, &self.options, mesh).await
    }

    /// Opens the device and compiles the kernels for 3D, unless that was done.
    #[doc(hidden)]
    #[cfg(feature = "gpu")]
    pub async fn gpu(&self) -> Result<Gpu, Error> {
        self.device.gpu().await
    }

    /// Gives the device back now. The next run reopens it.
    #[doc(hidden)]
    #[cfg(feature = "gpu")]
    pub async fn close(&self) {
        self.device.close().await;
    }
}

/// Returns the GPU adapters of this machine, in the order that [`AdapterChoice::Index`] counts.
///
/// On Linux without a desktop, a library of Mesa writes `error: XDG_RUNTIME_DIR is invalid or not set in the
/// environment` when a program looks for a GPU, here or in a [`Triangulator`]. The line is harmless. A program
/// avoids it by being started with `XDG_RUNTIME_DIR` or `WAYLAND_DISPLAY` set to an absolute path; the program
/// `gdel` starts itself again with the latter.
///
/// # Examples
///
/// ```
/// for adapter in gdel::adapters() {
///     println!("{} ({})", adapter.name, adapter.backend);
/// }
/// ```
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub fn adapters() -> Vec<AdapterSummary> {
    pollster::block_on(crate::gpu::adapters())
}
