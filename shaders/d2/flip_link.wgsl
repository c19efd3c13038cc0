// What a flip of triangles leaves to link.
//
// Expects: control, neighbors; Changed, flips and join of common/link_pass.

// Returns whether flip_link lists the triangles to check next: no other kernel does.
fn lists_next(entries: u32) -> bool {
    return true;
}

// Returns the triangles of a flip that was carried out.
fn changed_by(entry: Active) -> Changed {
    return Changed(2, vec3u(entry.tet, neighbors[entry.tet].x >> 2, 0));
}

// Joins the outer edges.
fn join_outer(changed: Changed, mark: u32) {
    join(changed.slots.x, 1, mark);
    join(changed.slots.x, 2, mark);
    join(changed.slots.y, 1, mark);
    join(changed.slots.y, 2, mark);
}

fn add_flips() {
    atomicAdd(&control.flips_22, atomicLoad(&flips[FLIP_22]));
}
