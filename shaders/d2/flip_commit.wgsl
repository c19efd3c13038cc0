// Flips of triangles.
//
// Expects: control, simplices, neighbors, status, messages, history; common/bids, common/history.

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

// Returns whether a proposal has won both of its triangles with this bid.
fn has_won(p: Proposal, bid: u32) -> bool {
    return atomicLoad(&status[p.t].vote) == bid && atomicLoad(&status[p.u].vote) == bid;
}

// Returns whether waiting points may lie in the triangles of a proposal.
fn is_held(p: Proposal) -> bool {
    let round = control.round;
    return status[p.t].made.x >> HELD_SHIFT == round
        || status[p.u].made.x >> HELD_SHIFT == round;
}

// Carries out a flip. `node` is its number in the history, NONE where no waiting point can lie in
// its triangles. Returns the entry's outcome.
fn carry_out(flip: Proposal, node: u32, bids: Bids) -> u32 {
    let mark = changed_mark(bids);
    let t = flip.t;
    let k = flip.k;
    let near_t = neighbors[t].xyz;
    let u = flip.u;
    let near_u = neighbors[u].xyz;
    // t is (d, a, b) and u is (e, b, a), counted from the corners opposite the edge.
    let tri_t = simplices[t].xyz;
    let tri_u = simplices[u].xyz;
    let ka = (k + 1) % 3;
    let kb = (k + 2) % 3;
    let f = near_t[k] & 3;
    let fb = (f + 1) % 3;
    let fa = (f + 2) % 3;
    let d = tri_t[k];
    let a = tri_t[ka];
    let b = tri_t[kb];
    let e = tri_u[f];
    if node != NONE {
        let first = control.first_node;
        link_node(t, node, first);
        link_node(u, node, first);
        history[node - first] = EdgeFlip(vec2u(e, d), vec2u(t, u), vec2u(NONE));
    }
    let flags = select(control.round << HELD_SHIFT, 0u, node == NONE) | 6;
    let last = select(node << 2, 0u, node == NONE);
    renew(t, flags, mark, last);
    renew(u, flags, mark, last + select(1u, 0u, node == NONE));
    // (a, e, d) and (b, d, e), joined by their edges 0.
    simplices[t] = vec4u(a, e, d, 0);
    simplices[u] = vec4u(b, d, e, 0);
    neighbors[t] = vec4u(4 * u, near_t[kb], near_u[fb], 0);
    neighbors[u] = vec4u(4 * t, near_u[fa], near_t[ka], 0);
    messages[t] = vec4u(replaced(replaced(vec3u(NONE), kb, 4 * t + 1), ka, 4 * u + 2), 0);
    messages[u] = vec4u(replaced(replaced(vec3u(NONE), fb, 4 * t + 2), fa, 4 * u + 1), 0);
    return DONE | FLIP_22;
}
