// Finds the simplices that are not positively oriented where their points are now, and lists them:
// flips may remove them. One invocation per simplex or ghost.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<Status>;
@group(0) @binding(5) var<storage, read_write> actives: array<Active>;
//!include common/moved_slots
//!include {dim}/moved_signs

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < control.moved_simplices + control.moved_ghosts; i += groups.x * WORKGROUP) {
        let slot = moved_slot(i);
        if orient(unpacked(simplices[slot])) < 0 {
            atomicStore(&status[slot].flags, INVERTED | ((1u << CORNERS) - 1));
            atomicAdd(&control.inverted, 1u);
            actives[atomicAdd(&control.active_len[0], 1u)] = Active(slot, 0);
        }
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}
