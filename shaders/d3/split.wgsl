@group(0) @binding(7) var<storage, read_write> free: array<u32>;

// Notes that the slots of the children at point p are not free any more.
fn take_slots(p: u32) {
    free[p] = free[p] & ~7u;
}
