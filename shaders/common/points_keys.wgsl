// Computes the sort key of every point: its place along the Hilbert curve. Points at the same place
// as one of a lower number go to the end.
//!include common/input
//!include {dim}/hilbert
//!include common/input_counts
//!include common/layout

@group(0) @binding(0) var<storage, read> params: InputParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
@group(0) @binding(2) var<storage, read> table: array<u32>;
@group(0) @binding(3) var<storage, read> slots: array<u32>;
// Key and point.
@group(0) @binding(4) var<storage, read_write> pairs: array<vec2u>;
// For each point the lowest one at the same place; NONE for that point itself.
@group(0) @binding(5) var<storage, read_write> merged_into: array<u32>;
@group(0) @binding(6) var<storage, read_write> counts: InputCounts;

fn same_coordinates(a: u32, b: u32) -> bool {
    return all(coordinate_bits(a, 0) == coordinate_bits(b, 0)) && all(coordinate_bits(a, 1) == coordinate_bits(b, 1))
        && all(coordinate_bits(a, 2) == coordinate_bits(b, 2));
}

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var point = id.x; point < params.count; point += groups.x * WORKGROUP) {
        let first = table[slots[point]] - 1;
        let merged = first != point;
        let place = lattice_point(point);
        var key = MERGED_KEY;
        if !merged {
            key = hilbert_key(place.high);
        }
        pairs[point] = vec2u(key, point);
        merged_into[point] = select(NONE, first, merged);
        if merged {
            atomicAdd(&counts.merged, 1);
            if same_coordinates(point, first) {
                atomicAdd(&counts.duplicates, 1);
            }
        }
        if !place.exact {
            atomicAdd(&counts.rounded, 1);
        }
    }
}
