// Writes the vertices: the points' lattice coordinates, in their order.
//!include common/query
@group(0) @binding(1) var<storage, read> input: array<u32>;
//!include {dim}/points_gather

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < params.count; v += groups.x * WORKGROUP) {
        write_vertex(v, v, lattice_point(v));
    }
}
