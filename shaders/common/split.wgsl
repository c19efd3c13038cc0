// Splits each simplex that picked a point, 1 to 3 or 1 to 4. One invocation per entry of the list
// of waiting points.
//
// The inner facets are locally Delaunay because the point lies inside the circumsphere; the outer
// ones are to be checked. A neighbour that is split too finds its new neighbour by itself, because
// the slots of children follow from the parent and the point; any other neighbour is updated.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> status: array<Status>;
@group(0) @binding(4) var<storage, read_write> actives: array<Active>;
@group(0) @binding(5) var<storage, read> picks: array<vec4u>;
@group(0) @binding(6) var<storage, read> waiting: array<Waiting>;
//!include {dim}/split
//!include common/bids
//!include common/waiting
//!include common/chunks

var<workgroup> wanted: atomic<u32>;
var<workgroup> splits: atomic<u32>;
var<workgroup> given: u32;
var<workgroup> entries_here: u32;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0 {
        entries_here = control.entries;
    }
    let entries = workgroupUniformLoad(&entries_here);
    let half = control.iteration & 1;
    let list = half_of(control.iteration);
    let first = waiting_list();
    let long = is_long(entries, WORKGROUP, groups.x);
    var start = group.x * WORKGROUP;
    while start < entries {
        let ahead = chunk_ahead(SPLIT_CHUNKS, long, WORKGROUP, groups.x, local);
        if local == 0 {
            atomicStore(&wanted, 0u);
            atomicStore(&splits, 0u);
        }
        workgroupBarrier();
        var t = NONE;
        var p = NONE;
        var listed = 0u;
        var at = 0u;
        if start + local < entries {
            let entry = waiting[first + start + local];
            p = entry.point;
            if entry.tet != NONE && picks[entry.tet].y == p + 1 {
                t = entry.tet;
                // A simplex that is active is in the list already.
                listed = select(0u, 1u, (atomicLoad(&status[t].flags) & CHECK) != 0);
                at = atomicAdd(&wanted, CORNERS - listed);
                atomicAdd(&splits, 1u);
            }
        }
        workgroupBarrier();
        if local == 0 {
            given = 0;
            if atomicLoad(&splits) != 0 {
                atomicAdd(&control.inserted, atomicLoad(&splits));
                given = atomicAdd(&control.active_len[half], atomicLoad(&wanted));
            }
        }
        at += workgroupUniformLoad(&given) + list;
        if t != NONE {
            let parent = unpacked(simplices[t]);
            let outer = unpacked(neighbors[t]);
            let slots = child_slots(t, p);
            for (var k = 0u; k < CORNERS; k++) {
                let slot = child_slot(t, p, k);
                simplices[slot] = packed(replaced(parent, k, p));
                let u = outer[k] >> 2;
                let face = outer[k] & 3;
                let q = picks[u].y;
                let across = select(4 * child_slot(u, q - 1, face) + face, outer[k], q == 0);
                neighbors[slot] = packed(replaced(4 * slots + k, k, across));
                if q == 0 {
                    neighbors[u][face] = 4 * slot + k;
                }
                atomicStore(&status[slot].flags, 1u << k);
                status[slot].last = 0;
                status[slot].first = 0;
                if k > 0 || listed == 0 {
                    actives[at] = Active(slot, 0);
                    at += 1;
                }
            }
            take_slots(p);
        }
        start = next_chunk(start, ahead, long, WORKGROUP, groups.x, local);
    }
}
