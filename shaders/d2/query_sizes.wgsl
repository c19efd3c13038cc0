// Whether vertices were rounded to the lattice, and how large differences are.
//
// Expects: vertices; d2/exact_wide.
//!include arithmetic/bits

// Returns whether a coordinate of this vertex was rounded to the lattice.
fn rounded(v: u32) -> bool {
    return vertices[v].z < 0;
}

// Returns the number of bits of the magnitudes of a row, or of one less where they are negative.
fn size_of(r: Row) -> u32 {
    let sign = vec2u(vec2i(r.high) >> vec2u(31));
    let low = r.low ^ sign;
    let high = r.high ^ sign;
    return bits_of(vec2u(low.x | low.y, high.x | high.y));
}
