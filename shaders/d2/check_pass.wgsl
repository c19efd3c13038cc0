// The first pass of a flip iteration: checks the edges of each active triangle until one is not
// locally Delaunay, and bids for the two triangles that its flip would change. Every such edge can
// be flipped.
//
// Where the points of a mesh have moved, a flip of an inverted triangle is proposed as soon as those
// that it makes are positively oriented: signed areas add up, so that they cover what the others
// did.
//
// Expects: control, vertices, simplices, neighbors, status, actives.
//!include d2/signs
//!include common/bids
//!include common/chunks
//!include common/moved_slots

var<workgroup> exact_here: atomic<u32>;

// Checks the edges of the triangle of entry i, which is at `at`.
fn check_edges(at: u32, i: u32, bids: Bids) {
    let t = actives[at].tet;
    let tri = simplices[t].xyz;
    var check = status[t].made.x & CHECK;
    var flip = 0u;
    var u = NONE;
    for (var k = 0u; k < 3 && flip == 0; k++) {
        if ((check >> k) & 1) == 0 {
            continue;
        }
        let across = neighbors[t][k];
        u = across >> 2;
        let edge = across & 3;
        // Where both sides are to check an edge, the lower one does.
        let theirs = u < t && ((status[u].made.x >> edge) & 1) != 0;
        var violated = false;
        if !theirs {
            let e = simplices[u][edge];
            if control.moved_simplices == 0 || ((status[t].made.x | status[u].made.x) & INVERTED) == 0 {
                violated = inside(tri, e);
            } else if e != tri[k] {
                violated = orient(vec3u(tri[(k + 1) % 3], e, tri[k])) > 0 && orient(vec3u(tri[(k + 2) % 3], tri[k], e)) > 0;
            }
        }
        if violated {
            flip = (FLIP_22 << KIND_SHIFT) | (k << FACET_SHIFT);
        } else {
            check &= ~(1u << k);
        }
    }
    actives[at].outcome = flip | check;
    if flip != 0 {
        let bid = bid_of(i, bids);
        atomicMax(&status[t].vote, bid);
        atomicMax(&status[u].vote, bid);
    }
}

// Checks `entries` entries, of which workgroup `group` of `groups` takes its share.
fn check_pass(group: u32, groups: u32, local: u32, bids: Bids, entries: u32) {
    let list = half_of(bids.iteration);
    let long = is_long(entries, WORKGROUP, groups);
    var start = group * WORKGROUP;
    while start < entries {
        let ahead = chunk_ahead(CHECK_CHUNKS, long, WORKGROUP, groups, local);
        if start + local < entries {
            check_edges(list + start + local, start + local, bids);
        }
        start = next_chunk(start, ahead, long, WORKGROUP, groups, local);
    }
    if local == 0 {
        atomicStore(&exact_here, 0u);
    }
    workgroupBarrier();
    if exact_signs != 0 {
        atomicAdd(&exact_here, exact_signs);
        exact_signs = 0;
    }
    workgroupBarrier();
    if local == 0 && atomicLoad(&exact_here) != 0 {
        atomicAdd(&control.exact, atomicLoad(&exact_here));
    }
    if local == 0 && group == 0 && entries != 0 {
        atomicStore(&control.taken[LINK_CHUNKS], 0u);
        control.iterations += 1;
        control.visits += entries;
    }
}
