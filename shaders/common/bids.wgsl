// The numbers that the entries of the active list bid with in a flip iteration, and the halves of
// the list.
//
// Expects: control.

// Permutes the numbers of `bits` bits, in a way that changes from iteration to iteration, so that
// the same proposals do not lose again and again.
fn scramble(number: u32, iteration: u32, bits: u32) -> u32 {
    let mask = (1u << bits) - 1;
    let half = bits / 2;
    var x = number ^ ((iteration * 0x9e3779b9u) & mask);
    x = (x * 0x85ebca6bu) & mask;
    x ^= x >> half;
    x = (x * 0xc2b2ae35u) & mask;
    return x ^ (x >> half);
}

// Returns the number that entry i of the active list bids.
fn bid_of(i: u32, iteration: u32, bits: u32) -> u32 {
    return ((iteration + 1) << bits) | scramble(i, iteration, bits - 1);
}

// Returns the vote that marks a simplex as changed in an iteration, which is above every bid of it.
fn changed_mark(iteration: u32, bits: u32) -> u32 {
    return ((iteration + 1) << bits) | ((1u << bits) - 1);
}

// Returns the number of entries of the active list in a flip iteration; 0 if they are too few for
// one.
fn entries_of(iteration: u32) -> u32 {
    let count = atomicLoad(&control.active_len[iteration & 1]);
    return select(count, 0u, count < max(control.min_active, 1u));
}

// Returns where the half of the active list starts that an iteration reads.
fn half_of(iteration: u32) -> u32 {
    return (iteration & 1) * control.blocks * BLOCK;
}
