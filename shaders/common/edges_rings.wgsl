// Writes the neighbours of the vertices as compressed rows, from the sorted pairs of a vertex and a
// neighbour. One invocation per neighbour and vertex.
//!include primitives/workgroup
@group(0) @binding(0) var<storage, read> pairs: array<vec2u>;
// One more than there are vertices.
@group(0) @binding(1) var<storage, read_write> ring_offsets: array<u32>;
@group(0) @binding(2) var<storage, read_write> ring: array<u32>;

// Returns the number of pairs of vertices below v.
fn pairs_below(v: u32) -> u32 {
    var low = 0u;
    var high = arrayLength(&pairs);
    while low < high {
        let middle = (low + high) / 2;
        if pairs[middle].x < v {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < max(arrayLength(&pairs), arrayLength(&ring_offsets)); i += groups.x * WORKGROUP) {
        if i < arrayLength(&pairs) {
            ring[i] = pairs[i].y;
        }
        if i < arrayLength(&ring_offsets) {
            ring_offsets[i] = pairs_below(i);
        }
    }
}
