// Exchanges the vertices of each pair: sorted by the second one, they are then sorted by the first.
//!include primitives/workgroup
@group(0) @binding(0) var<storage, read_write> pairs: array<vec2u>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&pairs); i += groups.x * WORKGROUP) {
        pairs[i] = pairs[i].yx;
    }
}
