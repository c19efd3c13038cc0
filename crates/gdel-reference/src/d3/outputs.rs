//! The caller's arrays from the mesh of the slots.

use gdel::{NONE, internals::d3::triangulation::FiniteMesh};

fn is_finite(tet: [u32; 4], infinite: u32) -> bool {
    tet != [0; 4] && tet[3] != infinite
}

/// Marks the slots that hold tetrahedra of the mesh. One invocation per slot.
pub fn outputs_mark(tetrahedra: &[[u32; 4]], infinite: u32) -> Vec<u32> {
    tetrahedra.iter().map(|&tet| u32::from(is_finite(tet, infinite))).collect()
}

/// Writes the arrays of the mesh. `numbers` are the exclusive prefix sums of the marks. One
/// invocation per slot.
pub fn outputs_write(tetrahedra: &[[u32; 4]], neighbors: &[[u32; 4]], numbers: &[u32], infinite: u32) -> FiniteMesh {
    let mut mesh = FiniteMesh { tetrahedra: Vec::new(), neighbors: Vec::new(), hull: Vec::new() };
    for (&tet, near) in tetrahedra.iter().zip(neighbors) {
        if tet != [0; 4] && tet[3] == infinite {
            mesh.hull.push([tet[0], tet[1], tet[2]]);
        } else if tet != [0; 4] {
            mesh.tetrahedra.push(tet);
            mesh.neighbors.push(near.map(|facet| {
                let u = (facet >> 2) as usize;
                if is_finite(tetrahedra[u], infinite) { numbers[u] } else { NONE }
            }));
        }
    }
    mesh
}
