// The edges of the triangles of a mesh on the device.
//!include d2/query_simplices

// Returns an edge in its direction in triangle t.
fn edge(t: u32, e: u32) -> vec2u {
    return vec2u(corner(t, e), corner(t, select(e + 1, 0u, e == 2)));
}
