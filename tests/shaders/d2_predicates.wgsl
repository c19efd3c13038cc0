// The predicates on cases of four vertices each; for the tests here and those in the browser.
//!include d2/predicates
//!include d2/filter
@group(0) @binding(0) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(1) var<storage, read> indices: array<u32>;
@group(0) @binding(2) var<storage, read_write> signs: array<i32>;

fn vertex(v: u32) -> Vertex {
    return Vertex(load_position(v), indices[v]);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&signs) / 5; i += groups.x * 256) {
        let v = 4 * i;
        signs[5 * i] = orient2d_exact(load_position(v), load_position(v + 1), load_position(v + 2));
        // The last vertex stands for the interior point, too.
        var interior = vertex(v + 3);
        interior.index = 0xffffffff;
        signs[5 * i + 1] = perturbed_sign(vertex(v), vertex(v + 1), vertex(v + 2), interior, true);
        signs[5 * i + 2] = perturbed_sign(vertex(v), vertex(v + 1), vertex(v + 2), vertex(v + 3), false);
        signs[5 * i + 3] = orient2d_filter(load_high(v), load_high(v + 1), load_high(v + 2));
        signs[5 * i + 4] = incircle_filter(load_high(v), load_high(v + 1), load_high(v + 2), load_high(v + 3));
    }
}
