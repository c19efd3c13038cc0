// Flips of tetrahedra.
//
// Expects: control, simplices, neighbors, status, messages, history; common/bids, common/history.
//!include common/moved_slots

// How often a flip looks for a free slot in the blocks of other vertices: those before and behind its own
// ones on the curve.
const BESIDE_TRIES: u32 = 2;
// How often it looks for one in four blocks of the tail.
const TAIL_TRIES: u32 = 12;
// How often it does so near the vertex's place in the tail, so that what is near in space is near in
// memory: among so many blocks at first, then among 16 times as many each time.
const NEAR_TRIES: u32 = 2;
const TAIL_WINDOW: u32 = 16;

// Takes a slot of a block in which these were free. Returns NONE if other flips have taken them.
fn take_from(block: u32, free: u32) -> u32 {
    var places = free;
    var slot = NONE;
    while places != 0 && slot == NONE {
        let place = firstTrailingBit(places);
        let before = atomicAnd(&control.free[block], ~(1u << place));
        if ((before >> place) & 1) != 0 {
            slot = block * BLOCK + place;
        }
        places = before & ALL_FREE & ~(1u << place);
    }
    return slot;
}

// Returns the free slots of a block, none where its word is `reserved`.
fn free_in(block: u32, reserved: u32) -> u32 {
    let word = atomicLoad(&control.free[block]);
    return select(word & ALL_FREE, 0u, word == reserved);
}

// Takes a free slot from the block of a vertex of the flip or of one beside it, else from one of a few
// blocks of the tail. Returns NONE if there is none. Several blocks are looked at together, because
// each look is a long wait.
fn free_slot(ring: vec3u, d: u32, e: u32, t: u32, iteration: u32) -> u32 {
    let tail = control.blocks - control.infinite - 1;
    // Infinity has no place, and one of two vertices of the ring is finite.
    let place = min(ring.x, ring.y) / max(control.infinite / max(tail, 1u), 1u);
    let seed = scramble(t, iteration, 31);
    var blocks = vec4u(ring, d);
    var last = e;
    var slot = NONE;
    for (var i = 0u; i <= BESIDE_TRIES + TAIL_TRIES && slot == NONE; i++) {
        // The slots of vertices that are not inserted yet are all free, but reserved.
        let reserved = select(0u, ALL_FREE, i > 0 && i <= BESIDE_TRIES);
        let x = free_in(blocks.x, reserved);
        let y = free_in(blocks.y, reserved);
        let z = free_in(blocks.z, reserved);
        let w = free_in(blocks.w, reserved);
        var block = last;
        var places = free_in(last, reserved);
        block = select(block, blocks.w, w != 0);
        places = select(places, w, w != 0);
        block = select(block, blocks.z, z != 0);
        places = select(places, z, z != 0);
        block = select(block, blocks.y, y != 0);
        places = select(places, y, y != 0);
        block = select(block, blocks.x, x != 0);
        places = select(places, x, x != 0);
        slot = take_from(block, places);
        if i < BESIDE_TRIES {
            let beside = select(0xffffffffu, 1u, i == 0);
            blocks = min(vec4u(ring, d) + beside, vec4u(control.infinite));
            last = min(e + beside, control.infinite);
        } else if tail == 0 {
            break;
        } else {
            let k = i - BESIDE_TRIES;
            let window = select(tail, min(TAIL_WINDOW << (4 * k), tail), k < NEAR_TRIES);
            let tries = (vec4u(seed) + (4 * k + vec4u(0, 1, 2, 3)) * 0x9e3779b9u) % window;
            blocks = control.infinite + 1 + (place + tries) % tail;
            last = blocks.w;
        }
    }
    return slot;
}

// A proposed flip.
struct Proposal {
    // 0 if there is none.
    kind: u32,
    // The tetrahedra; the third one only in 3-2 flips, otherwise the second one again.
    t: u32,
    u: u32,
    w: u32,
    // The facet of t, and its corners.
    k: u32,
    c: vec3u,
}

// Returns the flip that an entry proposes.
fn proposal_of(entry: Active) -> Proposal {
    let kind = (entry.outcome >> KIND_SHIFT) & 3;
    var proposal = Proposal(kind, entry.tet, 0, 0, 0, vec3u(0));
    if kind != 0 {
        let k = (entry.outcome >> FACET_SHIFT) & 3;
        proposal.k = k;
        proposal.c = turned(facet(k), (entry.outcome >> EDGE_SHIFT) & 3);
        proposal.u = neighbors[entry.tet][k] >> 2;
        proposal.w = proposal.u;
        if kind == FLIP_32 {
            proposal.w = neighbors[entry.tet][proposal.c.z] >> 2;
        }
    }
    return proposal;
}

// Returns whether a proposal has won all of its tetrahedra with this bid. The loads do not wait for each
// other.
fn has_won(p: Proposal, bid: u32) -> bool {
    let t = atomicLoad(&status[p.t].vote);
    let u = atomicLoad(&status[p.u].vote);
    let w = atomicLoad(&status[p.w].vote);
    return ((t ^ bid) | (u ^ bid) | (w ^ bid)) == 0;
}

// Returns whether waiting points may lie in the tetrahedra of a proposal.
fn is_held(p: Proposal, round: u32) -> bool {
    let t = status[p.t].made.x >> HELD_SHIFT;
    let u = status[p.u].made.x >> HELD_SHIFT;
    let w = status[p.w].made.x >> HELD_SHIFT;
    return min(min(t ^ round, u ^ round), w ^ round) == 0;
}

// Begins a flip: takes the slot of the third tetrahedron, and writes history and status. `node` is
// its number in the history, NONE where no waiting point can lie in its tetrahedra. Returns the
// third tetrahedron; NONE if there is no slot.
fn begin_flip(flip: Proposal, node: u32, bids: Bids, round: u32) -> u32 {
    let kind = flip.kind;
    let t = flip.t;
    let u = flip.u;
    let made_t = status[t].made;
    let made_u = status[u].made;
    let made_w = status[flip.w].made;
    // As FlipNode has it: the ring and the ends of the edge.
    var ring = vec3u(simplices[t][flip.c.x], simplices[t][flip.c.y], simplices[t][flip.c.z]);
    var d = simplices[t][flip.k];
    var e = simplices[u][neighbors[t][flip.k] & 3];
    var third = flip.w;
    if kind == FLIP_23 {
        third = free_slot(ring, d, e, t, bids.iteration);
    } else {
        let x = ring;
        ring = vec3u(d, x.z, e);
        d = x.x;
        e = x.y;
    }
    if third != NONE {
        if node != NONE {
            link_node(t, made_t, node, round);
            link_node(u, made_u, node, round);
            if kind == FLIP_32 {
                link_node(third, made_w, node, round);
            }
            history[node] = FlipNode(ring, d, vec3u(t, u, third), e, vec3u(NONE), kind);
        }
        let mark = changed_mark(bids);
        let flags = select(round << HELD_SHIFT, 0u, node == NONE);
        let last = select((node + 1) << 2, 0u, node == NONE);
        let step = select(1u, 0u, node == NONE);
        // The inner facets are locally Delaunay, unless the flip was one of an inverted tetrahedron.
        let before = made_t.x | made_u.x | made_w.x;
        let was_inverted = control.moved_simplices != 0 && (before & INVERTED) != 0;
        let check = select(select(0x7u, 0xcu, kind == FLIP_23), CHECK, was_inverted);
        renew(t, flags | check, mark, last);
        renew(u, flags | check, mark, last + step);
        renew(third, select(0u, flags | check, kind == FLIP_23), mark, last + 2 * step);
    }
    return third;
}

// Ends a flip that has begun: writes the tetrahedra, and the messages. Returns the entry's outcome.
//
// Components with a computed index are loaded one by one: compilers would keep a whole vector in memory
// of the invocation's own.
fn end_flip(flip: Proposal, third: u32) -> u32 {
    let kind = flip.kind;
    let t = flip.t;
    let u = flip.u;
    let c = flip.c;
    let tet_u = simplices[u];
    let x = vec3u(simplices[t][c.x], simplices[t][c.y], simplices[t][c.z]);
    let d = simplices[t][flip.k];
    let e = simplices[u][neighbors[t][flip.k] & 3];
    var left = DONE_23;
    if kind == FLIP_23 {
        // (x_i, x_i+1, d, e): face 0 leads to the next of the three, face 1 to the one before,
        // faces 2 and 3 are the old facets with e and with d.
        let p = vec3u(place_of(tet_u, x.x), place_of(tet_u, x.y), place_of(tet_u, x.z));
        let near_t = vec3u(neighbors[t][c.x], neighbors[t][c.y], neighbors[t][c.z]);
        let near_u = vec3u(neighbors[u][p.x], neighbors[u][p.y], neighbors[u][p.z]);
        simplices[t] = vec4u(x.x, x.y, d, e);
        simplices[u] = vec4u(x.y, x.z, d, e);
        simplices[third] = vec4u(x.z, x.x, d, e);
        neighbors[t] = vec4u(4 * u + 1, 4 * third, near_u.z, near_t.z);
        neighbors[u] = vec4u(4 * third + 1, 4 * t, near_u.x, near_t.x);
        neighbors[third] = vec4u(4 * t + 1, 4 * u, near_u.y, near_t.y);
        messages[t] = replaced(replaced(replaced(vec4u(NONE), c.z, 4 * t + 3), c.x, 4 * u + 3), c.y, 4 * third + 3);
        messages[u] = replaced(replaced(replaced(vec4u(NONE), p.z, 4 * t + 2), p.x, 4 * u + 2), p.y, 4 * third + 2);
    } else {
        // The upper tetrahedron (x_0, x_1, x_2, e) and the lower one (x_0, x_2, x_1, d) of the ring
        // and the ends of the edge, joined by their faces 3. The facets opposite ring vertex j were
        // of the old one with the other two: w, t and u have 20, 01 and 12.
        let tet_w = simplices[third];
        let pt = vec2u(c.x, c.y);
        let pu = vec2u(place_of(tet_u, x.x), place_of(tet_u, x.y));
        let pw = vec2u(place_of(tet_w, x.x), place_of(tet_w, x.y));
        let near_t = vec2u(neighbors[t][pt.x], neighbors[t][pt.y]);
        let near_u = vec2u(neighbors[u][pu.x], neighbors[u][pu.y]);
        let near_w = vec2u(neighbors[third][pw.x], neighbors[third][pw.y]);
        simplices[t] = vec4u(d, x.z, e, x.y);
        simplices[u] = vec4u(d, e, x.z, x.x);
        simplices[third] = vec4u(0);
        neighbors[t] = vec4u(near_u.x, near_w.x, near_t.x, 4 * u + 3);
        neighbors[u] = vec4u(near_u.y, near_t.y, near_w.y, 4 * t + 3);
        messages[t] = replaced(replaced(vec4u(NONE), pt.x, 4 * t + 2), pt.y, 4 * u + 1);
        messages[u] = replaced(replaced(vec4u(NONE), pu.x, 4 * t), pu.y, 4 * u);
        messages[third] = replaced(replaced(vec4u(NONE), pw.x, 4 * t + 1), pw.y, 4 * u + 2);
        left = third << SLOT_SHIFT;
    }
    return DONE | left;
}
