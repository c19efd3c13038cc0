// Marks the entries of the list of waiting points that still wait, if it is to be compacted. One
// invocation per entry.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> waiting: array<Waiting>;
@group(0) @binding(2) var<storage, read_write> marks: array<u32>;
//!include common/waiting

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let before = other_waiting_list();
    for (var i = id.x; i < control.entries_before; i += groups.x * WORKGROUP) {
        marks[i] = select(0u, 1u, waiting[before + i].tet != NONE);
    }
}
