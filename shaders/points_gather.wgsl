// The vertices: the points' lattice coordinates, in the order of the sorted pairs. See gpu::vertex for the words.
//!include shared/input
//!include shared/input_counts

@group(0) @binding(0) var<storage, read> params: InputParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
// Key and point, sorted.
@group(0) @binding(2) var<storage, read> pairs: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> vertices: array<vec4i>;
@group(0) @binding(4) var<storage, read_write> counts: InputCounts;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < params.count; v += groups.x * 256) {
        let point = pairs[v].y;
        let place = lattice_point(point);
        if params.width > 31 {
            vertices[2 * v] = vec4i(vec3i(place.high), i32(point));
            vertices[2 * v + 1] = vec4i(vec3i(place.low), i32(!place.exact));
        } else {
            vertices[v] = vec4i(vec3i(place.high), i32(point));
        }
        for (var k = 0u; k < 4; k++) {
            if counts.stands_for[k] == point {
                counts.found[k] = v;
            }
        }
    }
}
