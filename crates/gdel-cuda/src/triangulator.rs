//! Triangulations of points in CUDA memory.

use crate::{device::Device, mesh::CudaMesh, tensor::Tensor};
use gdel::{Backend, Error, Progress, Triangulator};
use std::{ops::ControlFlow, sync::Arc};

/// Triangulates points in CUDA memory on the GPU that has them. Clones share what they have opened.
#[derive(Debug, Clone)]
pub struct CudaTriangulator {
    device: Arc<Device>,
    triangulator: Triangulator,
}

impl CudaTriangulator {
    /// Opens the GPU of this number among those of CUDA, in its primary context, which other libraries use, too.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NoAdapter`] where there is no CUDA, no such GPU, or no driver for Vulkan on it.
    pub fn new(ordinal: usize) -> Result<Self, Error> {
        let device = Device::open(ordinal)?;
        let triangulator = Triangulator::from_gpu(device.gpu.clone());
        Ok(CudaTriangulator { device: Arc::new(device), triangulator })
    }

    /// Sets which backend computes, as [`Triangulator::backend`] does. What the CPU computes is uploaded.
    #[must_use]
    pub fn backend(mut self, backend: Backend) -> Self {
        self.triangulator = self.triangulator.backend(backend);
        self
    }

    /// Sets a function that is called during runs and can cancel them, as [`Triangulator::on_progress`] does.
    #[must_use]
    pub fn on_progress(mut self, on_progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static) -> Self {
        self.triangulator = self.triangulator.on_progress(on_progress);
        self
    }
}

/// Implements the methods of a dimension.
macro_rules! in_dimension {
    ($D:literal, $delaunay:ident, $update:ident) => {
        impl CudaTriangulator {
            #[doc = concat!("Returns the ", $D, "D Delaunay triangulation of `points`. Blocks the thread.")]
            ///
            /// # Errors
            ///
            #[doc = concat!("Returns the errors of [`Triangulator::", stringify!($delaunay), "`], and [`Error::Gpu`] for points")]
            /// on another GPU or with another number of coordinates.
            pub fn $delaunay(&self, points: &Tensor) -> Result<CudaMesh<$D>, Error> {
                let host = points.read::<$D>(&self.device)?;
                let mesh = self.triangulator.device()?.$delaunay(host.points())?;
                Ok(CudaMesh::new(self.device.clone(), mesh))
            }

            /// Updates a mesh to points that have moved, as [`Triangulator::update`] does. Arrays that were returned
            /// before stay as they are.
            ///
            /// # Errors
            ///
            /// Returns the errors of [`Triangulator::update`], and [`Error::Gpu`] for points on another GPU or with
            /// another number of coordinates.
            pub fn $update(&self, mesh: &mut CudaMesh<$D>, points: &Tensor) -> Result<(), Error> {
                let host = points.read::<$D>(&self.device)?;
                mesh.update(|mesh| self.triangulator.update(mesh, host.points()))
            }
        }
    };
}
in_dimension!(3, delaunay3d, update3d);
in_dimension!(2, delaunay2d, update2d);
