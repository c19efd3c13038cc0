// Writes the mesh: triangles of input indices and their half-edges without gaps, as Mesh2 has them,
// and the half-edges of the hull; all of them turned over where the host wants a clockwise mesh.
// One invocation per slot.
//!include d2/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
// The number of each triangle of the mesh: a slot holds one if the next slot has another number.
// The last slot is never used.
@group(0) @binding(4) var<storage, read> numbers: array<u32>;
// Three vertices per triangle.
@group(0) @binding(5) var<storage, read_write> mesh_triangles: array<u32>;
// For each half-edge the one that runs against it, or NONE.
@group(0) @binding(6) var<storage, read_write> halfedges: array<u32>;
// From where to where each half-edge of the hull goes, in no order.
@group(0) @binding(7) var<storage, read_write> hull: array<vec2u>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let clockwise = control.clockwise != 0;
    for (var t = id.x; t + 1 < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let number = numbers[t];
        if numbers[t + 1] == number {
            continue;
        }
        // The half-edge from vertex k of (a, b, c) is the edge opposite vertex k + 2. Turned over,
        // (a, b, c) is (a, c, b), whose half-edge from vertex k is the edge opposite vertex (1, 0,
        // 2)[k] of (a, b, c), and the other way round.
        let halfedge_of_edge = select(vec3u(1, 2, 0), vec3u(1, 0, 2), clockwise);
        let tri = select(simplices[t].xyz, simplices[t].xzy, clockwise);
        let near = select(neighbors[t].zxy, neighbors[t].yxz, clockwise);
        let points = vec3u(pairs[tri.x].y, pairs[tri.y].y, pairs[tri.z].y);
        for (var k = 0u; k < 3; k++) {
            let u = near[k] >> 2;
            let there = numbers[u];
            let outside = numbers[u + 1] == there;
            mesh_triangles[3 * number + k] = points[k];
            halfedges[3 * number + k] = select(3 * there + halfedge_of_edge[near[k] & 3], NONE, outside);
            if outside {
                hull[atomicAdd(&control.hull, 1u)] = vec2u(points[k], points[(k + 1) % 3]);
            }
        }
    }
}
