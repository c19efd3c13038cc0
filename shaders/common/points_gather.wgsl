// Writes the vertices: the points' lattice coordinates, in the order of the sorted pairs.
//!include common/input
//!include common/input_counts

@group(0) @binding(0) var<storage, read> params: InputParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
//!include common/pairs
@group(0) @binding(4) var<storage, read_write> counts: InputCounts;
//!include {dim}/points_gather

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < params.count; v += groups.x * WORKGROUP) {
        let point = pairs[v].y;
        write_vertex(v, point, lattice_point(point));
        for (var k = 0u; k < 4; k++) {
            if counts.stands_for[k] == point {
                counts.found[k] = v;
            }
        }
    }
}
