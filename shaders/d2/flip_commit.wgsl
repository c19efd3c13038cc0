// Flips of triangles.
//
// Expects: control, simplices, neighbors, status, messages, history; common/bids, common/history.
//!include common/moved_slots

// A proposed flip.
struct Proposal {
    // 0 if there is none.
    kind: u32,
    // The triangles, and the edge of t.
    t: u32,
    u: u32,
    k: u32,
}

// Returns the flip that an entry proposes.
fn proposal_of(entry: Active) -> Proposal {
    let kind = (entry.outcome >> KIND_SHIFT) & 3;
    var proposal = Proposal(kind, entry.tet, 0, (entry.outcome >> FACET_SHIFT) & 3);
    if kind != 0 {
        proposal.u = neighbors[entry.tet][proposal.k] >> 2;
    }
    return proposal;
}

// Returns whether a proposal has won both of its triangles with this bid. The loads do not wait for each
// other.
fn has_won(p: Proposal, bid: u32) -> bool {
    let t = atomicLoad(&status[p.t].vote);
    let u = atomicLoad(&status[p.u].vote);
    return ((t ^ bid) | (u ^ bid)) == 0;
}

// Returns whether waiting points may lie in the triangles of a proposal.
fn is_held(p: Proposal, round: u32) -> bool {
    let t = status[p.t].made.x >> HELD_SHIFT;
    let u = status[p.u].made.x >> HELD_SHIFT;
    return min(t ^ round, u ^ round) == 0;
}

// Begins a flip: writes history and status. `node` is its number in the history, NONE where no
// waiting point can lie in its triangles. Returns the second triangle.
fn begin_flip(flip: Proposal, node: u32, bids: Bids, round: u32) -> u32 {
    let t = flip.t;
    let u = flip.u;
    let made_t = status[t].made;
    let made_u = status[u].made;
    if node != NONE {
        link_node(t, made_t, node, round);
        link_node(u, made_u, node, round);
        let d = simplices[t][flip.k];
        let e = simplices[u][neighbors[t][flip.k] & 3];
        history[node] = EdgeFlip(vec2u(e, d), vec2u(t, u), vec2u(NONE));
    }
    let mark = changed_mark(bids);
    // The inner edge is locally Delaunay, unless the flip was one of an inverted triangle.
    let was_inverted = control.moved_simplices != 0 && ((made_t.x | made_u.x) & INVERTED) != 0;
    let flags = select(round << HELD_SHIFT, 0u, node == NONE) | select(6u, 7u, was_inverted);
    let last = select((node + 1) << 2, 0u, node == NONE);
    renew(t, flags, mark, last);
    renew(u, flags, mark, last + select(1u, 0u, node == NONE));
    return u;
}

// Ends a flip that has begun: writes the triangles, and the messages. Returns the entry's outcome.
//
// Components with a computed index are loaded one by one: compilers would keep a whole vector in memory
// of the invocation's own.
fn end_flip(flip: Proposal, u: u32) -> u32 {
    let t = flip.t;
    let k = flip.k;
    // t is (d, a, b) and u is (e, b, a), counted from the corners opposite the edge.
    let ka = (k + 1) % 3;
    let kb = (k + 2) % 3;
    let f = neighbors[t][k] & 3;
    let fb = (f + 1) % 3;
    let fa = (f + 2) % 3;
    let d = simplices[t][k];
    let a = simplices[t][ka];
    let b = simplices[t][kb];
    let e = simplices[u][f];
    let beyond_t = vec2u(neighbors[t][ka], neighbors[t][kb]);
    let beyond_u = vec2u(neighbors[u][fa], neighbors[u][fb]);
    // (a, e, d) and (b, d, e), joined by their edges 0.
    simplices[t] = vec4u(a, e, d, 0);
    simplices[u] = vec4u(b, d, e, 0);
    neighbors[t] = vec4u(4 * u, beyond_t.y, beyond_u.y, 0);
    neighbors[u] = vec4u(4 * t, beyond_u.x, beyond_t.x, 0);
    messages[t] = vec4u(replaced(replaced(vec3u(NONE), kb, 4 * t + 1), ka, 4 * u + 2), 0);
    messages[u] = vec4u(replaced(replaced(vec3u(NONE), fb, 4 * t + 2), fa, 4 * u + 1), 0);
    return DONE;
}
