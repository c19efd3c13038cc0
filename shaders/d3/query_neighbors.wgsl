// The neighbours of the tetrahedra of a mesh on the device.
@group(0) @binding(4) var<storage, read> neighbors: array<vec4i>;

// Returns the tetrahedron opposite vertex k; -1 outside the hull.
fn across(t: u32, k: u32) -> i32 {
    return neighbors[t][k];
}

// Returns how a mesh numbers the facet opposite vertex k.
fn facet_number(k: u32) -> u32 {
    return k;
}
