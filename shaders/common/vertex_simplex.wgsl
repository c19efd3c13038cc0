// Notes the lowest simplex of each point. One invocation per corner of a simplex.
//!include {dim}/simplex
// The vertices of the simplices, CORNERS each.
@group(0) @binding(0) var<storage, read> corners: array<u32>;
// The output of vertex_clear; NONE remains for points that are vertices of none.
@group(0) @binding(1) var<storage, read_write> vertex_simplices: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&corners); i += groups.x * WORKGROUP) {
        let v = corners[i];
        let simplex = i / CORNERS;
        // Most simplices of a point are not the lowest, and a load is cheaper.
        if atomicLoad(&vertex_simplices[v]) > simplex {
            atomicMin(&vertex_simplices[v], simplex);
        }
    }
}
