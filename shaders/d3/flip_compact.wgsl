// Lists the tetrahedra to check next in the order of their slots, where flip_link has left that to
// this kernel: the first of the two strategies of §4.2, for iterations in which very many are
// active. One invocation per slot.
//!include common/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> status: array<Status>;
@group(0) @binding(2) var<storage, read_write> actives: array<Active>;
//!include common/bids
//!include primitives/workgroup_scan

var<workgroup> slots_here: u32;
var<workgroup> given: u32;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.link_iteration;
    let base = control.link_bid_base;
    if local == 0 {
        // The same condition as in flip_link.
        slots_here = select(0u, control.blocks * BLOCK, entries_of(iteration, base, many()) >= control.compact_from);
    }
    let slots = workgroupUniformLoad(&slots_here);
    let next = half_of(iteration + 1);
    for (var start = group.x * WORKGROUP; start < slots; start += groups.x * WORKGROUP) {
        let t = start + local;
        var is_active = false;
        if t < slots {
            is_active = (atomicLoad(&status[t].flags) & CHECK) != 0;
        }
        let scanned = workgroup_scan(select(0u, 1u, is_active), local);
        if local == 0 {
            given = atomicAdd(&control.active_len[(iteration + 1) & 1], scanned.total);
        }
        let at = workgroupUniformLoad(&given) + next + scanned.before;
        if is_active {
            actives[at] = Active(t, 0);
        }
    }
}
