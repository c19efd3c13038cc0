// Free slots of tetrahedra.
//
// Expects: control.

// Notes that the slots of the children at point p are not free any more.
fn take_slots(p: u32) {
    atomicAnd(&control.free[p], ~7u);
}
