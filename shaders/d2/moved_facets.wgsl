// Whether edges of triangles are locally Delaunay.
//!include d2/signs

// Returns a positive sign if e is inside the circumcircle of a triangle, never 0.
fn violation(tri: vec3u, e: u32) -> i32 {
    return select(-1, 1, inside(tri, e));
}
