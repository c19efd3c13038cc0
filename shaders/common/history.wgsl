// What becomes of the simplices that a flip changes, in the history and in their status.
//
// Expects: control; status: array<OwnedStatus>; history, whose nodes have `next`.

// Makes the node that made simplex t, or t's place in the list of first nodes, point to `node`.
fn link_node(t: u32, node: u32, first: u32) {
    let made = status[t].made;
    if made.x >> HELD_SHIFT == control.round {
        let last = made.y;
        if last >> 2 >= first {
            history[(last >> 2) - first].next[last & 3] = node;
        } else {
            status[t].first = node;
        }
    }
}

// Overwrites the status of a simplex that a flip changed.
fn renew(t: u32, flags: u32, mark: u32, last: u32) {
    status[t].made = vec2u(flags, last);
    atomicStore(&status[t].vote, mark);
}
