// Copies the entries of the list of waiting points that still wait. One invocation per entry.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> waiting: array<Waiting>;
@group(0) @binding(2) var<storage, read> offsets: array<u32>;
@group(0) @binding(3) var<storage, read_write> compacted: array<Waiting>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < control.entries_before; i += groups.x * WORKGROUP) {
        if waiting[i].tet != NONE {
            compacted[offsets[i]] = waiting[i];
        }
    }
}
