// Carries out the proposed flips that won all of their simplices. One invocation per entry of the
// active list.
//
// A flip owns its simplices, so it overwrites them in place; the outer facets of the new ones keep
// their old neighbours until flip_link, and each old simplex gets a message that says where its
// outer facets went. A flip that finds no slot, or no room in the history, is put off: it stays in
// the active list.
//
// Numbers in the history are taken for a whole workgroup at a time: millions of flips would queue
// for the one counter.
//!include {dim}/simplex
@group(0) @binding(0) var<storage, read_write> control: Control;
@group(0) @binding(1) var<storage, read_write> simplices: array<vec4u>;
@group(0) @binding(2) var<storage, read_write> neighbors: array<vec4u>;
@group(0) @binding(3) var<storage, read_write> status: array<Status>;
@group(0) @binding(4) var<storage, read_write> actives: array<Active>;
@group(0) @binding(5) var<storage, read_write> messages: array<vec4u>;
//!include common/bids
//!include common/history
//!include {dim}/flip_commit

// Returns whether waiting points may lie in a simplex.
fn is_held(t: u32) -> bool {
    return atomicLoad(&status[t].flags) >> HELD_SHIFT == control.round;
}

var<workgroup> entries_here: u32;
// The number of flips of this workgroup whose simplices may hold waiting points, and the number of
// the first one in the history.
var<workgroup> held_here: atomic<u32>;
var<workgroup> first_here: u32;

@compute @workgroup_size(WORKGROUP)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let iteration = control.iteration;
    if local == 0 {
        entries_here = entries_of(iteration);
    }
    let entries = workgroupUniformLoad(&entries_here);
    let list = half_of(iteration);
    let bits = control.bid_bits;
    let mark = changed_mark(iteration, bits);
    let room = control.first_node + control.history;
    for (var start = group.x * WORKGROUP; start < entries; start += groups.x * WORKGROUP) {
        if local == 0 {
            atomicStore(&held_here, 0u);
        }
        workgroupBarrier();
        let i = start + local;
        var flip = Flip();
        var node = NONE;
        if i < entries {
            flip = winner(i, actives[list + i], iteration, bits);
            if flip.held {
                node = atomicAdd(&held_here, 1u);
            }
        }
        workgroupBarrier();
        if local == 0 {
            // The counter is not raised far beyond the end, so that it never overflows.
            let wanted = atomicLoad(&held_here);
            first_here = room;
            if wanted != 0 && atomicLoad(&control.next_node) < room {
                first_here = atomicAdd(&control.next_node, wanted);
            }
        }
        let first_number = workgroupUniformLoad(&first_here);
        if flip.held {
            node += first_number;
        }
        if flip.kind != 0 {
            if flip.held && node >= room {
                atomicOr(&control.overflow, HISTORY_FULL);
            } else {
                let outcome = carry_out(flip, node, iteration, mark);
                if outcome != 0 {
                    actives[list + i].outcome = outcome;
                } else {
                    atomicOr(&control.overflow, SLOTS_FULL);
                }
            }
        }
    }
    if local == 0 && group.x == 0 {
        control.link_iteration = iteration;
        atomicStore(&control.undecided, 0u);
        if entries != 0 {
            atomicStore(&control.active_len[(iteration + 1) & 1], 0u);
        }
    }
}
