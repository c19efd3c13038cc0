// Returns whether a coordinate of this vertex was rounded to the lattice.
//
// Expects: vertices.
fn rounded(v: u32) -> bool {
    return vertices[2 * v + 1].w != 0;
}
