// Lists simplices to start from, with the places of their first vertices along the curve.
//!include common/query
@group(0) @binding(1) var<storage, read> input: array<u32>;
//!include {dim}/query_simplices
@group(0) @binding(4) var<storage, read_write> pairs: array<vec2u>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < params.starts; i += groups.x * WORKGROUP) {
        pairs[i] = vec2u(curve_key(corner(i * START_STRIDE, 0)), i * START_STRIDE);
    }
}
