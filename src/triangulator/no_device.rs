//! What clones of a triangulator share in a build without the feature `gpu`: nothing.

use crate::{
    backend::Backend,
    cpu::{self, MeshOf},
    dimension::Dimension,
    error::Error,
    input::points::Points,
    mesh::MeshInfo,
    options::Options,
    stats::Fallback,
};
use std::sync::Arc;

pub use crate::cpu::Incremental as Choice;

/// No device.
#[derive(Debug, Default)]
pub(super) struct SharedDevice;

impl SharedDevice {
    /// Returns what calls that block use.
    pub(super) fn for_blocking(self: &Arc<Self>, _: Backend) -> Result<Arc<Self>, Error> {
        Ok(self.clone())
    }

    /// Makes `mesh` that of `points`. After an error the mesh is empty.
    pub(super) async fn triangulate<const D: usize>(
        &self,
        points: Points<'_, D>,
        options: &Options,
        mesh: &mut MeshOf<D>,
    ) -> Result<(), Error>
    where
        Dimension<D>: Choice<D>,
    {
        *mesh = MeshOf::<D>::default();
        let unavailable = Error::GpuUnavailable { reason: "gdel was built without the feature `gpu`" };
        if options.backend == Backend::Gpu {
            return Err(unavailable);
        }
        *mesh = cpu::delaunay(points, options)?;
        if options.backend == Backend::Auto {
            mesh.stats_mut().fallback = Some(Fallback::NoGpu(unavailable));
        }
        Ok(())
    }
}
