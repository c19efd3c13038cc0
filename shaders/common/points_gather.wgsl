// Writes the vertices: the points' lattice coordinates, in the order of the sorted pairs.
//!include common/input

@group(0) @binding(0) var<storage, read> params: InputParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
//!include common/pairs
// The vertex of each point.
@group(0) @binding(4) var<storage, read_write> vertex_of: array<u32>;
//!include {dim}/points_gather

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < params.count; v += groups.x * WORKGROUP) {
        let point = pairs[v].y;
        write_vertex(v, point, lattice_point(point));
        vertex_of[point] = v;
    }
}
