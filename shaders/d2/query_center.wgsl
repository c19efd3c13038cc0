// The circumcentre of a triangle.
//
// With the edges b and c from the first vertex it is
//
//     (|b|²·c.y − |c|²·b.y, |c|²·b.x − |b|²·c.x) / (2·det(b, c))
//
// relative to that vertex. All differences are below 2^60, so the numerators are below 2^183.
//
// Rounding. True differences are d + θ with |θ| ≤ 1. Where all |d| ≤ M = 2^m, the determinant
// changes by at most 2·((M + 1)² − M²) ≤ 6·M, and a numerator, which has four monomials of degree
// three, by at most 4·((M + 1)³ − M³) ≤ 28·M². Some |d| exceeds M/2, and so the radius R is at
// least M/4: 28·M² ≤ 112·M·R. The centre moves by at most (√2/2·112 + 6)·M·R < 2^7·M·R by the true
// determinant. If this has more than m + 32 bits on the lattice, it is at least 2^(m + 31), and the
// centre moves by at most 2^-24·R.
//
// Expects: vertices; simplices.
//!include d2/exact_wide
//!include d2/query_sizes
//!include arithmetic/floats

const LIMBS: u32 = 8;

// A point, as numerators and their common denominator.
struct Center {
    x: Float,
    y: Float,
    z: Float,
    denominator: Float,
    // Whether rounding to the lattice may have moved it, or there is none.
    is_open: bool,
}

// Returns p·l − q·k.
fn float_of_difference(p: vec2u, l: Lift, q: vec2u, k: Lift) -> Float {
    let sum = accumulate(zero_volume(), l, extended(p));
    let v = accumulate(sum, k, extended(subtract_64(vec2u(0), q)));
    return float_of(array(v.low.x, v.low.y, v.low.z, v.low.w, v.high.x, v.high.y, v.high.z, v.high.w));
}

// Returns an integer of two limbs in four.
fn extended(a: vec2u) -> Determinant {
    let sign = u32(i32(a.y) >> 31);
    return Determinant(vec4u(a, sign, sign));
}

fn center_of(t: u32) -> Center {
    let first = corner(t, 0);
    let second = corner(t, 1);
    let third = corner(t, 2);
    let origin = load_position(first);
    let b = difference(load_position(second), origin);
    let c = difference(load_position(third), origin);
    let bb = lift_of(b);
    let cc = lift_of(c);
    let x = float_of_difference(y_of(c), bb, y_of(b), cc);
    let y = float_of_difference(x_of(b), cc, x_of(c), bb);
    let value = determinant(b, c);
    let sign = u32(i32(value.limbs.w) >> 31);
    let bits = bits_of_128(value.limbs ^ vec4u(sign));
    let is_rounded = rounded(first) || rounded(second) || rounded(third);
    let is_open = sign_of_determinant(value) == 0 || (is_rounded && bits <= max(size_of(b), size_of(c)) + 32);
    let twice = plus(value, value).limbs;
    let top = u32(i32(twice.w) >> 31);
    let denominator = float_of(array(twice.x, twice.y, twice.z, twice.w, top, top, top, top));
    return Center(x, y, Float(0, ZERO_EXPONENT), denominator, is_open);
}
