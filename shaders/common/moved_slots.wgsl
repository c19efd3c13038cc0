// The slots of a mesh whose points have moved: its simplices in their order, then the ghosts,
// spread over all slots, so that flips find free ones everywhere.
//
// Expects: control.

// A simplex that is not positively oriented where its points are now, in Status.flags.
const INVERTED: u32 = 0x100;

// The arrays of the mesh are not those of a triangulation, in control.inverted.
const BROKEN: u32 = 0x80000000;

// Returns the slot of a simplex or ghost. The product of the numbers need not fit 32 bits.
fn moved_slot(i: u32) -> u32 {
    let spread = control.moved_spread;
    return i + (i >> 10) * spread + (((i & 1023) * spread) >> 10);
}
