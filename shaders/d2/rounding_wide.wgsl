// Signs of the true coordinates, where some were rounded to the lattice: 0 where that does not
// prove them.
//
// A true difference is d + θ with |θ| ≤ 1, since each coordinate was rounded by at most 1/2. Where
// all |d| ≤ 2^m, a determinant of N monomials of degree n changes by at most N·((2^m + 1)^n −
// 2^mn): the orientation by 2·(2·2^m + 1) < 2^(m + 3), in-circle by 12·4·(2^m + 1)³ < 2^(3m + 9). A
// value of b bits is at least 2^(b − 1).
//
// Expects: vertices; d2/predicates.
//!include arithmetic/bits

// Returns whether a coordinate of this vertex was rounded to the lattice.
fn rounded(v: u32) -> bool {
    return vertices[v].z < 0;
}

// Returns the m of a row: the number of bits of its magnitudes, or of one less where they are
// negative.
fn size_of(r: Row) -> u32 {
    let sign = vec2u(vec2i(r.high) >> vec2u(31));
    let low = r.low ^ sign;
    let high = r.high ^ sign;
    return bits_of(vec2u(low.x | low.y, high.x | high.y));
}

fn orient2d_rounded(a: Position, b: Position, c: Position) -> i32 {
    let u = difference(b, a);
    let v = difference(c, a);
    let value = determinant(u, v);
    let bits = bits_of_128(value.limbs ^ vec4u(u32(i32(value.limbs.w) >> 31)));
    return select(0, sign_of_determinant(value), bits > max(size_of(u), size_of(v)) + 3);
}

fn incircle_rounded(a: Position, b: Position, c: Position, d: Position) -> i32 {
    let value = incircle_volume(difference(a, d), difference(b, d), difference(c, d));
    let size = max(max(size_of(difference(a, d)), size_of(difference(b, d))), size_of(difference(c, d)));
    let sign = vec4u(u32(i32(value.high.w) >> 31));
    let high = value.high ^ sign;
    let bits = select(bits_of_128(value.low ^ sign), 128 + bits_of_128(high), any(high != vec4u(0)));
    return select(0, sign_of_volume(value), bits > 3 * size + 9);
}
