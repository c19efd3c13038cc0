// Whether facets of tetrahedra are locally Delaunay, as far as the filter decides.
//!include d3/signs_filtered

// Returns a positive sign if e is inside the circumsphere of a tetrahedron; 0 if that is undecided.
fn violation(tet: vec4u, e: u32) -> i32 {
    return conflict(tet, e);
}
