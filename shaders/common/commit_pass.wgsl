// The second pass of a flip iteration: carries out the proposed flips that won all of their
// simplices.
//
// A flip owns its simplices, so it overwrites them in place; the outer facets of the new ones keep
// their old neighbours until the third pass, and each old simplex gets a message that says where its
// outer facets went. A flip that finds no slot, or no room in the history, is put off: it stays in
// the active list.
//
// Numbers in the history are taken for a whole workgroup at a time: millions of flips would queue
// for the one counter.
//
// Expects: control, simplices, neighbors, status, actives, messages, history.
//!include common/bids
//!include common/history
//!include {dim}/flip_commit

// The number of flips of this workgroup whose simplices may hold waiting points, and the number of
// the first one in the history.
var<workgroup> held_here: atomic<u32>;
var<workgroup> first_here: u32;

// Commits the flips of `entries` entries, of which workgroup `group` of `groups` takes its share.
fn commit_pass(group: u32, groups: u32, local: u32, bids: Bids, entries: u32) {
    let list = half_of(bids.iteration);
    let room = control.first_node + control.history;
    for (var start = group * WORKGROUP; start < entries; start += groups * WORKGROUP) {
        if local == 0 {
            atomicStore(&held_here, 0u);
        }
        workgroupBarrier();
        let i = start + local;
        var flip = Flip();
        var node = NONE;
        if i < entries {
            flip = winner(i, actives[list + i], bids);
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
                let outcome = carry_out(flip, node, bids);
                if outcome != 0 {
                    actives[list + i].outcome = outcome;
                } else {
                    atomicOr(&control.overflow, SLOTS_FULL);
                }
            }
        }
    }
    if local == 0 && group == 0 {
        control.link_iteration = bids.iteration;
        control.link_bid_base = bids.base;
        atomicStore(&control.undecided, 0u);
        if entries != 0 {
            atomicStore(&control.active_len[(bids.iteration + 1) & 1], 0u);
        }
    }
}
