//! Triangulations with options, on the CPU or the GPU.

mod moving;
#[cfg(feature = "gpu")]
mod shared_device;

pub use moving::Moving;

#[cfg(feature = "gpu")]
pub use shared_device::{MIN_POINTS_2D, MIN_POINTS_3D};

#[cfg(all(feature = "gpu", target_arch = "wasm32"))]
use crate::gpu::engine::Made;
#[cfg(feature = "gpu")]
use crate::gpu::{
    AdapterChoice, Gpu,
    device_mesh::{DeviceMesh2, DeviceMesh3},
};
use crate::{
    backend::Backend,
    d2::Mesh2,
    d3::Mesh3,
    error::Error,
    input::points::{Points2, Points3},
    options::{Options, Progress, Winding},
};
#[cfg(any(not(feature = "gpu"), target_arch = "wasm32"))]
use crate::{
    cpu::{self, Incremental, MeshOf},
    dimension::Dimension,
    input::points::Points,
    mesh::MeshInfo,
    stats::Fallback,
};
#[cfg(feature = "gpu")]
use shared_device::SharedDevice;
use std::{num::NonZeroUsize, ops::ControlFlow, sync::Arc};

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
    #[cfg(feature = "gpu")]
    device: Arc<SharedDevice>,
}

impl Triangulator {
    /// Creates a triangulator with [`Backend::Auto`] on the adapter that the system recommends.
    pub fn new() -> Self {
        Triangulator::default()
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
    /// was cloned from.
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
        self.device = shared(SharedDevice::new(adapter));
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
    /// [`Error::AdapterNotFound`], [`Error::DeviceLost`], [`Error::OutOfDeviceMemory`],
    /// [`Error::BufferTooLarge`] and [`Error::Gpu`].
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

    /// Returns the 3D Delaunay triangulation of `points`, and waits for the GPU without blocking
    /// the thread.
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
        self.delaunay3d_into_async(points, &mut mesh).await?;
        Ok(mesh)
    }

    /// Returns the 2D Delaunay triangulation of `points`, and waits for the GPU without blocking
    /// the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub async fn delaunay2d_async<'a>(&self, points: impl Into<Points2<'a>>) -> Result<Mesh2, Error> {
        let mut mesh = Mesh2::default();
        self.delaunay2d_into_async(points, &mut mesh).await?;
        Ok(mesh)
    }

    /// Makes `mesh` the 3D Delaunay triangulation of `points`, whatever it was before. The GPU backend
    /// writes the tetrahedra and their neighbours into the memory that their vectors have, as far as it
    /// suffices, which saves a program with many inputs from taking fresh memory for each. The CPU backend
    /// makes vectors of its own. After an error the mesh is empty. Blocks the thread.
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
        #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
        {
            pollster::block_on(self.device.triangulate(points.into(), &self.options, mesh))
        }
        #[cfg(any(not(feature = "gpu"), target_arch = "wasm32"))]
        without_gpu(points.into(), &self.options, mesh)
    }

    /// Makes `mesh` the 2D Delaunay triangulation of `points`, whatever it was before, as
    /// [`delaunay3d_into`](Triangulator::delaunay3d_into) does in 3D. Blocks the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub fn delaunay2d_into<'a>(&self, points: impl Into<Points2<'a>>, mesh: &mut Mesh2) -> Result<(), Error> {
        #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
        {
            pollster::block_on(self.device.triangulate(points.into(), &self.options, mesh))
        }
        #[cfg(any(not(feature = "gpu"), target_arch = "wasm32"))]
        without_gpu(points.into(), &self.options, mesh)
    }

    /// Makes `mesh` the 3D Delaunay triangulation of `points`, as
    /// [`delaunay3d_into`](Triangulator::delaunay3d_into) does, and waits for the GPU without blocking the
    /// thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub async fn delaunay3d_into_async<'a>(
        &self,
        points: impl Into<Points3<'a>>,
        mesh: &mut Mesh3,
    ) -> Result<(), Error> {
        #[cfg(feature = "gpu")]
        {
            self.device.triangulate(points.into(), &self.options, mesh).await
        }
        #[cfg(not(feature = "gpu"))]
        self.delaunay3d_into(points, mesh)
    }

    /// Makes `mesh` the 2D Delaunay triangulation of `points`, as
    /// [`delaunay2d_into`](Triangulator::delaunay2d_into) does, and waits for the GPU without blocking the
    /// thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    pub async fn delaunay2d_into_async<'a>(
        &self,
        points: impl Into<Points2<'a>>,
        mesh: &mut Mesh2,
    ) -> Result<(), Error> {
        #[cfg(feature = "gpu")]
        {
            self.device.triangulate(points.into(), &self.options, mesh).await
        }
        #[cfg(not(feature = "gpu"))]
        self.delaunay2d_into(points, mesh)
    }

    /// Makes `mesh` the Delaunay triangulation of `points`: those of the mesh, after they have
    /// moved. Blocks the thread.
    ///
    /// The mesh is that of a run from scratch, except for the order of its simplices: also where
    /// points have become equal or coplanar, have left the hull, or are no duplicates any more.
    /// A mesh on the device is repaired there where that is faster. Otherwise the points are
    /// triangulated from scratch, and [`Stats::update`](crate::stats::Stats::update) says why.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let mut points: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i * i % 101), f64::from(i)]).collect();
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// for step in 0..10 {
    ///     for (i, [x, y]) in points.iter_mut().enumerate() {
    ///         *x += 0.1 * (i as f64).sin();
    ///         *y += 0.1 * (i as f64).cos();
    ///     }
    ///     triangulator.update(&mut mesh, &points)?;
    ///     assert_eq!(mesh.canonical(), gdel::delaunay2d(&points)?.canonical());
    /// }
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], and [`Error::PointCount`] if the mesh is
    /// not one of as many points. After an error the mesh is what it was before.
    pub fn update<'a, M: Moving>(&self, mesh: &mut M, points: impl Into<M::Points<'a>>) -> Result<(), Error> {
        mesh.follow(self, points.into())
    }

    /// Does the same as [`update`](Triangulator::update), and waits for the GPU without blocking
    /// the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::update`].
    pub async fn update_async<'a, M: Moving>(
        &self,
        mesh: &mut M,
        points: impl Into<M::Points<'a>>,
    ) -> Result<(), Error> {
        mesh.follow_async(self, points.into()).await
    }

    /// Inserts points into a mesh. Blocks the thread.
    ///
    /// `points` are all points: first those of the mesh, as they were, then the new ones. The mesh is
    /// that of a run from scratch, except for the order of its simplices: also where new points lie
    /// outside the hull, equal others, or are the first that do not lie in a plane.
    ///
    /// A few points cost what changes around them, and one look at the coordinates of all. Where more
    /// come than it pays to insert one by one (with one thread, about one in twenty), the points are
    /// triangulated from scratch by the backend, and
    /// [`Stats::update`](crate::stats::Stats::update) says why. The mesh has to be that of its points:
    /// only what is near the new ones is checked. A mesh on the device is read, changed by the host,
    /// and uploaded.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let mut points = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0f64]];
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// // The middle of the largest triangle, five times.
    /// for _ in 0..5 {
    ///     let areas: Vec<f64> = mesh.areas(&points).collect();
    ///     let largest = (0..areas.len()).max_by(|&s, &t| areas[s].total_cmp(&areas[t])).unwrap();
    ///     let corners = mesh.triangles[largest].map(|v| points[v as usize]);
    ///     points.push([0, 1].map(|axis| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0));
    ///     triangulator.insert(&mut mesh, &points)?;
    /// }
    /// assert_eq!(mesh.canonical(), gdel::delaunay2d(&points)?.canonical());
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], and [`Error::PointCount`] if there are
    /// fewer points than the mesh has. After an error the mesh is what it was before.
    pub fn insert<'a, M: Moving>(&self, mesh: &mut M, points: impl Into<M::Points<'a>>) -> Result<(), Error> {
        mesh.edit(self, points.into(), &[])
    }

    /// Does the same as [`insert`](Triangulator::insert), and waits for the GPU without blocking the
    /// thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::insert`].
    pub async fn insert_async<'a, M: Moving>(
        &self,
        mesh: &mut M,
        points: impl Into<M::Points<'a>>,
    ) -> Result<(), Error> {
        mesh.edit_async(self, points.into(), &[]).await
    }

    /// Removes the points with these indices from a mesh, which is one of `points`. Blocks the thread.
    ///
    /// The mesh is that of a run from scratch on the points that are left, except for the order of its
    /// simplices; if the removed point stood for others, the lowest of these takes its place. All
    /// points keep their indices. Those that were removed are *unused*: in
    /// [`duplicate_of`](Mesh3::duplicate_of) they are their own duplicates, and nothing depends on
    /// their coordinates any more, except that they have to be finite. Later calls of
    /// [`update`](Triangulator::update), [`insert`](Triangulator::insert) and `remove` leave them
    /// unused. [`Mesh3::compact`] drops them.
    ///
    /// What it costs, and when it is done from scratch, is as for [`insert`](Triangulator::insert),
    /// where one point that is removed counts for 3 that are inserted, or 12 in 2D.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator, stats::Restart};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [2.0, 1.0f64]];
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// triangulator.remove(&mut mesh, &points, &[4])?;
    /// assert_eq!((mesh.triangles.len(), mesh.is_unused(4)), (2, true));
    /// assert_eq!(mesh.stats.update.map(|update| (update.removed, update.restarted)), Some((1, None)));
    /// // What is left has no triangles.
    /// triangulator.remove(&mut mesh, &points, &[0, 1])?;
    /// assert_eq!((mesh.triangles.len(), mesh.dimension, mesh.hull.as_slice()), (0, 1, &[3, 2][..]));
    /// assert_eq!(mesh.stats.update.and_then(|update| update.restarted), Some(Restart::Degenerate));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], [`Error::PointCount`] if the mesh is not
    /// one of as many points, and [`Error::BadIndex`] if an index is not below their number, is given
    /// twice, or was removed before. After an error the mesh is what it was before.
    pub fn remove<'a, M: Moving>(
        &self,
        mesh: &mut M,
        points: impl Into<M::Points<'a>>,
        indices: &[u32],
    ) -> Result<(), Error> {
        mesh.edit(self, mesh.as_many(points.into())?, indices)
    }

    /// Does the same as [`remove`](Triangulator::remove), and waits for the GPU without blocking the
    /// thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::remove`].
    pub async fn remove_async<'a, M: Moving>(
        &self,
        mesh: &mut M,
        points: impl Into<M::Points<'a>>,
        indices: &[u32],
    ) -> Result<(), Error> {
        mesh.edit_async(self, mesh.as_many(points.into())?, indices).await
    }

    /// Returns the 3D Delaunay triangulation of `points` as a mesh that stays on the device, which
    /// is opened whatever the backend is. Blocks the thread.
    ///
    /// What is left to the CPU, because of the backend or [`Stats::fallback`], is uploaded.
    ///
    /// [`Stats::fallback`]: crate::stats::Stats::fallback
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], and those of the GPU with every backend.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn delaunay3d_on_device<'a>(&self, points: impl Into<Points3<'a>>) -> Result<DeviceMesh3, Error> {
        pollster::block_on(self.delaunay3d_on_device_async(points))
    }

    /// Does the same as `delaunay3d_on_device`, and waits for the GPU without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `delaunay3d_on_device`.
    #[cfg(feature = "gpu")]
    pub async fn delaunay3d_on_device_async<'a>(&self, points: impl Into<Points3<'a>>) -> Result<DeviceMesh3, Error> {
        self.device.delaunay3d_on_device(points.into(), &self.options).await
    }

    /// Returns the 2D Delaunay triangulation of `points` as a mesh that stays on the device, which
    /// is opened whatever the backend is. Blocks the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `delaunay3d_on_device`.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn delaunay2d_on_device<'a>(&self, points: impl Into<Points2<'a>>) -> Result<DeviceMesh2, Error> {
        pollster::block_on(self.delaunay2d_on_device_async(points))
    }

    /// Does the same as `delaunay2d_on_device`, and waits for the GPU without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `delaunay3d_on_device`.
    #[cfg(feature = "gpu")]
    pub async fn delaunay2d_on_device_async<'a>(&self, points: impl Into<Points2<'a>>) -> Result<DeviceMesh2, Error> {
        self.device.delaunay2d_on_device(points.into(), &self.options).await
    }

    /// Returns the 3D Delaunay triangulation of the points in a buffer of the device that this
    /// triangulator was [created from](Triangulator::from_device), as a mesh that stays there.
    /// Blocks the thread.
    ///
    /// `points` is an array of `f32`, three per point and nothing else, of the usage
    /// [`COPY_SRC`](wgpu::BufferUsages::COPY_SRC). Commands that write it have to be submitted
    /// before. It is read back, since the host decides what rounding leaves open.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d_on_device`], [`Error::NotWholePoints`], and
    /// [`Error::Gpu`] for a buffer of another device or usage.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn delaunay3d_of_buffer(&self, points: &wgpu::Buffer) -> Result<DeviceMesh3, Error> {
        pollster::block_on(self.delaunay3d_of_buffer_async(points))
    }

    /// Does the same as `delaunay3d_of_buffer`, and waits for the GPU without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `delaunay3d_of_buffer`.
    #[cfg(feature = "gpu")]
    pub async fn delaunay3d_of_buffer_async(&self, points: &wgpu::Buffer) -> Result<DeviceMesh3, Error> {
        self.device.delaunay3d_of_buffer(points, &self.options).await
    }

    /// [Updates](Triangulator::update) a 3D mesh to the points in a buffer of its device, which are
    /// as [`delaunay3d_of_buffer`](Triangulator::delaunay3d_of_buffer) takes them. Blocks the
    /// thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::update`] and of
    /// [`Triangulator::delaunay3d_of_buffer`].
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn update3d_of_buffer(&self, mesh: &mut DeviceMesh3, points: &wgpu::Buffer) -> Result<(), Error> {
        pollster::block_on(self.update3d_of_buffer_async(mesh, points))
    }

    /// Does the same as `update3d_of_buffer`, and waits for the GPU without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `update3d_of_buffer`.
    #[cfg(feature = "gpu")]
    pub async fn update3d_of_buffer_async(&self, mesh: &mut DeviceMesh3, points: &wgpu::Buffer) -> Result<(), Error> {
        let points = self.device.read_points(points).await?;
        mesh.follow_async(self, (&points).into()).await
    }

    /// Does the same in 2D, with two coordinates per point.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::update3d_of_buffer`].
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn update2d_of_buffer(&self, mesh: &mut DeviceMesh2, points: &wgpu::Buffer) -> Result<(), Error> {
        pollster::block_on(self.update2d_of_buffer_async(mesh, points))
    }

    /// Does the same as `update2d_of_buffer`, and waits for the GPU without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `update3d_of_buffer`.
    #[cfg(feature = "gpu")]
    pub async fn update2d_of_buffer_async(&self, mesh: &mut DeviceMesh2, points: &wgpu::Buffer) -> Result<(), Error> {
        let points = self.device.read_points(points).await?;
        mesh.follow_async(self, (&points).into()).await
    }

    /// Does the same in 2D, with two coordinates per point.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d_of_buffer`].
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub fn delaunay2d_of_buffer(&self, points: &wgpu::Buffer) -> Result<DeviceMesh2, Error> {
        pollster::block_on(self.delaunay2d_of_buffer_async(points))
    }

    /// Does the same as `delaunay2d_of_buffer`, and waits for the GPU without blocking the thread.
    ///
    /// # Errors
    ///
    /// Returns the errors of `delaunay2d_of_buffer`.
    #[cfg(feature = "gpu")]
    pub async fn delaunay2d_of_buffer_async(&self, points: &wgpu::Buffer) -> Result<DeviceMesh2, Error> {
        self.device.delaunay2d_of_buffer(points, &self.options).await
    }

    /// Triangulates in 3D, and has `deliver` take the mesh where it was made, or, if `resident`, on
    /// the device: [`Backend::Auto`] takes the CPU if the GPU fails before that is done. A mesh that
    /// is `resident` goes on from `moved`, the mesh of the points where they were, if there is one.
    #[doc(hidden)]
    #[cfg(all(feature = "gpu", target_arch = "wasm32"))]
    pub async fn deliver3d<R>(
        &self,
        points: Points3<'_>,
        resident: bool,
        moved: Option<&DeviceMesh3>,
        deliver: impl AsyncFn(Made<3>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        self.device.deliver(points, &self.options, resident, moved, deliver).await
    }

    /// Does the same in 2D.
    #[doc(hidden)]
    #[cfg(all(feature = "gpu", target_arch = "wasm32"))]
    pub async fn deliver2d<R>(
        &self,
        points: Points2<'_>,
        resident: bool,
        moved: Option<&DeviceMesh2>,
        deliver: impl AsyncFn(Made<2>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        self.device.deliver(points, &self.options, resident, moved, deliver).await
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

/// Shares a device among clones.
#[cfg(feature = "gpu")]
#[cfg_attr(
    target_arch = "wasm32",
    expect(clippy::arc_with_non_send_sync, reason = "only in browsers do wgpu's types belong to one thread")
)]
fn shared(device: SharedDevice) -> Arc<SharedDevice> {
    Arc::new(device)
}

/// Makes `mesh` that of `points` where no GPU can be used: because it is not compiled in, or because a
/// browser's cannot be waited for. After an error the mesh is empty.
#[cfg(any(not(feature = "gpu"), target_arch = "wasm32"))]
fn without_gpu<const D: usize>(points: Points<'_, D>, options: &Options, mesh: &mut MeshOf<D>) -> Result<(), Error>
where
    Dimension<D>: Incremental<D>,
{
    *mesh = MeshOf::<D>::default();
    #[cfg(feature = "gpu")]
    let reason = "a browser's GPU cannot be waited for; use the methods that end in `_async`";
    #[cfg(not(feature = "gpu"))]
    let reason = "gdel was built without the feature `gpu`";
    let unavailable = Error::GpuUnavailable { reason };
    match options.backend {
        Backend::Cpu => *mesh = cpu::delaunay(points, options)?,
        Backend::Gpu => return Err(unavailable),
        Backend::Auto => {
            *mesh = cpu::delaunay(points, options)?;
            mesh.stats_mut().fallback = Some(Fallback::NoGpu(unavailable));
        }
    }
    Ok(())
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
pub fn adapters() -> Vec<crate::gpu::AdapterSummary> {
    pollster::block_on(crate::gpu::adapters())
}
