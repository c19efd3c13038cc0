// Joins the tetrahedra of the flips to those around them, and lists the tetrahedra to check next, unless flip_compact does.
// One invocation an entry of the active list.
//
// An outer neighbour that did not change is told; one that did left a message, which is followed. So each facet is written
// once.
//!include shared/layout
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> status: array<Status>;
@group(0) @binding(3) var<storage, read_write> actives: array<Active>;
@group(0) @binding(4) var<storage, read_write> free: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read> messages: array<vec4u>;
//!include shared/bids

var<workgroup> wanted: atomic<u32>;
var<workgroup> given: u32;
var<workgroup> entries_here: u32;
var<workgroup> flips_23: atomic<u32>;
var<workgroup> flips_32: atomic<u32>;

fn join(t: u32, face: u32, mark: u32) {
    let across = neighbors[t][face];
    let u = across >> 2;
    let theirs = across & 3;
    if atomicLoad(&status[u].vote) == mark {
        neighbors[t][face] = messages[u][theirs];
    } else {
        neighbors[u][theirs] = 4 * t + face;
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
        atomicStore(&flips_23, 0u);
        atomicStore(&flips_32, 0u);
    }
    let entries = workgroupUniformLoad(&entries_here);
    let list = half_of(iteration);
    let next = half_of(iteration + 1);
    let mark = changed_mark(iteration, control.bid_bits);
    let collects = entries < control.compact_from;
    for (var start = group.x * 256; start < entries; start += groups.x * 256) {
        if local == 0 {
            atomicStore(&wanted, 0u);
        }
        workgroupBarrier();
        var count = 0u;
        var tet = vec3u(0);
        if start + local < entries {
            let entry = actives[list + start + local];
            tet.x = entry.tet;
            if (entry.outcome & DONE) == 0 {
                // The flip that changed this tetrahedron, if one did, lists it.
                if atomicLoad(&status[entry.tet].vote) != mark {
                    let flags = atomicLoad(&status[entry.tet].flags);
                    atomicStore(&status[entry.tet].flags, (flags & ~0xffu) | (entry.outcome & 0xff));
                    count = select(0u, 1u, (entry.outcome & CHECK) != 0);
                }
            } else if (entry.outcome & 3) == FLIP_23 {
                let inner = neighbors[entry.tet];
                tet.y = inner.x >> 2;
                tet.z = inner.y >> 2;
                count = 3;
                atomicAdd(&flips_23, 1u);
            } else {
                tet.y = neighbors[entry.tet].w >> 2;
                count = 2;
                atomicAdd(&flips_32, 1u);
                let slot = (entry.outcome & ~DONE) >> SLOT_SHIFT;
                atomicOr(&free[slot / BLOCK], 1u << (slot % BLOCK));
            }
        }
        for (var k = 0u; k < select(count, 0u, count < 2); k++) {
            // The outer faces of three are 2 and 3, those of two are 0, 1 and 2.
            for (var face = select(0u, 2u, count == 3); face < select(3u, 4u, count == 3); face++) {
                join(tet[k], face, mark);
            }
        }
        count = select(0u, count, collects);
        var at = atomicAdd(&wanted, count);
        workgroupBarrier();
        if local == 0 {
            given = atomicAdd(&control.active_len[(iteration + 1) & 1], atomicLoad(&wanted));
        }
        at += workgroupUniformLoad(&given) + next;
        for (var k = 0u; k < count; k++) {
            actives[at + k] = Active(tet[k], 0);
        }
    }
    workgroupBarrier();
    if local == 0 && entries != 0 {
        atomicAdd(&control.flips_23, atomicLoad(&flips_23));
        atomicAdd(&control.flips_32, atomicLoad(&flips_32));
        if group.x == 0 {
            control.iteration = iteration + 1;
        }
    }
}
