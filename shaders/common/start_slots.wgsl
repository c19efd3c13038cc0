// The slots of the simplices that Phase 1 starts with: those of their vertices, in turn.
//
// Expects: start_vertices.

fn start_slot(simplex: u32) -> u32 {
    return SLOTS_PER_POINT * start_vertices[simplex / SLOTS_PER_POINT] + simplex % SLOTS_PER_POINT;
}
