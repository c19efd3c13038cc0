// The place of every point along the Hilbert curve, from the ten highest bits of its lattice coordinates, with the
// point's number.
//!include shared/hilbert
//!include shared/exact_{width}

@group(0) @binding(0) var<storage, read> vertices: array<vec4i>;
// Key and point, one for each vertex.
@group(0) @binding(1) var<storage, read_write> pairs: array<vec2u>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&pairs); i += groups.x * 256) {
        pairs[i] = vec2u(hilbert_key(vec3u(load_high(i)) >> vec3u(21)), i);
    }
}
