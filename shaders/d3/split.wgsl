// Free slots of tetrahedra.
//
// Expects: control.

// Notes that the slots of the children at point p are not free any more.
fn take_slots(p: u32) {
    atomicAnd(&control.free[p], ~7u);
}

// Notes that a slot is not free any more.
fn take_slot(slot: u32) {
    atomicAnd(&control.free[slot / BLOCK], ~(1u << (slot % BLOCK)));
}
