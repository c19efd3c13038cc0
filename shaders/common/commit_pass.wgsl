// The second pass of a flip iteration: carries out the proposed flips that won all of their
// simplices.
//
// A flip owns its simplices, so it overwrites them in place; the outer facets of the new ones keep
// their old neighbours until the third pass, and each old simplex gets a message that says where
// its outer facets went. A flip that finds no slot, or no room in the history, is put off: it stays
// in the active list.
//
// A workgroup first collects the winners among many entries, and then carries them out, so that
// nearly all of its invocations wait for memory at the same time: only a third of the entries win.
// Numbers in the history are taken for all of them at once: millions of flips would queue for the
// one counter.
//
// Expects: control, simplices, neighbors, status, actives, messages, history.
//!include common/bids
//!include common/chunks
//!include common/history
//!include {dim}/flip_commit

// The entries among which a workgroup collects winners, if there are enough for all workgroups.
const COMMIT_STEP: u32 = 2 * WORKGROUP;

// The entries that won, counted from the first one in the lower 16 bits; in the upper ones, the
// number of each among those whose simplices may hold waiting points, plus 1, or 0 if they cannot.
var<workgroup> winners: array<u32, COMMIT_STEP>;
// The third simplex of each of their flips; NONE if it is put off.
var<workgroup> thirds: array<u32, COMMIT_STEP>;
var<workgroup> winners_len: atomic<u32>;
var<workgroup> winners_here: u32;
// The number of winners whose simplices may hold waiting points, and the number of the first one in
// the history.
var<workgroup> held_here: atomic<u32>;
var<workgroup> first_here: u32;

// Commits the flips of `entries` entries, of which workgroup `group` of `groups` takes its share.
fn commit_pass(group: u32, groups: u32, local: u32, bids: Bids, entries: u32) {
    let list = half_of(bids.iteration);
    // Read once, because the compiler cannot know that no store changes them.
    let round = control.round;
    let room = control.history;
    // A workgroup reads more per entry than in the other passes. Half of the workgroups share a long list, so
    // that what they read fits the caches.
    let long = is_long(entries, COMMIT_STEP, groups);
    let taking = select(groups, (groups + 1) / 2, long);
    // An invocation has at most one entry of a short list.
    let step = select(COMMIT_STEP, WORKGROUP, entries <= groups * WORKGROUP);
    var start = select(entries, group * step, group < taking);
    while start < entries {
        let ahead = chunk_ahead(COMMIT_CHUNKS, long, step, taking, local);
        var taken = 0u;
        if local == 0 {
            taken = atomicLoad(&control.next_node);
            atomicStore(&winners_len, 0u);
            atomicStore(&held_here, 0u);
        }
        workgroupBarrier();
        let end = min(start + step, entries);
        for (var i = start + local; i < end; i += WORKGROUP) {
            let proposal = proposal_of(actives[list + i]);
            if proposal.kind != 0 && has_won(proposal, bid_of(i, bids)) {
                var number = 0u;
                if is_held(proposal, round) {
                    number = atomicAdd(&held_here, 1u) + 1;
                }
                winners[atomicAdd(&winners_len, 1u)] = (i - start) | (number << 16);
            }
        }
        workgroupBarrier();
        if local == 0 {
            winners_here = atomicLoad(&winners_len);
            // The counter is not raised far beyond the end, so that it never overflows.
            let wanted = atomicLoad(&held_here);
            first_here = room;
            if wanted != 0 && taken < room {
                first_here = atomicAdd(&control.next_node, wanted);
            }
        }
        let first_number = workgroupUniformLoad(&first_here);
        let count = workgroupUniformLoad(&winners_here);
        for (var j = local; j < count; j += WORKGROUP) {
            let i = start + (winners[j] & 0xffff);
            let number = winners[j] >> 16;
            let node = select(first_number + number - 1, NONE, number == 0);
            var third = NONE;
            if node != NONE && node >= room {
                atomicOr(&control.overflow, HISTORY_FULL);
            } else {
                third = begin_flip(proposal_of(actives[list + i]), node, bids, round);
                if third == NONE {
                    atomicOr(&control.overflow, SLOTS_FULL);
                }
            }
            thirds[j] = third;
        }
        // In two steps, because a flip in one takes so many registers that few invocations run at a
        // time.
        for (var j = local; j < count; j += WORKGROUP) {
            if thirds[j] != NONE {
                let i = start + (winners[j] & 0xffff);
                actives[list + i].outcome = end_flip(proposal_of(actives[list + i]), thirds[j]);
            }
        }
        workgroupBarrier();
        start = next_chunk(start, ahead, long, step, taking, local);
    }
    if local == 0 && group == 0 {
        atomicStore(&control.taken[CHECK_CHUNKS], 0u);
        control.link_iteration = bids.iteration;
        control.link_bid_base = bids.base;
        atomicStore(&control.undecided, 0u);
        if entries != 0 {
            atomicStore(&control.active_len[(bids.iteration + 1) & 1], 0u);
        }
    }
}
