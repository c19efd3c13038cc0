// Checks the facets of active tetrahedra (§3.1, §4.2).
//
// An entry of the active list has one to four facets to check. A workgroup lists the facets of its
// entries and shares them out: with an entry per invocation, most would wait for the few with four
// facets. The invocation of an entry then takes the first of its facets that can be flipped.
//
// Expects: control, simplices, neighbors, status, actives; facet_signs of d3/facet_signs or
// d3/facet_signs_once.
// Where the points of a mesh have moved, a flip of inverted tetrahedra is proposed as soon as those
// that it makes are positively oriented: signed volumes add up, so that they cover what the others
// did.
//
//!include d3/simplex
//!include common/moved_slots
//!include common/bids

// A finding about the facets of an entry: those that need no more checking (bits 0–3); the proposed
// flip and the facets that cannot be flipped, as in Active.outcome; and this bit if a sign is undecided.
const UNDECIDED: u32 = 0x4000;
// The finding about a facet that is locally Delaunay.
const LOCALLY_DELAUNAY: u32 = 0x8000;
// After one of these, the other facets of the entry do not matter.
const ENOUGH: u32 = UNDECIDED | (3u << KIND_SHIFT);

// The facets to be checked, 4·tetrahedron + facet, those of an entry in a row; then what is found out
// about each.
var<workgroup> facets_here: array<u32, 4 * WORKGROUP>;
var<workgroup> facets_len: atomic<u32>;

// Returns how many entries a workgroup looks at together, by their number: fewer where most of the device
// would idle otherwise.
fn checked_together(entries: u32, groups: u32) -> u32 {
    return select(WORKGROUP, WORKGROUP / 4, entries <= groups * (WORKGROUP / 4));
}

// Returns whether the vertices opposite to the facet k of t, across which u lies, already have an
// edge in a tetrahedron that adjoins both. That is so only beside inverted ones.
fn is_edge(t: u32, u: u32, k: u32) -> bool {
    let c = facet(k);
    var found = false;
    for (var j = 0u; j < 3; j++) {
        let opposite = turned(c, j).z;
        let there = place_of(simplices[u], simplices[t][opposite]);
        found = found || neighbors[u][there] >> 2 == neighbors[t][opposite] >> 2;
    }
    return found;
}

// Checks facet k of t and returns the finding.
//
// Components with a computed index are loaded one by one: compilers would keep a whole vector in memory
// of the invocation's own.
fn check_facet(t: u32, tet: vec4u, k: u32) -> u32 {
    let across = neighbors[t][k];
    let u = across >> 2;
    let face = across & 3;
    var found = 1u << k;
    // Loaded before it is known to be needed, so that it does not wait for what comes first.
    let e = simplices[u][face];
    // Where both sides are to check a facet, the lower one does.
    if u < t && ((status[u].made.x >> face) & 1) != 0 {
        return found;
    }
    let has_moved = control.moved_simplices != 0;
    let is_inverted = has_moved && ((status[t].made.x | status[u].made.x) & INVERTED) != 0;
    if is_inverted && simplices[t][k] == e {
        // The same tetrahedron from both sides.
        return found;
    }
    let signs = facet_signs(t, tet, k, e, is_inverted);
    if signs == UNDECIDED {
        return UNDECIDED;
    }
    if signs != LOCALLY_DELAUNAY {
        let c = facet(k);
        let negative = signs & 3;
        let edge = signs >> 2;
        var kind = 0u;
        if negative == 0 {
            kind = select(FLIP_23, 0u, has_moved && is_edge(t, u, k));
        } else if negative == 1 {
            let opposite = turned(c, edge).z;
            let there = place_of(simplices[u], simplices[t][opposite]);
            kind = select(0u, FLIP_32, neighbors[u][there] >> 2 == neighbors[t][opposite] >> 2);
        }
        if kind != 0 {
            found = (kind << KIND_SHIFT) | (k << FACET_SHIFT) | (edge << EDGE_SHIFT);
        } else {
            found |= 1u << (k + SUSPECT_SHIFT);
        }
    }
    return found;
}

// Checks the facets of the tetrahedron of entry i, which is at `at`, and bids for the tetrahedra
// that its flip would change. Returns false if a sign is undecided: then everything is still to be
// checked. All of the workgroup must call it, also those that have no entry, and not again before a
// barrier.
fn check_facets(has_entry: bool, i: u32, at: u32, bids: Bids, local: u32) -> bool {
    if local == 0 {
        atomicStore(&facets_len, 0u);
    }
    workgroupBarrier();
    var t = NONE;
    var flags = 0u;
    var first = 0u;
    var end = 0u;
    if has_entry {
        t = actives[at].tet;
        flags = status[t].made.x;
        var left = flags & CHECK;
        first = atomicAdd(&facets_len, countOneBits(left));
        end = first;
        while left != 0 {
            facets_here[end] = 4 * t + firstTrailingBit(left);
            left &= left - 1;
            end += 1;
        }
    }
    workgroupBarrier();
    let len = atomicLoad(&facets_len);
    for (var j = local; j < len; j += WORKGROUP) {
        let tet = facets_here[j] >> 2;
        facets_here[j] = check_facet(tet, simplices[tet], facets_here[j] & 3);
    }
    workgroupBarrier();
    var found = 0u;
    for (var j = first; j < end && (found & ENOUGH) == 0; j++) {
        found |= facets_here[j];
    }
    if has_entry {
        if (found & UNDECIDED) != 0 {
            actives[at].outcome = flags & 0xff;
        } else {
            let check = flags & CHECK;
            let suspect = (flags >> SUSPECT_SHIFT) & CHECK & ~check;
            actives[at].outcome = (found & ~CHECK) | (suspect << SUSPECT_SHIFT) | (check & ~found);
            let kind = (found >> KIND_SHIFT) & 3;
            if kind != 0 {
                let bid = bid_of(i, bids);
                let k = (found >> FACET_SHIFT) & 3;
                atomicMax(&status[t].vote, bid);
                atomicMax(&status[neighbors[t][k] >> 2].vote, bid);
                if kind == FLIP_32 {
                    let edge = (found >> EDGE_SHIFT) & 3;
                    atomicMax(&status[neighbors[t][turned(facet(k), edge).z] >> 2].vote, bid);
                }
            }
        }
    }
    return (found & UNDECIDED) == 0;
}
