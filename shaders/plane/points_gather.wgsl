// The vertices: the points' lattice coordinates, in the order of the sorted pairs. See gpu::plane::vertex for the words.
//!include shared/input
//!include shared/input_counts

@group(0) @binding(0) var<storage, read> params: InputParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
// Key and point, sorted.
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> vertices: array<vec2u>;
@group(0) @binding(4) var<storage, read_write> counts: InputCounts;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < params.count; v += groups.x * 256) {
        let point = pairs[v].y;
        let place = lattice_point(point);
        if params.width > 31 {
            vertices[2 * v] = place.high.xy;
            vertices[2 * v + 1] = place.low.xy | vec2u(select(0x80000000u, 0u, place.exact), 0);
        } else {
            vertices[v] = place.high.xy;
        }
        for (var k = 0u; k < 4; k++) {
            if counts.stands_for[k] == point {
                counts.found[k] = v;
            }
        }
    }
}
