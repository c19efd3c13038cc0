// Expects: SLOTS_PER_POINT.

// Returns the slot of the child with point p in place of corner k, when simplex t is split at p: t
// keeps its slot, and the others have those of p.
fn child_slot(t: u32, p: u32, k: u32) -> u32 {
    return select(SLOTS_PER_POINT * p + k - 1, t, k == 0);
}
