// Makes the first triangles, lists all points and locates them there. One invocation a point.
//!include shared/plane_layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
// Key and point of each vertex; the key of points that others stand for is UNITED.
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
// The words of InputCounts.
@group(0) @binding(3) var<storage, read> counts: array<u32>;
@group(0) @binding(4) var<storage, read_write> waiting: array<Waiting>;
@group(0) @binding(5) var<storage, read_write> triangles: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> neighbors: array<vec4u>;
//!include shared/plane_signs
//!include shared/plane_child_of

const UNITED: u32 = 0xffffffff;
const COUNT_UNITED: u32 = 0;
const COUNT_FOUND: u32 = 8;

// The first triangle, and beyond its edge k the infinite one of the edge's ends and infinity, in the slots after.
fn make_first(first: vec3u, infinite: u32) {
    let base = infinite * PLANE_BLOCK;
    triangles[base] = vec4u(first, 0);
    neighbors[base] = vec4u(4 * (vec3u(base) + vec3u(1, 2, 3)) + 2, 0);
    for (var k = 0u; k < 3; k++) {
        let next = (k + 1) % 3;
        let previous = (k + 2) % 3;
        triangles[base + 1 + k] = vec4u(first[previous], first[next], infinite, 0);
        neighbors[base + 1 + k] = vec4u(4 * (base + 1 + previous) + 1, 4 * (base + 1 + next), 4 * base + k, 0);
    }
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let first = vec3u(counts[COUNT_FOUND], counts[COUNT_FOUND + 1], counts[COUNT_FOUND + 2]);
    let infinite = control.infinite;
    for (var p = id.x; p < infinite; p += groups.x * 256) {
        var t = NONE;
        if all(first != vec3u(p)) && pairs[p].x != UNITED {
            // The kernel point, not infinity, whose number it has.
            let k = plane_child_of(first, infinite, p, NONE);
            let beyond = orient_finite(with_vertex(first, k, p)) < 0;
            t = infinite * PLANE_BLOCK + select(0u, 1 + k, beyond);
        }
        waiting[p] = Waiting(p, t);
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
    if id.x == 0 {
        make_first(first, infinite);
        atomicAdd(&control.inserted, 3u);
        control.merged = counts[COUNT_UNITED];
    }
}
