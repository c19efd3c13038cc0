// Makes the first simplices, lists all points and locates them there. One invocation per point.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
//!include common/pairs
// The words of InputCounts.
@group(0) @binding(3) var<storage, read> counts: array<u32>;
@group(0) @binding(4) var<storage, read_write> waiting: array<Waiting>;
@group(0) @binding(5) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> neighbors: array<vec4u>;
//!include common/count_words
//!include {dim}/signs
//!include {dim}/child_of
//!include {dim}/locate

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let first = first_simplex();
    let infinite = control.infinite;
    for (var p = id.x; p < infinite; p += groups.x * WORKGROUP) {
        var t = NONE;
        if all(first != Simplex(p)) && pairs[p].x != MERGED_KEY {
            // The interior point, not infinity, whose number it has.
            let k = child_of(first, infinite, p, NONE);
            let beyond = orient_finite(replaced(first, k, p)) < 0;
            t = infinite * SLOTS_PER_POINT + select(0u, 1 + k, beyond);
        }
        waiting[p] = Waiting(p, t);
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
    if id.x == 0 {
        make_first(first, infinite);
        atomicAdd(&control.inserted, CORNERS);
        control.merged = counts[COUNT_MERGED];
    }
}
