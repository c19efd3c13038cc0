// Which of two vertices is nearer to a query.
//
// Filter. As in arithmetic/filter: differences of high words are converted with one rounding, a
// square has another, a sum of three two more, and the difference of two sums one: below 8·u of the
// sum of both. Low words and rounding change a difference d by at most t = 1 + 2^-30 units of the
// high word, 2^-8 when scaled, and so its square by at most 2·|d|·t + t².
//
// Rounding. As in {dim}/query_exact: where all |d| ≤ 2^m, the difference of two sums of three
// squares changes by at most 6·(2·2^m + 1) ≤ 18·2^m < 2^(m + 5).
//
// Expects: {dim}/query_exact.

const DISTANCE_ROUNDING: f32 = 12 * 0x1p-23;
// t, with what rounding takes off the bound.
const LOW_WORD: f32 = 0x1.1p-8;

// Returns −1 if a is nearer, 1 if b is, 0 if neither is, or UNKNOWN.
fn compare_distances(a: u32, b: u32, query: Query) -> i32 {
    let p = abs(vec3f(place_difference(a, query)) * 0x1p-8);
    let q = abs(vec3f(place_difference(b, query)) * 0x1p-8);
    let to_a = dot(p, p);
    let to_b = dot(q, q);
    let low_words = LOW_WORD * (2 * (p.x + p.y + p.z + q.x + q.y + q.z) + 6 * LOW_WORD);
    let error = DISTANCE_ROUNDING * (to_a + to_b) + low_words;
    if to_a - to_b > error {
        return 1;
    }
    if to_b - to_a > error {
        return -1;
    }
    let u = row_to(a, query);
    let v = row_to(b, query);
    let value = subtract_128(lift_of(u).limbs, lift_of(v).limbs);
    let sign = sign_of(value.w, value.x | value.y | value.z);
    if query.exact && !rounded(a) && !rounded(b) {
        return sign;
    }
    let bits = bits_of_128(value ^ vec4u(u32(i32(value.w) >> 31)));
    return select(UNKNOWN, sign, bits > max(size_of(u), size_of(v)) + 5);
}
