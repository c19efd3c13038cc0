// The first pass of a flip iteration: checks the facets of each active tetrahedron as far as the
// filter decides, and lists the undecided entries. Where they are not decided then, they stay
// active.
//
// Expects: control, simplices, neighbors, status, actives, messages; facet_signs.
//!include d3/check_facets
//!include common/chunks

var<workgroup> undecided_here: atomic<u32>;
var<workgroup> first_undecided: u32;

// Checks `entries` entries, of which workgroup `group` of `groups` takes its share.
fn check_pass(group: u32, groups: u32, local: u32, bids: Bids, entries: u32) {
    let list = half_of(bids.iteration);
    let chunk = checked_together(entries, groups);
    let long = is_long(entries, chunk, groups);
    var start = group * chunk;
    while start < entries {
        let ahead = chunk_ahead(CHECK_CHUNKS, long, chunk, groups, local);
        if local == 0 {
            atomicStore(&undecided_here, 0u);
        }
        workgroupBarrier();
        let i = start + local;
        var place = NONE;
        let decided = check_facets(local < chunk && i < entries, i, list + i, bids, local);
        if !decided {
            place = atomicAdd(&undecided_here, 1u);
        }
        workgroupBarrier();
        if local == 0 && atomicLoad(&undecided_here) != 0 {
            first_undecided = atomicAdd(&control.undecided, atomicLoad(&undecided_here));
        }
        workgroupBarrier();
        if place != NONE {
            messages[first_undecided + place].x = i;
        }
        start = next_chunk(start, ahead, long, chunk, groups, local);
    }
    if local == 0 && group == 0 && entries != 0 {
        atomicStore(&control.taken[LINK_CHUNKS], 0u);
        control.iterations += 1;
        control.visits += entries;
    }
}
