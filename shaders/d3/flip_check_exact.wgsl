// Checks the facets of the active tetrahedra that the filter did not decide (§4.4). One
// invocation per facet of the entries of their list.
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(2) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(5) var<storage, read_write> actives: array<Active>;
// Its first words name the entries with undecided signs.
@group(0) @binding(6) var<storage, read> messages: array<vec4u>;
//!include d3/check_exact_pass
//!include d3/signs

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
    check_exact_pass(group.x, groups.x, local, bids_of(iteration, base, entries));
}
