// Joins the tetrahedra of removals to those around them, and lists them, to be checked next. One invocation per removal.
//!include d3/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> status: array<OwnedStatus>;
@group(0) @binding(4) var<storage, read_write> messages: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> removals: array<Removal>;
@group(0) @binding(6) var<storage, read_write> actives: array<Active>;
//!include common/bids
//!include common/join
//!include d3/removal

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let count = min(atomicLoad(&control.next_node), control.history);
    let mark = control.link_bid_base + count;
    let half = control.iteration & 1;
    for (var i = id.x; i < count; i += groups.x * WORKGROUP) {
        var removal = removals[i];
        if removal.facets == 0 {
            continue;
        }
        let len = removal.facets + 2;
        let first = half_of(control.iteration) + atomicAdd(&control.active_len[half], len);
        for (var j = 0u; j < len; j++) {
            let t = removal.tets[j];
            actives[first + j] = Active(t, 0);
            join(t, 2, mark);
            join(t, 3, mark);
        }
        atomicAdd(&control.removed, removal.facets);
    }
    if id.x == 0 {
        control.bid_base = mark + 1;
    }
}
