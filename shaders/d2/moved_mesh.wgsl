// The arrays of a mesh of triangles: three vertices and three half-edges each.
@group(0) @binding(3) var<storage, read> moved_simplices: array<u32>;
// NONE outside the hull.
@group(0) @binding(4) var<storage, read> moved_neighbors: array<u32>;

// Returns the points of a triangle, counter-clockwise.
fn moved_points(t: u32) -> vec3u {
    let tri = vec3u(moved_simplices[3 * t], moved_simplices[3 * t + 1], moved_simplices[3 * t + 2]);
    return select(tri, tri.xzy, control.clockwise != 0);
}

// Returns what is across edge k of a triangle, as in `neighbors`; NONE outside the hull.
//
// The half-edges are numbered as d2/mesh_compact has them.
fn moved_across(t: u32, k: u32) -> u32 {
    let clockwise = control.clockwise != 0;
    let halfedge_of_edge = select(vec3u(1, 2, 0), vec3u(1, 0, 2), clockwise);
    let edge_of_halfedge = select(vec3u(2, 0, 1), vec3u(1, 0, 2), clockwise);
    let across = moved_neighbors[3 * t + halfedge_of_edge[k]];
    return select(4 * (across / 3) + edge_of_halfedge[across % 3], NONE, across == NONE);
}

// Returns the ghost beyond edge k of a triangle.
fn ghost_beyond(tri: vec3u, k: u32) -> vec3u {
    return vec3u(tri[(k + 2) % 3], tri[(k + 1) % 3], control.infinite);
}
