// Signs of determinants of differences in f32: the sign where it is certain, else 0. d2/filter and
// d3/filter have the determinants.
//
// The arguments are the high words of lattice points, 0 ≤ q < 2^31.
//
// Range. Differences are exact integers, |d| < 2^31. They are converted to f32 and multiplied by
// 2^-8, so that they are multiples of 2^-8 below 2^23 (or 2^23). Whatever the compiler makes of a
// polynomial of degree n in them with the laws of a ring, every intermediate result is a multiple
// of 2^-8n: a product or sum of multiples is one, and rounding to a float keeps multiples of a
// power of two. So no intermediate result but 0 is below 2^-40: nothing underflows, flushed or not.
// And none exceeds 72·2^115 by more than its roundings, so nothing overflows.
//
// Rounding. WGSL lets an operation round either way: relative error at most u = 2^-23, also in the
// conversion from i32. Reordering, distributing and fusing change in which order the monomials of
// the polynomial are multiplied out and added up, and where there is no rounding. They add no
// monomials. So the computed value is the sum of the monomials, each with at most n conversions, n
// − 1 products and N − 1 sums of rounding, where N is the number of monomials: off by at most ((1 +
// u)^(2n + N − 2) − 1)·P, where P is the sum of the monomials' absolute values. The orientation has
// n = 3, N = 6: 10 roundings. In-sphere has n = 5, N = 4·6·3 = 72: 80. P is computed likewise, from
// absolute values, and comes out at least (1 − u)^90 times its true value. So 16·u·P and 96·u·P
// cover all of it.
//
// Low words. Where coordinates have low words, or were rounded to the lattice, the true differences
// are d + θ with |θ| ≤ t = 1 + 2^-30 in units of the high word. With P(a) as a function of the
// absolute differences a (a polynomial with no negative coefficients, and P' the sum of its
// derivatives), the determinants of d + θ and d differ by at most P(a + t) − P(a) ≤ t·P'(a + t),
// and P(a + t + k) ≥ k·P'(a + t) for every k > 0. So t/k·P(a + t + k) bounds the difference. K = t
// + k is chosen as 1/16 of the largest difference: large enough to make t/k small, small enough to
// leave P about as it is; at least 4 units, so that t/k ≤ 1.5/K, and at most 2^17, where 1.5/K is
// below the rounding. P is then taken of a + K, for the rounding too. A sign that comes out is that
// of the true coordinates.
//!include arithmetic/filter_{width}

const SCALE: f32 = 0x1p-8;

fn certain_sign(value: f32, error: f32) -> i32 {
    return i32(value > error) - i32(value < -error);
}
