// Frees all slots of new blocks. One invocation per block.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var b = control.blocks_before + id.x; b < control.blocks; b += groups.x * WORKGROUP) {
        atomicStore(&control.free[b], ALL_FREE);
    }
}
