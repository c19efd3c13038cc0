// Differences of the ends of an edge and a query, exactly.
//
// Expects: vertices; simplices.
//!include d2/exact_wide

// A query on the lattice.
struct Query {
    high: vec2i,
    position: Position,
    exact: bool,
}

fn query_at(place: LatticePoint) -> Query {
    let high = place.high.xy;
    return Query(vec2i(high), Position((high << vec2u(31)) | place.low.xy, high >> vec2u(1)), place.exact);
}

// Returns the vertices of the edge opposite vertex k.
fn facet_of(t: u32, k: u32) -> vec2u {
    let next = select(k + 1, 0u, k == 2);
    return vec2u(corner(t, next), corner(t, 3 - k - next));
}

// Returns the difference of a vertex and a query.
fn row_to(v: u32, query: Query) -> Row {
    return difference(load_position(v), query.position);
}

// Returns the difference of the high words of a vertex and a query.
fn place_difference(v: u32, query: Query) -> vec3i {
    return vec3i(load_high(v) - query.high, 0);
}
