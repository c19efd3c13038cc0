// Shared by the kernels that make the caller's mesh. They read the mesh in slots: tetrahedra of input
// indices, ghosts, which have infinity last, and unused slots, which are zero.
//!include primitives/workgroup

struct OutputParams {
    // Slots.
    count: u32,
    // Points, and the vertex at infinity.
    infinite: u32,
    // Tetrahedra of the mesh.
    finite: u32,
    // Facets of its hull.
    hull: u32,
}

fn is_finite(tet: vec4u, infinite: u32) -> bool {
    return any(tet != vec4u(0)) && tet.w != infinite;
}
