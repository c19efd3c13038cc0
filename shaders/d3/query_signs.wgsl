// On which sides of the facets of a tetrahedron a query is, as far as the filter decides: 1 inside,
// −1 outside, 0 where that is not certain. The signs are those of the true coordinates.
//
// Expects: vertices; simplices.
//!include d3/exact_wide
//!include d3/filter

// Returns the high words of a place.
fn high_words(place: LatticePoint) -> vec3i {
    return vec3i(place.high);
}

fn filtered_sides(t: u32, q: vec3i) -> vec4i {
    let s = simplices[t];
    let a = load_high(s.x);
    let b = load_high(s.y);
    let c = load_high(s.z);
    let d = load_high(s.w);
    return vec4i(
        orient3d_filter(q, b, c, d), orient3d_filter(q, a, d, c), orient3d_filter(q, a, b, d), orient3d_filter(q, a, c, b)
    );
}

// Returns the first facet of which the query is not certainly inside; CORNERS if there is none.
fn first_not_positive(sides: vec4i) -> u32 {
    let is = sides <= vec4i(0);
    return select(select(select(select(4u, 3u, is.w), 2u, is.z), 1u, is.y), 0u, is.x);
}

fn side_of(sides: vec4i, k: u32) -> i32 {
    return select(select(select(sides.w, sides.z, k == 2), sides.y, k == 1), sides.x, k == 0);
}
