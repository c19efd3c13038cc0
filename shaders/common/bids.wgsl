// The numbers that the entries of the active list bid with in a flip iteration, and the halves of
// the list.
//
// Votes are never cleared between iterations: the bids of an iteration are above all votes of those
// before it. They take up no more numbers than the iteration has entries, so that the numbers last
// for many iterations.
//
// Expects: control.

// The bids of a flip iteration.
struct Bids {
    // The iteration, which decides on the order of the bids.
    iteration: u32,
    // The lowest bid: above all votes of earlier iterations.
    base: u32,
    // The bits of a bidder's number.
    bits: u32,
}

// Returns the bids of an iteration with so many entries.
fn bids_of(iteration: u32, base: u32, entries: u32) -> Bids {
    // scramble needs two bits.
    return Bids(iteration, base, max(32 - countLeadingZeros(entries), 2));
}

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
fn bid_of(i: u32, bids: Bids) -> u32 {
    return bids.base + scramble(i, bids.iteration, bids.bits);
}

// Returns the vote that marks a simplex as changed in an iteration, which is above every bid of it.
fn changed_mark(bids: Bids) -> u32 {
    return bids.base + (1u << bids.bits);
}

// Returns the lowest bid of the next iteration.
fn next_bid_base(bids: Bids) -> u32 {
    return changed_mark(bids) + 1;
}

// Returns the number of entries of the active list in a flip iteration whose lowest bid is `base`;
// 0 if they are fewer than `least`, or if there are not enough numbers left for their bids: then
// they wait until the votes are cleared.
fn entries_of(iteration: u32, base: u32, least: u32) -> u32 {
    let count = atomicLoad(&control.active_len[iteration & 1]);
    return select(0u, count, count >= least && base <= MAX_BID_BASE);
}

// Returns the fewest entries for which a flip iteration takes a dispatch per pass; flip_few takes
// fewer in one workgroup.
fn many() -> u32 {
    return max(control.min_active, control.few + 1);
}

// Returns where the half of the active list starts that an iteration reads.
fn half_of(iteration: u32) -> u32 {
    return (iteration & 1) * control.blocks * BLOCK;
}

// The largest of the lowest bids. Simplices are numbered in 30 bits, so that 2^31 numbers are
// enough for an iteration.
const MAX_BID_BASE: u32 = 0x7fffffff;
