// On which sides of the edges of a triangle a query is, as far as the filter decides: 1 inside, −1
// outside, 0 where that is not certain. The signs are those of the true coordinates.
//
// Expects: vertices; simplices.
//!include d2/exact_wide
//!include d2/filter

// Returns the high words of a place.
fn high_words(place: LatticePoint) -> vec2i {
    return vec2i(place.high.xy);
}

fn filtered_sides(t: u32, q: vec2i) -> vec3i {
    let a = load_high(corner(t, 0));
    let b = load_high(corner(t, 1));
    let c = load_high(corner(t, 2));
    return vec3i(orient2d_filter(q, b, c), orient2d_filter(q, c, a), orient2d_filter(q, a, b));
}

// Returns the first edge of which the query is not certainly inside; CORNERS if there is none.
fn first_not_positive(sides: vec3i) -> u32 {
    let is = sides <= vec3i(0);
    return select(select(select(3u, 2u, is.z), 1u, is.y), 0u, is.x);
}

fn side_of(sides: vec3i, k: u32) -> i32 {
    return select(select(sides.z, sides.y, k == 1), sides.x, k == 0);
}
