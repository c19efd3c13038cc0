// Differences of the corners of a facet and a query, exactly.
//
// Expects: vertices; simplices.
//!include d3/exact_wide

// A query on the lattice.
struct Query {
    high: vec3i,
    vertex: Vertex,
    exact: bool,
}

fn query_at(place: LatticePoint) -> Query {
    let vertex = Vertex((place.high << vec3u(31)) | place.low, place.high >> vec3u(1), 0, 0);
    return Query(vec3i(place.high), vertex, place.exact);
}

// Returns the vertices of the facet opposite vertex k, as in d3/simplex.
fn facet_of(t: u32, k: u32) -> vec3u {
    let s = simplices[t];
    return select(
        select(select(vec3u(s.x, s.z, s.y), vec3u(s.x, s.y, s.w), k == 2), vec3u(s.x, s.w, s.z), k == 1), s.yzw, k == 0
    );
}

// Returns the difference of a vertex and a query.
fn row_to(v: u32, query: Query) -> Row {
    return difference(load_vertex(v), query.vertex);
}

// det(a, b, c).
fn determinant(a: Row, b: Row, c: Row) -> Determinant {
    return plus(minus(expand(a, minor(b, c)), expand(b, minor(a, c))), expand(c, minor(a, b)));
}

// Returns the difference of the high words of a vertex and a query.
fn place_difference(v: u32, query: Query) -> vec3i {
    return load_high(v) - query.high;
}
