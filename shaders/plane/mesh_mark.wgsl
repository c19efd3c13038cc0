// Marks the triangles of the answer: finite ones that are not flat. Lists those of which the lattice does not prove
// everything, where a coordinate was rounded: whose orientation, or whose edges' being locally Delaunay, the filter leaves
// open. The filter's bound counts rounding in. One invocation a slot.
//
// Flat triangles, which only the perturbation of the coordinates makes, lie along the hull: a point between two others on
// a line is inside every circle through these, so no triangle that is not flat has them for an edge.
//
// Each edge is looked at from the triangle in the lower slot. That an edge to infinity bounds a finite triangle is a
// matter of this one's orientation.
//!include shared/plane_layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> triangles: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
// The words of InputCounts.
@group(0) @binding(4) var<storage, read> counts: array<u32>;
@group(0) @binding(5) var<storage, read_write> marks: array<u32>;
// Slot; edges (bits 0 to 2) and orientation (bit 3) that are open.
@group(0) @binding(6) var<storage, read_write> doubtful: array<vec2u>;
//!include shared/plane_exact_{width}
//!include shared/plane_filter

const COUNT_ROUNDED: u32 = 2;
const ORIENTATION: u32 = 8;

fn any_rounded(tri: vec3u) -> bool {
    return rounded(tri.x) || rounded(tri.y) || rounded(tri.z);
}

fn orientation_filter(tri: vec3u) -> i32 {
    return orient2d_filter(load_high(tri.x), load_high(tri.y), load_high(tri.z));
}

fn is_flat(tri: vec3u) -> bool {
    let p = load_position(tri.x);
    return sign_of_determinant(determinant(
        difference(load_position(tri.y), p), difference(load_position(tri.z), p)
    )) == 0;
}

fn edge_is_open(tri: vec3u, k: u32, e: u32, infinite: u32) -> bool {
    let at_infinity = tri == vec3u(infinite);
    if e == infinite || at_infinity[k] {
        return false;
    }
    if any(at_infinity) {
        let beyond = select(tri, vec3u(e), at_infinity);
        return any_rounded(beyond) && orientation_filter(beyond) == 0;
    }
    return (any_rounded(tri) || rounded(e))
        && incircle_filter(load_high(tri.x), load_high(tri.y), load_high(tri.z), load_high(e)) == 0;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let infinite = control.infinite;
    let certain = counts[COUNT_ROUNDED] == 0;
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * 256) {
        let tri = triangles[t].xyz;
        let used = any(tri != vec3u(0));
        var kept = used && !any(tri == vec3u(infinite));
        var open = 0u;
        if kept && orientation_filter(tri) == 0 {
            kept = !is_flat(tri);
            open = select(0u, ORIENTATION, !certain && any_rounded(tri));
        }
        marks[t] = u32(kept);
        if used && !certain {
            let near = neighbors[t];
            for (var k = 0u; k < 3; k++) {
                let u = near[k] >> 2;
                if u > t && edge_is_open(tri, k, triangles[u][near[k] & 3], infinite) {
                    open |= 1u << k;
                }
            }
        }
        if open != 0 {
            doubtful[atomicAdd(&control.doubtful, 1u)] = vec2u(t, open);
        }
    }
}
