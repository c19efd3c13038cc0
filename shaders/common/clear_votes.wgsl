// Forgets all votes, so that bids start from the lowest number again. One invocation per slot.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> status: array<Status>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        atomicStore(&status[t].vote, 0u);
    }
    if id.x == 0 {
        control.bid_base = 1;
    }
}
