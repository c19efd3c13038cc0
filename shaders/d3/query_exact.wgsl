// On which side of a facet of a tetrahedron a query is, exactly.
//
// Rounding. A true difference is d + θ with |θ| ≤ 1, since each coordinate was rounded by at most
// 1/2. Where all |d| ≤ 2^m, the orientation changes by at most 6·((2^m + 1)³ − 2^3m) ≤ 42·2^2m <
// 2^(2m + 6). A value of b bits is at least 2^(b − 1).
//
// Expects: vertices; simplices.
//!include d3/query_rows
//!include d3/query_sizes

// The side that rounding leaves open.
const UNKNOWN: i32 = 2;

// Returns the side of the facet opposite vertex k: 1 inside, −1 outside, 0 on its plane, or UNKNOWN.
fn exact_side(t: u32, k: u32, query: Query) -> i32 {
    let f = facet_of(t, k);
    let a = row_to(f.x, query);
    let b = row_to(f.y, query);
    let c = row_to(f.z, query);
    let value = determinant(a, b, c);
    let sign = sign_of_determinant(value);
    if query.exact && !rounded(f.x) && !rounded(f.y) && !rounded(f.z) {
        return sign;
    }
    let negative = u32(i32(value.high.y) >> 31);
    let high = value.high ^ vec2u(negative);
    let bits = select(bits_of_128(value.low ^ vec4u(negative)), 128 + bits_of(high), any(high != vec2u(0)));
    let size = max(max(size_of(a), size_of(b)), size_of(c));
    return select(UNKNOWN, sign, bits > 2 * size + 6);
}
