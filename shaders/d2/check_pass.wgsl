// The first pass of a flip iteration: checks the edges of each active triangle until one is not
// locally Delaunay, and bids for the two triangles that its flip would change. Every such edge can
// be flipped.
//
// Expects: control, vertices, simplices, neighbors, status, actives.
//!include d2/signs
//!include common/bids

var<workgroup> exact_here: atomic<u32>;

// Checks `entries` entries, of which workgroup `group` of `groups` takes its share.
fn check_pass(group: u32, groups: u32, local: u32, bids: Bids, entries: u32) {
    let list = half_of(bids.iteration);
    for (var i = group * WORKGROUP + local; i < entries; i += groups * WORKGROUP) {
        let t = actives[list + i].tet;
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
                violated = inside(tri, simplices[u][edge]);
            }
            if violated {
                flip = (FLIP_22 << KIND_SHIFT) | (k << FACET_SHIFT);
            } else {
                check &= ~(1u << k);
            }
        }
        actives[list + i].outcome = flip | check;
        if flip != 0 {
            let bid = bid_of(i, bids);
            atomicMax(&status[t].vote, bid);
            atomicMax(&status[u].vote, bid);
        }
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
        control.iterations += 1;
        control.visits += entries;
    }
}
