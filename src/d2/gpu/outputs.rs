//! The arrays of a mesh on the device.

use crate::{
    d2::Mesh2,
    dimension::Dimension,
    error::Error,
    gpu::device_mesh::{MeshArrays, Outputs, with_len},
    mesh,
};

impl MeshArrays<2> for Dimension<2> {
    fn words(mesh: &Mesh2) -> [&[u32]; 3] {
        let halfedges = bytemuck::cast_slice(mesh.halfedges.as_flattened());
        [mesh.triangles.as_flattened(), halfedges, &mesh.hull]
    }

    fn vertex_simplex(mesh: &Mesh2) -> Vec<i32> {
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
