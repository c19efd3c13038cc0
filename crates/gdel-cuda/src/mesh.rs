//! Meshes in CUDA memory.

use crate::{array::MeshArray, device::Device};
use gdel::{
    DeviceMesh, Error,
    internals::{dimension::Dimension, gpu::dim::Dim},
    stats::Stats,
    wgpu,
};
use std::sync::Arc;

/// A mesh on the GPU.
#[derive(Debug)]
pub struct CudaMesh<const D: usize> {
    device: Arc<Device>,
    mesh: DeviceMesh<D>,
    /// The simplices before the last update.
    before: Option<wgpu::Buffer>,
}

impl<const D: usize> CudaMesh<D> {
    pub(crate) fn new(device: Arc<Device>, mesh: DeviceMesh<D>) -> Self {
        CudaMesh { device, mesh, before: None }
    }

    /// Updates the mesh, if `update` succeeds.
    pub(crate) fn update(&mut self, update: impl FnOnce(&mut DeviceMesh<D>) -> Result<(), Error>) -> Result<(), Error> {
        let before = self.mesh.simplices().clone();
        update(&mut self.mesh)?;
        self.before = Some(before);
        Ok(())
    }

    /// Returns the number of points.
    pub fn point_count(&self) -> usize {
        self.mesh.point_count()
    }

    /// Returns the number of tetrahedra or triangles.
    pub fn simplex_count(&self) -> usize {
        self.mesh.simplex_count()
    }

    /// Returns the affine dimension of the points.
    pub fn dimension(&self) -> u8 {
        self.mesh.dimension()
    }

    /// Returns for each point the one that stands for it, as [`DeviceMesh::duplicate_of`] does.
    pub fn duplicate_of(&self) -> &[u32] {
        self.mesh.duplicate_of()
    }

    /// Returns how the mesh was computed.
    pub fn stats(&self) -> &Stats {
        self.mesh.stats()
    }

    /// Returns the vertices of the simplices, one row for each.
    pub fn simplices(&self) -> MeshArray {
        MeshArray::new(&self.device, self.mesh.simplices(), self.simplex_count(), D + 1)
    }

    /// Returns the neighbours, one row for each simplex, −1 outside: in 3D the tetrahedra opposite the vertices, in 2D
    /// half-edges, as [`DeviceMesh::neighbors`].
    pub fn neighbors(&self) -> MeshArray {
        MeshArray::new(&self.device, self.mesh.neighbors(), self.simplex_count(), D + 1)
    }

    /// Returns the hull, one row for each facet; in 2D the vertices in their order.
    pub fn hull(&self) -> MeshArray {
        MeshArray::new(&self.device, self.mesh.hull(), self.mesh.hull_count(), if D == 3 { 3 } else { 1 })
    }

    /// Returns the lowest simplex of each point, −1 for those that are no vertices.
    pub fn vertex_simplex(&self) -> MeshArray {
        MeshArray::new(&self.device, self.mesh.vertex_simplex(), self.mesh.point_count(), 1)
    }
}

impl<const D: usize> CudaMesh<D>
where
    Dimension<D>: Dim<D>,
{
    /// Returns where the neighbours of each point start, and one more, and the neighbours of all points, each list in
    /// ascending order.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`DeviceMesh::edges`].
    pub fn adjacency(&self) -> Result<[MeshArray; 2], Error> {
        let edges = self.mesh.edges()?;
        let offsets = MeshArray::new(&self.device, edges.neighbor_offsets(), self.mesh.point_count() + 1, 1);
        let neighbors = MeshArray::new(&self.device, edges.neighbors(), 2 * edges.edge_count(), 1);
        Ok([offsets, neighbors])
    }

    /// Returns for each simplex the one with the same vertices before the last update, −1 where there was none; `None`
    /// for a mesh that was not updated.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`DeviceMesh::survivors`].
    pub fn survivors(&self) -> Result<Option<MeshArray>, Error> {
        let Some(before) = &self.before else { return Ok(None) };
        let survivors = self.mesh.survivors(before)?;
        Ok(Some(MeshArray::new(&self.device, &survivors, self.simplex_count(), 1)))
    }
}
