// Checks the facets of each active tetrahedron as far as the filter decides (§4.4), and lists the
// undecided entries for flip_check_exact. One or four invocations per entry of the active list.
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<vec4i>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(5) var<storage, read_write> actives: array<Active>;
// Its first words name the entries with undecided signs.
@group(0) @binding(6) var<storage, read_write> messages: array<vec4u>;
//!include d3/check_pass
//!include d3/signs_filtered

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
