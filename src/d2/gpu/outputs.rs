//! The arrays of the caller's mesh, on the device: those of the end of Phase 1 are copied, and
//! `vertex_clear` and `vertex_simplex` find a triangle of each point.

use crate::{
    d2::{Mesh2, gpu::aliases::Aliases},
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Recorder, Storage,
        device_mesh::{DeviceArrays, MeshArrays, Outputs, with_len},
        mesh_check::MeshCheck,
        vertex_simplices::VertexSimplices,
    },
    mesh,
};

/// The kernels.
#[derive(Debug)]
pub struct OutputStage {
    vertices: VertexSimplices,
    check: MeshCheck,
}

impl OutputStage {
    /// Creates the kernels.
    pub fn new(compiler: &Compiler<'_>) -> Self {
        OutputStage { vertices: VertexSimplices::new::<2>(compiler), check: MeshCheck::new::<2>(compiler) }
    }

    /// Records that the arrays of the mesh of `points` points are made, but for the hull: its first `triangles` triangles.
    /// Returns what the check of them writes as well.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recorder: &mut Recorder<'_>,
        mesh: &Aliases,
        triangles: usize,
        points: usize,
    ) -> Result<(DeviceArrays, Storage<u32>), Error> {
        let arrays = DeviceArrays::new(gpu, 3, triangles, 0, points)?;
        let mut copy = |from: &wgpu::Buffer, to: &Storage<u32>| {
            let bytes = (to.len() * size_of::<u32>()) as u64;
            if bytes > 0 {
                recorder.encoder().copy_buffer_to_buffer(from, 0, to.buffer(), 0, bytes);
            }
        };
        copy(mesh.triangles.buffer(), &arrays.simplices);
        copy(mesh.halfedges.buffer(), &arrays.neighbors);
        self.vertices.record(gpu, recorder, &arrays);
        let checked = self.check.record::<2>(gpu, recorder, &arrays)?;
        Ok((arrays, checked))
    }
}

impl MeshArrays<2> for Dimension<2> {
    fn words(mesh: &Mesh2) -> [&[u32]; 3] {
        let halfedges = bytemuck::cast_slice(mesh.halfedges.as_flattened());
        [mesh.triangles.as_flattened(), halfedges, &mesh.hull]
    }

    fn vertex_simplex(mesh: &Mesh2) -> Vec<u32> {
        mesh::vertex_simplex(&mesh.triangles, mesh.duplicate_of.len())
    }

    fn make_room(mesh: &mut Mesh2, outputs: Outputs, simplices: usize, hull: usize) -> Result<[&mut [u8]; 3], Error> {
        let len = |output: Outputs, len: usize| if outputs.contains(output) { len } else { 0 };
        Ok([
            with_len(&mut mesh.triangles, len(Outputs::SIMPLICES, simplices))?,
            with_len(&mut mesh.halfedges, len(Outputs::NEIGHBORS, simplices))?,
            with_len(&mut mesh.hull, len(Outputs::HULL, hull))?,
        ])
    }
}
