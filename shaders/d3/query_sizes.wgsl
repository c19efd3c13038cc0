// Whether vertices were rounded to the lattice, and how large differences are.
//
// Expects: vertices; d3/exact_wide.
//!include arithmetic/bits
//!include d3/rounding_wide

// Returns the number of bits of the magnitudes of a row, or of one less where they are negative.
fn size_of(r: Row) -> u32 {
    let sign = vec3u(vec3i(r.high) >> vec3u(31));
    let low = r.low ^ sign;
    let high = r.high ^ sign;
    return bits_of(vec2u(low.x | low.y | low.z, high.x | high.y | high.z));
}
