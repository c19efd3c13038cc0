// On which side of an edge of a triangle a query is, exactly.
//
// Rounding. As d2/rounding_wide derives it: where all |d| ≤ 2^m, the orientation changes by less
// than 2^(m + 3), and a value of b bits is at least 2^(b − 1).
//
// Expects: vertices; simplices; d2/query_neighbors.
//!include d2/query_rows
//!include d2/query_sizes

// The side that rounding leaves open.
const UNKNOWN: i32 = 2;

// Returns the side of the edge opposite vertex k: 1 inside, −1 outside, 0 on its line, or UNKNOWN.
fn exact_side(t: u32, k: u32, query: Query) -> i32 {
    let f = facet_of(t, k);
    let a = row_to(f.x, query);
    let b = row_to(f.y, query);
    let value = determinant(a, b);
    let sign = sign_of_determinant(value);
    if query.exact && !rounded(f.x) && !rounded(f.y) {
        return sign;
    }
    let bits = bits_of_128(value.limbs ^ vec4u(u32(i32(value.limbs.w) >> 31)));
    return select(UNKNOWN, sign, bits > max(size_of(a), size_of(b)) + 3);
}
