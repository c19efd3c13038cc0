// Moves each waiting point along the history to the simplex that it lies in after the flips (§4.1).
// One invocation per entry of the list of waiting points.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read> vertices: array<VertexWords>;
@group(0) @binding(3) var<storage, read_write> status: array<Status>;
@group(0) @binding(5) var<storage, read_write> waiting: array<Waiting>;
//!include common/waiting
//!include {dim}/signs
//!include {dim}/relocate

@compute @workgroup_size(WORKGROUP)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let entries = control.entries;
    let list = waiting_list();
    for (var i = id.x; i < entries; i += groups.x * WORKGROUP) {
        let entry = waiting[list + i];
        if entry.tet == NONE {
            continue;
        }
        // NONE if there is no first node.
        var next = status[entry.tet].first - 1;
        var t = entry.tet;
        // Each step leads to a later node. On wrong links, no device hangs.
        for (var steps = 0u; steps <= control.history && next != NONE; steps++) {
            let step = follow(next, entry.point);
            t = step.x;
            next = step.y;
        }
        if t != entry.tet {
            waiting[list + i].tet = t;
        }
    }
    if exact_signs != 0 {
        atomicAdd(&control.exact, exact_signs);
    }
}
