// The circumcentre of a tetrahedron.
//
// With the edges b, c and d from the first vertex it is
//
//     (|b|²·(c × d) + |c|²·(d × b) + |d|²·(b × c)) / (2·det(b, c, d))
//
// relative to that vertex. All differences are below 2^60, so the numerators are below 2^245.
//
// Rounding. True differences are d + θ with |θ| ≤ 1. Where all |d| ≤ M = 2^m, the determinant
// changes by at most 6·((M + 1)³ − M³) ≤ 42·M², and a numerator, which has 18 monomials of degree
// four, by at most 18·((M + 1)^4 − M^4) ≤ 270·M³. Some |d| exceeds M/2, and so the radius R is at
// least M/4: 270·M³ ≤ 1080·M²·R. The centre moves by at most (√3/2·1080 + 42)·M²·R < 2^10·M²·R by
// the true determinant. If this has more than 2m + 35 bits on the lattice, it is at least 2^(2m +
// 34), and the centre moves by less than 2^-24·R.
//
// Expects: vertices; simplices.
//!include d3/exact_wide
//!include d3/query_sizes
//!include arithmetic/floats

const LIMBS: u32 = 10;

// A point, as numerators and their common denominator.
struct Center {
    x: Float,
    y: Float,
    z: Float,
    denominator: Float,
    // Whether rounding to the lattice may have moved it, or there is none.
    is_open: bool,
}

// Returns a row with the next axis first.
fn turned(r: Row) -> Row {
    return Row(r.low.yzx, r.high.yzx);
}

// Returns an integer of four limbs in six.
fn extended(m: vec4u) -> Determinant {
    return Determinant(m, vec2u(u32(i32(m.w) >> 31)));
}

fn float_of_volume(v: Volume) -> Float {
    return float_of(
        array(v.low.x, v.low.y, v.low.z, v.low.w, v.middle.x, v.middle.y, v.middle.z, v.middle.w, v.high.x, v.high.y)
    );
}

fn center_of(t: u32) -> Center {
    let s = simplices[t];
    let origin = load_vertex(s.x);
    var b = difference(load_vertex(s.y), origin);
    var c = difference(load_vertex(s.z), origin);
    var d = difference(load_vertex(s.w), origin);
    let bb = lift_of(b);
    let cc = lift_of(c);
    let dd = lift_of(d);
    var numerator: array<Float, 3>;
    for (var axis = 0u; axis < 3; axis++) {
        // The third turn is the last.
        b = turned(b);
        c = turned(c);
        d = turned(d);
        let sum = accumulate(accumulate(zero_volume(), bb, extended(minor(c, d))), cc, extended(minor(d, b)));
        numerator[axis] = float_of_volume(accumulate(sum, dd, extended(minor(b, c))));
    }
    let value = plus(plus(expand(b, minor(c, d)), expand(c, minor(d, b))), expand(d, minor(b, c)));
    let sign = u32(i32(value.high.y) >> 31);
    let high = value.high ^ vec2u(sign);
    let bits = select(bits_of_128(value.low ^ vec4u(sign)), 128 + bits_of(high), any(high != vec2u(0)));
    let size = max(max(size_of(b), size_of(c)), size_of(d));
    let is_rounded = rounded(s.x) || rounded(s.y) || rounded(s.z) || rounded(s.w);
    let is_open = sign_of_determinant(value) == 0 || (is_rounded && bits <= 2 * size + 35);
    let twice = plus(value, value);
    let low = twice.low;
    let top = u32(i32(twice.high.y) >> 31);
    let denominator = float_of(array(low.x, low.y, low.z, low.w, twice.high.x, twice.high.y, top, top, top, top));
    return Center(numerator[0], numerator[1], numerator[2], denominator, is_open);
}
