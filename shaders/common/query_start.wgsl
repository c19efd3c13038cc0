// Where walks start.
//
// Expects: common/query; starts: array<vec2u>, sorted pairs of a place along the curve and a
// simplex. There is at least one.

// Returns the simplex with the first place that is not before that of a query, which is near.
fn start_of(query: u32) -> u32 {
    let key = curve_key(query);
    var low = 0u;
    var high = params.starts - 1;
    while low < high {
        let middle = (low + high) / 2;
        if starts[middle].x < key {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return starts[low].y;
}
