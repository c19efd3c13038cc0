// Marks the slots that hold tetrahedra of the mesh. One invocation per slot.
//!include d3/outputs
@group(0) @binding(0) var<storage, read> outputs: OutputParams;
@group(0) @binding(1) var<storage, read> mesh_tetrahedra: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> marks: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < outputs.count; t += groups.x * WORKGROUP) {
        marks[t] = u32(is_finite(mesh_tetrahedra[t], outputs.infinite));
    }
}
