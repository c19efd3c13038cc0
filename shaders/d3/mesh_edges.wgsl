// The edges of the tetrahedra of a mesh on the device.
//!include d3/query_simplices

// Returns the corners of an edge: 01, 02, 03, 12, 13, 23.
fn edge_corners(e: u32) -> vec2u {
    let first = select(select(2u, 1u, e < 5), 0u, e < 3);
    return vec2u(first, select(select(3u, e - 1, e < 5), e + 1, e < 3));
}

// Returns an edge, with the lower vertex first.
fn edge(t: u32, e: u32) -> vec2u {
    let corners = edge_corners(e);
    let a = corner(t, corners.x);
    let b = corner(t, corners.y);
    return vec2u(min(a, b), max(a, b));
}
