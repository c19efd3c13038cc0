// The slots of the simplices that Phase 1 starts with: the first ones of each of their vertices, so
// that flips find free ones everywhere.
//
// Expects: control, start_vertices.

fn start_slot(simplex: u32) -> u32 {
    let points = control.start_points;
    return SLOTS_PER_POINT * start_vertices[simplex % points] + simplex / points;
}
