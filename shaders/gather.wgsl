// Puts the points in the order of the curve, and numbers the first tetrahedron accordingly. One invocation a point.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
// Key and point, sorted by the key.
@group(0) @binding(1) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(2) var<storage, read> unsorted: array<vec4i>;
@group(0) @binding(3) var<storage, read_write> vertices: array<vec4i>;

// Words a vertex.
override STRIDE: u32;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let start = vec4u(control.start_0, control.start_1, control.start_2, control.start_3);
    for (var v = id.x; v < control.infinite; v += groups.x * 256) {
        let point = pairs[v].y;
        for (var word = 0u; word < STRIDE; word++) {
            vertices[STRIDE * v + word] = unsorted[STRIDE * point + word];
        }
        if point == start.x {
            control.first_0 = v;
        }
        if point == start.y {
            control.first_1 = v;
        }
        if point == start.z {
            control.first_2 = v;
        }
        if point == start.w {
            control.first_3 = v;
        }
    }
}
