// Joins the simplices of the flips to those around them, and lists the simplices to check next. One
// invocation per entry of the active list.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(3) var<storage, read_write> actives: array<Active>;
@group(0) @binding(4) var<storage, read> messages: array<vec4u>;
//!include common/link_pass

var<workgroup> entries_here: u32;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.link_iteration;
    let base = control.link_bid_base;
    if local == 0 {
        entries_here = entries_of(iteration, base, many());
    }
    let entries = workgroupUniformLoad(&entries_here);
    link_pass(group.x, groups.x, local, bids_of(iteration, base, entries), entries);
}
