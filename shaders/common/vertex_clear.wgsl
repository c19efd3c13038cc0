// Notes that no point has a simplex. One invocation per point.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> vertex_simplices: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < arrayLength(&vertex_simplices); v += groups.x * WORKGROUP) {
        vertex_simplices[v] = NONE;
    }
}
