// Joins the triangles of the flips to those around them, and lists the triangles to check next. One invocation an entry of
// the active list.
//
// An outer neighbour that did not change is told; one that did left a message, which is followed. So each edge is written
// once.
//!include shared/plane_layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> status: array<Status>;
@group(0) @binding(3) var<storage, read_write> actives: array<Active>;
@group(0) @binding(4) var<storage, read> messages: array<vec4u>;
//!include shared/bids

var<workgroup> wanted: atomic<u32>;
var<workgroup> flips: atomic<u32>;
var<workgroup> given: u32;
var<workgroup> entries_here: u32;

fn join(t: u32, edge: u32, mark: u32) {
    let across = neighbors[t][edge];
    let u = across >> 2;
    let theirs = across & 3;
    if atomicLoad(&status[u].vote) == mark {
        neighbors[t][edge] = messages[u][theirs];
    } else {
        neighbors[u][theirs] = 4 * t + edge;
    }
}

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.link_iteration;
    if local == 0 {
        entries_here = entries_of(iteration);
        atomicStore(&flips, 0u);
    }
    let entries = workgroupUniformLoad(&entries_here);
    let list = half_of(iteration);
    let next = half_of(iteration + 1);
    let mark = changed_mark(iteration, control.bid_bits);
    for (var start = group.x * 256; start < entries; start += groups.x * 256) {
        if local == 0 {
            atomicStore(&wanted, 0u);
        }
        workgroupBarrier();
        var count = 0u;
        var t = NONE;
        var u = NONE;
        if start + local < entries {
            let entry = actives[list + start + local];
            t = entry.tet;
            if (entry.outcome & DONE) == 0 {
                // The flip that changed this triangle, if one did, lists it.
                if atomicLoad(&status[t].vote) != mark {
                    let flags = atomicLoad(&status[t].flags);
                    atomicStore(&status[t].flags, (flags & ~CHECK) | (entry.outcome & CHECK));
                    count = select(0u, 1u, (entry.outcome & CHECK) != 0);
                }
            } else {
                u = neighbors[t].x >> 2;
                count = 2;
                atomicAdd(&flips, 1u);
                join(t, 1, mark);
                join(t, 2, mark);
                join(u, 1, mark);
                join(u, 2, mark);
            }
        }
        let at = atomicAdd(&wanted, count);
        workgroupBarrier();
        if local == 0 {
            given = atomicAdd(&control.active_len[(iteration + 1) & 1], atomicLoad(&wanted));
        }
        let place = at + workgroupUniformLoad(&given) + next;
        if count > 0 {
            actives[place] = Active(t, 0);
        }
        if count > 1 {
            actives[place + 1] = Active(u, 0);
        }
    }
    workgroupBarrier();
    if local == 0 && entries != 0 {
        atomicAdd(&control.flips_22, atomicLoad(&flips));
        if group.x == 0 {
            control.iteration = iteration + 1;
        }
    }
}
