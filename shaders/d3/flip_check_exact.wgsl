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
//!include d3/check_facets
//!include d3/facet_signs_once

var<workgroup> entries_here: u32;
var<workgroup> open_here: u32;
var<workgroup> exact_here: atomic<u32>;

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
        open_here = atomicLoad(&control.undecided);
        atomicStore(&exact_here, 0u);
    }
    let entries = workgroupUniformLoad(&entries_here);
    let undecided = workgroupUniformLoad(&open_here);
    let bids = bids_of(iteration, base, entries);
    let list = half_of(iteration);
    let chunk = checked_together(undecided, groups.x);
    for (var start = group.x * chunk; start < undecided; start += groups.x * chunk) {
        let j = start + local;
        let has_entry = local < chunk && j < undecided;
        var i = 0u;
        if has_entry {
            i = messages[j].x;
        }
        // No sign is undecided here.
        _ = check_facets(has_entry, i, list + i, bids, local);
        workgroupBarrier();
    }
    if exact_signs != 0 {
        atomicAdd(&exact_here, exact_signs);
    }
    workgroupBarrier();
    if local == 0 && atomicLoad(&exact_here) != 0 {
        atomicAdd(&control.exact, atomicLoad(&exact_here));
    }
}
