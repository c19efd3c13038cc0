// Picks the point with the best score, the last of equals. One invocation per entry of the list of
// waiting points.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> waiting: array<Waiting>;
@group(0) @binding(2) var<storage, read_write> picks: array<array<atomic<u32>, 4>>;
@group(0) @binding(3) var<storage, read> scores: array<u32>;
//!include common/waiting

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entries = control.entries;
    let list = waiting_list();
    for (var i = id.x; i < entries; i += groups.x * WORKGROUP) {
        let entry = waiting[list + i];
        if entry.tet != NONE && scores[i] == atomicLoad(&picks[entry.tet][0]) {
            atomicMax(&picks[entry.tet][1], entry.point + 1);
        }
    }
}
