// Linking after flips of triangles.
//
// Expects: control, neighbors; Changed and flips of common/link_pass.

// Returns the kind of a flip that was carried out.
fn kind_of(outcome: u32) -> u32 {
    return FLIP_22;
}

// Returns the triangles of a flip that was carried out.
fn changed_by(entry: Active) -> Changed {
    return Changed(vec3u(entry.tet, neighbors[entry.tet].x >> 2, 0), 2);
}

// The outer edges of a flip.
const OUTER_FACETS: u32 = 4;

// Returns which of the slots of a flip has outer edge j, and as which of its edges: edges 1 and 2
// of both triangles are outer ones.
fn outer_facet(j: u32, count: u32) -> vec2u {
    return vec2u(j / 2, 1 + j % 2);
}

fn add_flips() {
    atomicAdd(&control.flips_22, atomicLoad(&flips[FLIP_22]));
}
