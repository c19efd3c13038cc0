// The third pass of a flip iteration: joins the simplices of the flips to those around them, and
// lists the simplices to check next.
//
// A workgroup first collects the flips among its entries and then shares out their outer facets:
// each is a chain of loads that depend on each other, and one invocation per flip would do them one
// after the other.
//
// Expects: control, neighbors, status, actives, messages.
//!include common/bids
//!include common/chunks
//!include common/join
//!include {dim}/flip_link

var<workgroup> wanted: atomic<u32>;
var<workgroup> given: u32;
// The flips of the entries at hand, by the simplices that they made.
var<workgroup> done: array<Changed, WORKGROUP>;
var<workgroup> done_len: atomic<u32>;
var<workgroup> done_here: u32;
// Flips by their kind.
var<workgroup> flips: array<atomic<u32>, 4>;

// The slots to check next: those of a flip, or one that no flip changed.
struct Changed {
    slots: vec3u,
    count: u32,
}

// Links the flips of `entries` entries, of which workgroup `group` of `groups` takes its share, and
// lists the simplices to check next.
fn link_pass(group: u32, groups: u32, local: u32, bids: Bids, entries: u32) {
    if local < 4 {
        atomicStore(&flips[local], 0u);
    }
    let list = half_of(bids.iteration);
    let next = half_of(bids.iteration + 1);
    let mark = changed_mark(bids);
    let long = is_long(entries, WORKGROUP, groups);
    var start = group * WORKGROUP;
    while start < entries {
        let ahead = chunk_ahead(LINK_CHUNKS, long, WORKGROUP, groups, local);
        if local == 0 {
            atomicStore(&wanted, 0u);
            atomicStore(&done_len, 0u);
        }
        workgroupBarrier();
        var changed = Changed(vec3u(0), 0);
        if start + local < entries {
            let entry = actives[list + start + local];
            if (entry.outcome & DONE) != 0 {
                atomicAdd(&flips[kind_of(entry.outcome)], 1u);
                changed = changed_by(entry);
                done[atomicAdd(&done_len, 1u)] = changed;
            } else if atomicLoad(&status[entry.tet].vote) != mark {
                // A simplex that a flip has changed is listed with that flip.
                let flags = status[entry.tet].made.x;
                status[entry.tet].made.x = (flags & ~0xffu) | (entry.outcome & 0xff);
                changed = Changed(vec3u(entry.tet, 0, 0), select(0u, 1u, (entry.outcome & CHECK) != 0));
            }
        }
        var at = atomicAdd(&wanted, changed.count);
        workgroupBarrier();
        // The place in the next list is requested early, because the atomic operation takes a while to return.
        var first = 0u;
        if local == 0 {
            done_here = atomicLoad(&done_len);
            first = atomicAdd(&control.active_len[(bids.iteration + 1) & 1], atomicLoad(&wanted));
        }
        let facets = OUTER_FACETS * workgroupUniformLoad(&done_here);
        for (var j = local; j < facets; j += WORKGROUP) {
            let flip = j / OUTER_FACETS;
            let outer = outer_facet(j % OUTER_FACETS, done[flip].count);
            join(done[flip].slots[outer.x], outer.y, mark);
        }
        if local == 0 {
            given = first;
        }
        at += workgroupUniformLoad(&given) + next;
        if changed.count > 0 {
            actives[at] = Active(changed.slots.x, 0);
        }
        if changed.count > 1 {
            actives[at + 1] = Active(changed.slots.y, 0);
        }
        if changed.count > 2 {
            actives[at + 2] = Active(changed.slots.z, 0);
        }
        start = next_chunk(start, ahead, long, WORKGROUP, groups, local);
    }
    workgroupBarrier();
    if local == 0 && entries != 0 {
        add_flips();
        if group == 0 {
            atomicStore(&control.taken[COMMIT_CHUNKS], 0u);
            control.iteration = bids.iteration + 1;
            control.bid_base = next_bid_base(bids);
        }
    }
}
