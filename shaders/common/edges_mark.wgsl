// Finds the edges that each simplex lists. One invocation per simplex.
//!include primitives/workgroup
//!include {dim}/edge_lists
// Bit e is set if the simplex lists edge e.
@group(0) @binding(0) var<storage, read_write> listed: array<u32>;
// How many it lists.
@group(0) @binding(1) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < arrayLength(&counts); t += groups.x * WORKGROUP) {
        var bits = 0u;
        for (var e = 0u; e < EDGES; e++) {
            bits |= u32(lists(t, e)) << e;
        }
        listed[t] = bits;
        counts[t] = countOneBits(bits);
    }
}
