// The predicates on cases of five vertices each; for the tests here and those in the browser.
//!include d3/predicates
//!include d3/filter
//!include d3/refined_{width}
@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(1) var<storage, read_write> signs: array<i32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&signs) / 7; i += groups.x * 256) {
        let a = load_vertex(5 * i);
        let b = load_vertex(5 * i + 1);
        let c = load_vertex(5 * i + 2);
        let d = load_vertex(5 * i + 3);
        let e = load_vertex(5 * i + 4);
        signs[7 * i] = orient3d_exact(a, b, c, d);
        // The last vertex stands for the interior point, too.
        var interior = e;
        interior.index = 0xffffffff;
        signs[7 * i + 1] = perturbed_sign(a, b, c, d, interior, true);
        signs[7 * i + 2] = perturbed_sign(a, b, c, d, e, false);
        signs[7 * i + 3] = orient3d_filter(load_high(5 * i), load_high(5 * i + 1), load_high(5 * i + 2), load_high(5 * i + 3));
        signs[7 * i + 4] = insphere_filter(
            load_high(5 * i), load_high(5 * i + 1), load_high(5 * i + 2), load_high(5 * i + 3), load_high(5 * i + 4)
        );
        signs[7 * i + 5] = orient3d_refined(a, b, c, d);
        signs[7 * i + 6] = insphere_refined(a, b, c, d, e);
    }
}
