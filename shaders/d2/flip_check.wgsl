// Checks the edges of each active triangle (§5.6). One invocation per entry of the active list.
//!include d2/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(3) var<storage, read> simplices: array<vec4u>;
@group(0) @binding(4) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(6) var<storage, read_write> actives: array<Active>;
//!include d2/check_pass

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    let base = control.bid_base;
    let entries = entries_of(iteration, base, many());
    check_pass(group.x, groups.x, local, bids_of(iteration, base, entries), entries);
}
