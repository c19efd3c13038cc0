// Free slots of tetrahedra.
//
// Expects: control.

// Notes that point p is inserted, and that the slots of its children are not free any more. All of its
// slots were.
fn take_slots(p: u32) {
    atomicStore(&control.free[p], (control.round << ROUND_SHIFT) | (ALL_FREE & ~7u));
}

// Notes that a slot is not free any more.
fn take_slot(slot: u32) {
    atomicAnd(&control.free[slot / BLOCK], ~(1u << (slot % BLOCK)));
}
