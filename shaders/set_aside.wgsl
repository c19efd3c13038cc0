// Finds the points that share all lattice coordinates with one of a lower index: those wait for Phase 2. One invocation a
// vertex.
//
// They have the same key, and among equal keys the sort leaves points in the order of their indices.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(2) var<storage, read> vertices: array<vec4i>;
// The vertex that each vertex shares its coordinates with, or NONE.
@group(0) @binding(3) var<storage, read_write> same: array<u32>;

// Words a vertex.
override STRIDE: u32;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < control.infinite; v += groups.x * 256) {
        var found = NONE;
        for (var w = v; w > 0 && pairs[w - 1].x == pairs[v].x; w--) {
            var equal = true;
            for (var word = 0u; word < STRIDE; word++) {
                equal = equal && all(vertices[STRIDE * v + word].xyz == vertices[STRIDE * (w - 1) + word].xyz);
            }
            if equal {
                found = w - 1;
            }
        }
        same[v] = found;
        if found != NONE {
            atomicAdd(&control.aside, 1u);
            // The first tetrahedron was chosen before anyone knew. Its corners have different coordinates.
            if v == control.first_0 {
                control.first_0 = found;
            } else if v == control.first_1 {
                control.first_1 = found;
            } else if v == control.first_2 {
                control.first_2 = found;
            } else if v == control.first_3 {
                control.first_3 = found;
            }
        }
    }
}
