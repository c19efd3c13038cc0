// Puts each simplex of a mesh into the table, in the first place after its own that is free. One invocation per simplex.
//!include common/survivors_table
@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < arrayLength(&corners) / CORNERS; t += groups.x * WORKGROUP) {
        var place = first_place(t);
        // Half of the places stay free. On wrong contents, no device hangs.
        for (var steps = 0u; steps < arrayLength(&places); steps++) {
            let found = atomicCompareExchangeWeak(&places[place], 0, t + 1);
            if found.exchanged {
                break;
            }
            // The exchange may also fail where the place is free.
            if found.old_value != 0 {
                place = (place + 1) & (arrayLength(&places) - 1);
            }
        }
    }
}
