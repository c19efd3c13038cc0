// Numbers the marked tetrahedra in the order of their slots, and lists them. One invocation per
// slot.
//!include common/layout
//!include d3/gathering
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> gathering: Gathering;
@group(0) @binding(2) var<storage, read> marks: array<u32>;
// The marks before each slot.
@group(0) @binding(3) var<storage, read> numbers: array<u32>;
@group(0) @binding(4) var<storage, read_write> region_numbers: array<u32>;
@group(0) @binding(5) var<storage, read_write> gathered_slots: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < control.blocks * BLOCK; t += groups.x * WORKGROUP) {
        if marks[t] != 0 {
            gathered_slots[numbers[t]] = t;
            region_numbers[t] = gathering.first + numbers[t];
        }
    }
}
