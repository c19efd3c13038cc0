// Checks the facets of each active simplex (§4.4, §5.6). In 2D, one invocation per entry of the
// active list; in 3D one per facet, which check as far as the filter decides and list the undecided
// entries for flip_check_exact.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(4) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(6) var<storage, read_write> actives: array<Active>;
//!include {dim}/flip_check

var<workgroup> entries_here: u32;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    let base = control.bid_base;
    if local == 0 {
        entries_here = entries_of(iteration, base, many());
    }
    let entries = workgroupUniformLoad(&entries_here);
    check_pass(group.x, groups.x, local, bids_of(iteration, base, entries), entries);
}
