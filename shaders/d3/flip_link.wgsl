// What a flip of tetrahedra leaves to link.
//
// Expects: control, neighbors; Changed, flips and join of common/link_pass.

// Returns whether flip_link lists the tetrahedra to check next; otherwise flip_compact does.
fn lists_next(entries: u32) -> bool {
    return entries < control.compact_from;
}

// Returns the tetrahedra of a flip that was carried out. A 3-2 flip gives back a slot.
fn changed_by(entry: Active) -> Changed {
    let inner = neighbors[entry.tet];
    if (entry.outcome & 3) == FLIP_23 {
        return Changed(3, vec3u(entry.tet, inner.x >> 2, inner.y >> 2));
    }
    let slot = (entry.outcome & ~DONE) >> SLOT_SHIFT;
    atomicOr(&control.free[slot / BLOCK], 1u << (slot % BLOCK));
    return Changed(2, vec3u(entry.tet, inner.w >> 2, 0));
}

// Joins the outer facets: 2 and 3 of three tetrahedra, 0, 1 and 2 of two.
fn join_outer(changed: Changed, mark: u32) {
    let is_23 = changed.count == 3;
    for (var k = 0u; k < changed.count; k++) {
        for (var face = select(0u, 2u, is_23); face < select(3u, 4u, is_23); face++) {
            join(changed.slots[k], face, mark);
        }
    }
}

fn add_flips() {
    atomicAdd(&control.flips_23, atomicLoad(&flips[FLIP_23]));
    atomicAdd(&control.flips_32, atomicLoad(&flips[FLIP_32]));
}
