//! Triangulations that stay on a device.

use crate::{
    error::Error,
    gpu::device_mesh::{DeviceMesh2, DeviceMesh3},
    input::points::{Points2, Points3},
    triangulator::{Editable, Triangulator, wait::wait},
};

/// Triangulates into meshes that stay on a device, with the options of the
/// [`Triangulator`] that it was [made of](Triangulator::device).
///
/// What is left to the CPU, because of the backend or
/// [`Stats::fallback`](crate::stats::Stats::fallback), is uploaded. Such meshes are changed by
/// [`Triangulator::update`], [`insert`](Triangulator::insert) and [`remove`](Triangulator::remove).
///
/// Points may come in a buffer of the device that the triangulator was
/// [created from](Triangulator::from_device): an array of `f32`, three per point in 3D and two in 2D,
/// and nothing else, of the usage [`COPY_SRC`](wgpu::BufferUsages::COPY_SRC). Commands that write it
/// have to be submitted before. It is read back, since the host decides what rounding leaves open.
///
/// # Examples
///
/// ```
/// use gdel::{Outputs, Triangulator};
///
/// let points: Vec<[f32; 2]> = (0..1000).map(|i| [(i * i % 997) as f32, i as f32]).collect();
/// // Without a GPU, that is an error.
/// if let Ok(device) = Triangulator::new().device() {
///     let mesh = device.delaunay2d(&points)?;
///     assert_eq!(mesh.read(Outputs::SIMPLICES)?.triangles.len(), mesh.simplex_count());
/// }
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct DeviceTriangulator {
    triangulator: Triangulator,
}

impl DeviceTriangulator {
    /// Opens the device of a triangulator, unless that was done.
    pub(super) async fn open(triangulator: Triangulator) -> Result<Self, Error> {
        triangulator.device.open().await?;
        Ok(DeviceTriangulator { triangulator })
    }

    /// Returns the 3D Delaunay triangulation of `points`. Blocks the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error};
    ///
    /// fn count(device: &DeviceTriangulator, points: &[[f32; 3]]) -> Result<usize, Error> {
    ///     Ok(device.delaunay3d(points)?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], and those of the GPU with every backend.
    pub fn delaunay3d<'a>(&self, points: impl Into<Points3<'a>>) -> Result<DeviceMesh3, Error> {
        wait(self.delaunay3d_async(points))
    }

    /// Returns the 2D Delaunay triangulation of `points`. Blocks the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error};
    ///
    /// fn count(device: &DeviceTriangulator, points: &[[f32; 2]]) -> Result<usize, Error> {
    ///     Ok(device.delaunay2d(points)?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](Self::delaunay3d).
    pub fn delaunay2d<'a>(&self, points: impl Into<Points2<'a>>) -> Result<DeviceMesh2, Error> {
        wait(self.delaunay2d_async(points))
    }

    /// Returns the 3D Delaunay triangulation of the points in a buffer. Blocks the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error, wgpu};
    ///
    /// fn count(device: &DeviceTriangulator, points: &wgpu::Buffer) -> Result<usize, Error> {
    ///     Ok(device.delaunay3d_from_buffer(points)?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](Self::delaunay3d), [`Error::NotWholePoints`], and
    /// [`Error::Gpu`] for a buffer of another device or usage.
    pub fn delaunay3d_from_buffer(&self, points: &wgpu::Buffer) -> Result<DeviceMesh3, Error> {
        wait(self.delaunay3d_from_buffer_async(points))
    }

    /// Returns the 2D Delaunay triangulation of the points in a buffer. Blocks the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error, wgpu};
    ///
    /// fn count(device: &DeviceTriangulator, points: &wgpu::Buffer) -> Result<usize, Error> {
    ///     Ok(device.delaunay2d_from_buffer(points)?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d_from_buffer`](Self::delaunay3d_from_buffer).
    pub fn delaunay2d_from_buffer(&self, points: &wgpu::Buffer) -> Result<DeviceMesh2, Error> {
        wait(self.delaunay2d_from_buffer_async(points))
    }

    /// [Updates](Triangulator::update) a 3D mesh to the points in a buffer. Blocks the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceMesh3, DeviceTriangulator, Error, wgpu};
    ///
    /// fn step(device: &DeviceTriangulator, mesh: &mut DeviceMesh3, moved: &wgpu::Buffer) -> Result<(), Error> {
    ///     device.update3d_from_buffer(mesh, moved)
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::update`] and of
    /// [`delaunay3d_from_buffer`](Self::delaunay3d_from_buffer).
    pub fn update3d_from_buffer(&self, mesh: &mut DeviceMesh3, points: &wgpu::Buffer) -> Result<(), Error> {
        wait(self.update3d_from_buffer_async(mesh, points))
    }

    /// [Updates](Triangulator::update) a 2D mesh to the points in a buffer. Blocks the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceMesh2, DeviceTriangulator, Error, wgpu};
    ///
    /// fn step(device: &DeviceTriangulator, mesh: &mut DeviceMesh2, moved: &wgpu::Buffer) -> Result<(), Error> {
    ///     device.update2d_from_buffer(mesh, moved)
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`update3d_from_buffer`](Self::update3d_from_buffer).
    pub fn update2d_from_buffer(&self, mesh: &mut DeviceMesh2, points: &wgpu::Buffer) -> Result<(), Error> {
        wait(self.update2d_from_buffer_async(mesh, points))
    }

    /// Does the same as [`delaunay3d`](Self::delaunay3d) without blocking the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error};
    ///
    /// async fn count(device: &DeviceTriangulator, points: &[[f32; 3]]) -> Result<usize, Error> {
    ///     Ok(device.delaunay3d_async(points).await?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](Self::delaunay3d).
    pub async fn delaunay3d_async<'a>(&self, points: impl Into<Points3<'a>>) -> Result<DeviceMesh3, Error> {
        self.triangulator.device.resident(points.into(), &self.triangulator.options).await
    }

    /// Does the same as [`delaunay2d`](Self::delaunay2d) without blocking the thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error};
    ///
    /// async fn count(device: &DeviceTriangulator, points: &[[f32; 2]]) -> Result<usize, Error> {
    ///     Ok(device.delaunay2d_async(points).await?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](Self::delaunay3d).
    pub async fn delaunay2d_async<'a>(&self, points: impl Into<Points2<'a>>) -> Result<DeviceMesh2, Error> {
        self.triangulator.device.resident(points.into(), &self.triangulator.options).await
    }

    /// Does the same as [`delaunay3d_from_buffer`](Self::delaunay3d_from_buffer) without blocking the
    /// thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error, wgpu};
    ///
    /// async fn count(device: &DeviceTriangulator, points: &wgpu::Buffer) -> Result<usize, Error> {
    ///     Ok(device.delaunay3d_from_buffer_async(points).await?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d_from_buffer`](Self::delaunay3d_from_buffer).
    pub async fn delaunay3d_from_buffer_async(&self, points: &wgpu::Buffer) -> Result<DeviceMesh3, Error> {
        let points = self.triangulator.device.read_points::<3>(points).await?;
        self.delaunay3d_async(&points).await
    }

    /// Does the same as [`delaunay2d_from_buffer`](Self::delaunay2d_from_buffer) without blocking the
    /// thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceTriangulator, Error, wgpu};
    ///
    /// async fn count(device: &DeviceTriangulator, points: &wgpu::Buffer) -> Result<usize, Error> {
    ///     Ok(device.delaunay2d_from_buffer_async(points).await?.simplex_count())
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d_from_buffer`](Self::delaunay3d_from_buffer).
    pub async fn delaunay2d_from_buffer_async(&self, points: &wgpu::Buffer) -> Result<DeviceMesh2, Error> {
        let points = self.triangulator.device.read_points::<2>(points).await?;
        self.delaunay2d_async(&points).await
    }

    /// Does the same as [`update3d_from_buffer`](Self::update3d_from_buffer) without blocking the
    /// thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceMesh3, DeviceTriangulator, Error, wgpu};
    ///
    /// async fn step(device: &DeviceTriangulator, mesh: &mut DeviceMesh3, moved: &wgpu::Buffer) -> Result<(), Error> {
    ///     device.update3d_from_buffer_async(mesh, moved).await
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`update3d_from_buffer`](Self::update3d_from_buffer).
    pub async fn update3d_from_buffer_async(&self, mesh: &mut DeviceMesh3, points: &wgpu::Buffer) -> Result<(), Error> {
        let points = self.triangulator.device.read_points::<3>(points).await?;
        mesh.update(&self.triangulator, (&points).into()).await
    }

    /// Does the same as [`update2d_from_buffer`](Self::update2d_from_buffer) without blocking the
    /// thread.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{DeviceMesh2, DeviceTriangulator, Error, wgpu};
    ///
    /// async fn step(device: &DeviceTriangulator, mesh: &mut DeviceMesh2, moved: &wgpu::Buffer) -> Result<(), Error> {
    ///     device.update2d_from_buffer_async(mesh, moved).await
    /// }
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`update3d_from_buffer`](Self::update3d_from_buffer).
    pub async fn update2d_from_buffer_async(&self, mesh: &mut DeviceMesh2, points: &wgpu::Buffer) -> Result<(), Error> {
        let points = self.triangulator.device.read_points::<2>(points).await?;
        mesh.update(&self.triangulator, (&points).into()).await
    }
}
