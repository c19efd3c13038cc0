// Moves the waiting points of split triangles into the children. One invocation an entry of the list of waiting points.
//!include shared/plane_layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(3) var<storage, read> triangles: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<Status>;
@group(0) @binding(5) var<storage, read> picks: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> waiting: array<Waiting>;
//!include shared/plane_signs
//!include shared/plane_child_of

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entries = control.entries;
    let held = control.round << HELD_SHIFT;
    for (var i = id.x; i < entries; i += groups.x * 256) {
        let entry = waiting[i];
        let t = entry.tet;
        if t != NONE {
            let p = picks[t].y - 1;
            if p == entry.point {
                waiting[i].tet = NONE;
            } else {
                // Child 0 is in slot t and has p for its vertex 0; child 1 has that vertex.
                let tri = with_vertex(triangles[t].xyz, 0, triangles[plane_child_slot(t, p, 1)].x);
                let slot = plane_child_slot(t, p, plane_child_of(tri, p, entry.point, control.infinite));
                waiting[i].tet = slot;
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
