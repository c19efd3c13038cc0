// Marks the slots that hold finite tetrahedra. One invocation per slot.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> marks: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        let tet = simplices[t];
        marks[t] = select(1u, 0u, all(tet == vec4u(0)) || any(tet == vec4u(control.infinite)));
    }
}
