// Lists all points and locates them in the first tetrahedra. One invocation a point.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read_write> waiting: array<Waiting>;
//!include shared/signs
//!include shared/child_of

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let first = vec4u(control.first_0, control.first_1, control.first_2, control.first_3);
    let infinite = control.infinite;
    for (var p = id.x; p < infinite; p += groups.x * 256) {
        var tet = NONE;
        if all(first != vec4u(p)) {
            // The kernel point, not infinity, whose number it has.
            let k = child_of(first, infinite, p, NONE);
            let beyond = orient_finite(replaced(first, k, p)) < 0;
            tet = infinite * BLOCK + select(0u, 1 + k, beyond);
        }
        waiting[p] = Waiting(p, tet);
    }
    atomicAdd(&control.exact, exact_signs);
}
