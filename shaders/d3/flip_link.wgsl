// Linking after flips of tetrahedra.
//
// Expects: control, neighbors; Changed and flips of common/link_pass.

// Returns the kind of a flip that was carried out.
fn kind_of(outcome: u32) -> u32 {
    return select(FLIP_32, FLIP_23, (outcome & DONE_23) != 0);
}

// Returns the tetrahedra of a flip that was carried out. A 3-2 flip gives back a slot.
fn changed_by(entry: Active) -> Changed {
    let inner = neighbors[entry.tet];
    if (entry.outcome & DONE_23) != 0 {
        return Changed(vec3u(entry.tet, inner.x >> 2, inner.y >> 2), 3);
    }
    let slot = (entry.outcome & ~DONE) >> SLOT_SHIFT;
    atomicOr(&control.free[slot / BLOCK], 1u << (slot % BLOCK));
    return Changed(vec3u(entry.tet, inner.w >> 2, 0), 2);
}

// The outer facets of a flip.
const OUTER_FACETS: u32 = 6;

// Returns which of the slots of a flip that made so many tetrahedra has outer facet j, and as which
// of its facets: facets 2 and 3 of three tetrahedra are outer ones, and 0, 1 and 2 of two.
fn outer_facet(j: u32, count: u32) -> vec2u {
    return select(vec2u(j / 3, j % 3), vec2u(j / 2, 2 + j % 2), count == 3);
}

fn add_flips() {
    atomicAdd(&control.flips_23, atomicLoad(&flips[FLIP_23]));
    atomicAdd(&control.flips_32, atomicLoad(&flips[FLIP_32]));
}
