// The predicates on cases of five vertices each, and a sixth one that is the interior point; for the
// tests here and those in the browser.
//!include d3/perturbed
//!include d3/filter
//!include d3/refined_{width}
@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(1) var<storage, read_write> signs: array<i32>;

struct Control {
    infinite: u32,
}
var<private> control: Control;

// Vertex k of case i was inserted in the round that bit k of i says.
fn round_of(v: u32) -> u32 {
    return ((v / 6) >> (v % 6)) & 1;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&signs) / 7; i += groups.x * 256) {
        let four = 6 * i + vec4u(0, 1, 2, 3);
        let last = 6 * i + 4;
        control.infinite = 6 * i + 5;
        let a = load_vertex(four.x);
        let b = load_vertex(four.y);
        let c = load_vertex(four.z);
        let d = load_vertex(four.w);
        let e = load_vertex(last);
        signs[7 * i] = orient3d_exact(a, b, c, d);
        signs[7 * i + 1] = perturbed_sign(a, b, c, d, load_vertex(control.infinite), true);
        signs[7 * i + 2] = perturbed_sign(a, b, c, d, e, false);
        signs[7 * i + 3] = orient3d_filter(load_high(four.x), load_high(four.y), load_high(four.z), load_high(four.w));
        signs[7 * i + 4] = insphere_filter(
            load_high(four.x), load_high(four.y), load_high(four.z), load_high(four.w), load_high(last)
        );
        signs[7 * i + 5] = orient3d_refined(a, b, c, d);
        signs[7 * i + 6] = insphere_refined(a, b, c, d, e);
    }
}
