// Flips of triangles.
//
// Expects: control, simplices, neighbors, status, messages, history; common/bids, common/history.

// A flip that won both of its triangles.
struct Flip {
    kind: u32,
    // One of the triangles, and its edge.
    t: u32,
    k: u32,
    // Whether waiting points may lie in the triangles.
    held: bool,
}

// Returns the flip that entry i proposes; kind 0 if it proposes none, or has lost.
fn winner(i: u32, entry: Active, bids: Bids) -> Flip {
    var flip = Flip();
    if ((entry.outcome >> KIND_SHIFT) & 3) != 0 {
        let t = entry.tet;
        let k = (entry.outcome >> FACET_SHIFT) & 3;
        let u = neighbors[t][k] >> 2;
        let bid = bid_of(i, bids);
        if atomicLoad(&status[t].vote) == bid && atomicLoad(&status[u].vote) == bid {
            let round = control.round;
            let held = atomicLoad(&status[t].flags) >> HELD_SHIFT == round
                || atomicLoad(&status[u].flags) >> HELD_SHIFT == round;
            flip = Flip(FLIP_22, t, k, held);
        }
    }
    return flip;
}

// Carries out a flip. `node` is its number in the history, NONE where no waiting point can lie in
// its triangles. Returns the entry's outcome.
fn carry_out(flip: Flip, node: u32, bids: Bids) -> u32 {
    let mark = changed_mark(bids);
    let t = flip.t;
    let k = flip.k;
    let near_t = neighbors[t].xyz;
    let u = near_t[k] >> 2;
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
