// Writes the answer: triangles of input indices and their neighbours without gaps, and the edges of the hull. One
// invocation a slot.
//!include shared/plane_layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
// The number of each triangle of the answer: where the next slot has another one. The last slot is never used.
@group(0) @binding(4) var<storage, read> offsets: array<u32>;
// Three corners a triangle.
@group(0) @binding(5) var<storage, read_write> corners: array<u32>;
// Entry 3·t + k is across the edge opposite corner k: 3·triangle + the corner opposite to it there, or NONE.
@group(0) @binding(6) var<storage, read_write> across: array<u32>;
// The ends of each edge of the hull, in no order, with the triangulation on the left.
@group(0) @binding(7) var<storage, read_write> hull: array<vec2u>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t + 1 < control.blocks * BLOCK; t += groups.x * 256) {
        let number = offsets[t];
        if offsets[t + 1] == number {
            continue;
        }
        let tri = triangles[t];
        let near = neighbors[t];
        let points = vec3u(pairs[tri.x].y, pairs[tri.y].y, pairs[tri.z].y);
        for (var k = 0u; k < 3; k++) {
            let u = near[k] >> 2;
            let there = offsets[u];
            let outside = offsets[u + 1] == there;
            corners[3 * number + k] = points[k];
            across[3 * number + k] = select(3 * there + (near[k] & 3), NONE, outside);
            if outside {
                hull[atomicAdd(&control.hull, 1u)] = vec2u(points[(k + 1) % 3], points[(k + 2) % 3]);
            }
        }
    }
}
