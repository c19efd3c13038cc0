// What becomes of the simplices that a flip changes, in the history and in their status.
//
// Expects: control; status: array<OwnedStatus>; history, whose nodes have `next`.

// What the flips of a round have to know of it. Read once, because the compiler cannot know that no
// store changes it.
struct Round {
    number: u32,
    first_node: u32,
}

// Makes the node that made simplex t, which `made` of its status names, or t's place in the list of first
// nodes, point to `node`.
fn link_node(t: u32, made: vec2u, node: u32, round: Round) {
    if made.x >> HELD_SHIFT == round.number {
        let last = made.y;
        if last >> 2 >= round.first_node {
            history[(last >> 2) - round.first_node].next[last & 3] = node;
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
