// Moves the waiting points of split simplices into the children. One invocation per entry of the
// list of waiting points.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<Status>;
@group(0) @binding(5) var<storage, read> picks: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> waiting: array<Waiting>;
//!include common/waiting
//!include {dim}/signs
//!include {dim}/child_of

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entries = control.entries;
    let list = waiting_list();
    let held = control.round << HELD_SHIFT;
    for (var i = id.x; i < entries; i += groups.x * WORKGROUP) {
        let entry = waiting[list + i];
        let t = entry.tet;
        if t != NONE {
            let p = picks[t].y - 1;
            if p == entry.point {
                waiting[list + i].tet = NONE;
            } else {
                // Child 0 is in slot t and has p for its vertex 0; child 1 has that vertex.
                let parent = replaced(unpacked(simplices[t]), 0, simplices[child_slot(t, p, 1)].x);
                let slot = child_slot(t, p, child_of(parent, p, entry.point, control.infinite));
                waiting[list + i].tet = slot;
                // Many points share a child.
                if atomicLoad(&status[slot].flags) < (1u << HELD_SHIFT) {
                    atomicOr(&status[slot].flags, held);
                }
            }
        }
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}
