// The neighbours of the triangles of a mesh on the device.
@group(0) @binding(4) var<storage, read> neighbors: array<i32>;

// Returns how a mesh numbers the edge opposite vertex k: it leads from the next vertex to the one
// after that.
fn facet_number(k: u32) -> u32 {
    return select(k + 1, 0u, k == 2);
}

// Returns the triangle opposite vertex k; -1 outside the hull. Neighbours are half-edges.
fn across(t: u32, k: u32) -> i32 {
    let halfedge = neighbors[3 * t + facet_number(k)];
    return select(halfedge / 3, -1, halfedge < 0);
}
