// Which queries the device can answer.
//
// Expects: common/query.

// Returns whether a query is near enough to have a place on the lattice. The lowest one that is not
// finite is noted.
fn is_near(query: u32) -> bool {
    var finite = true;
    var near = true;
    for (var axis = 0u; axis < params.dimension; axis++) {
        let bits = coordinate_bits(query, axis);
        finite &= is_finite(bits);
        let place = ordered(bits);
        near &= is_ordered(vec2u(params.nearest_low[axis], params.nearest_high[axis]), place);
        near &= is_ordered(place, vec2u(params.farthest_low[axis], params.farthest_high[axis]));
    }
    if !finite {
        atomicMin(&params.not_finite, query);
    }
    return finite && near;
}
