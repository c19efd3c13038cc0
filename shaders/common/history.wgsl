// What becomes of the simplices that a flip changes, in the history and in their status.
//
// Expects: control; status: array<OwnedStatus>; history, whose nodes have `next`.

// Makes the node that made simplex t, which `made` of its status names, or t's place in the list of first
// nodes, point to `node`.
fn link_node(t: u32, made: vec2u, node: u32, round: u32) {
    if made.x >> HELD_SHIFT == round {
        let last = made.y;
        if last == 0 {
            status[t].first = node + 1;
        } else {
            history[(last >> 2) - 1].next[last & 3] = node;
        }
    }
}

// Overwrites the status of a simplex that a flip changed.
fn renew(t: u32, flags: u32, mark: u32, last: u32) {
    status[t].made = vec2u(flags, last);
    atomicStore(&status[t].vote, mark);
}
