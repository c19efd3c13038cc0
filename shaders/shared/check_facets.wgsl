// Checking the facets of an active tetrahedron (§3.1, §4.2).
//
// Expects: orient, conflict, control.
//!include shared/layout
//!include shared/bids
@group(0) @binding(2) var<storage, read> tets: array<vec4u>;
@group(0) @binding(3) var<storage, read> neighbors: array<vec4u>;
@group(0) @binding(4) var<storage, read_write> status: array<Status>;
@group(0) @binding(5) var<storage, read_write> actives: array<Active>;

// Checks the facets of the tetrahedron of entry i, which is at `at`, until one can be flipped, and bids for the tetrahedra
// that this flip would change. False when a sign is open: then everything is still to be checked.
fn check_facets(i: u32, at: u32, iteration: u32, bits: u32) -> bool {
    let t = actives[at].tet;
    let tet = tets[t];
    let near = neighbors[t];
    let flags = atomicLoad(&status[t].flags);
    var check = flags & CHECK;
    var suspect = (flags >> SUSPECT_SHIFT) & CHECK & ~check;
    var flip = 0u;
    var u = NONE;
    var w = NONE;
    var open = false;
    for (var k = 0u; k < 4 && flip == 0 && !open; k++) {
        if ((check >> k) & 1) == 0 {
            continue;
        }
        u = near[k] >> 2;
        let face = near[k] & 3;
        // Where both sides are to check a facet, the lower one does.
        let theirs = u < t && ((atomicLoad(&status[u].flags) >> face) & 1) != 0;
        var violated = false;
        let beyond = tets[u];
        let e = beyond[face];
        if !theirs {
            let sign = conflict(tet, e);
            violated = sign > 0;
            open = sign == 0;
        }
        if violated {
            let c = facet(k);
            let x = vec3u(tet[c.x], tet[c.y], tet[c.z]);
            var negative = 0u;
            var edge = 0u;
            for (var j = 0u; j < 3 && negative < 2 && !open; j++) {
                let sign = orient(vec4u(x[j], x[(j + 1) % 3], tet[k], e));
                open = sign == 0;
                if sign < 0 {
                    negative += 1;
                    edge = j;
                }
            }
            if negative == 0 {
                flip = FLIP_23;
            } else if negative == 1 {
                let opposite = (edge + 2) % 3;
                w = near[c[opposite]] >> 2;
                let there = place_of(beyond, x[opposite]);
                if neighbors[u][there] >> 2 == w {
                    flip = FLIP_32;
                }
            }
            if flip != 0 {
                flip = (flip << KIND_SHIFT) | (k << FACET_SHIFT) | (edge << EDGE_SHIFT);
            } else {
                suspect |= 1u << k;
            }
        }
        if flip == 0 {
            check &= ~(1u << k);
        }
    }
    if open {
        actives[at].outcome = flags & 0xff;
    } else {
        actives[at].outcome = flip | (suspect << SUSPECT_SHIFT) | check;
        if flip != 0 {
            let bid = bid_of(i, iteration, bits);
            atomicMax(&status[t].vote, bid);
            atomicMax(&status[u].vote, bid);
            if ((flip >> KIND_SHIFT) & 3) == FLIP_32 {
                atomicMax(&status[w].vote, bid);
            }
        }
    }
    return !open;
}
