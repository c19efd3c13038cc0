// The arrays of a mesh of tetrahedra.
@group(0) @binding(3) var<storage, read> moved_simplices: array<vec4u>;
// -1 outside the hull.
@group(0) @binding(4) var<storage, read> moved_neighbors: array<vec4i>;

// Returns the points of a tetrahedron.
fn moved_points(t: u32) -> vec4u {
    return moved_simplices[t];
}

// Returns what is across facet k of a tetrahedron, as in `neighbors`; NONE outside the hull.
fn moved_across(t: u32, k: u32) -> u32 {
    let u = moved_neighbors[t][k];
    if u < 0 {
        return NONE;
    }
    let back = moved_neighbors[u] == vec4i(i32(t));
    return 4 * u32(u) + select(select(select(3u, 2u, back.z), 1u, back.y), 0u, back.x);
}

// Returns the ghost beyond facet k of a tetrahedron.
fn ghost_beyond(tet: vec4u, k: u32) -> vec4u {
    let c = facet(k);
    return vec4u(tet[c.x], tet[c.y], tet[c.z], control.infinite);
}
