// Orientation and in-sphere in f32: the sign where it is certain, else 0.
//
// The arguments are the high words of lattice points, 0 ≤ q < 2^31.
//
// Range. Differences are exact integers, |d| < 2^31. They are converted to f32 and multiplied by 2^-8, so that they are
// multiples of 2^-8 below 2^23 (or 2^23). Whatever the compiler makes of a polynomial of degree n in them with the laws
// of a ring, every intermediate result is a multiple of 2^-8n: a product or sum of multiples is one, and rounding to a
// float keeps multiples of a power of two. So no intermediate result but 0 is below 2^-40: nothing underflows, flushed
// or not. And none exceeds 72·2^115 by more than its roundings, so nothing overflows.
//
// Rounding. WGSL lets an operation round either way: relative error at most u = 2^-23, also in the conversion from i32.
// Reordering, distributing and fusing change in which order the monomials of the polynomial are multiplied out and
// added up, and where there is no rounding. They add no monomials. So the computed value is the sum of the monomials,
// each with at most n conversions, n − 1 products and N − 1 sums of rounding, where N is the number of monomials: off by
// at most ((1 + u)^(2n + N − 2) − 1)·P, where P is the sum of the monomials' absolute values. The orientation has n = 3,
// N = 6: 10 roundings. In-sphere has n = 5, N = 4·6·3 = 72: 80. P is computed likewise, from absolute values, and comes
// out at least (1 − u)^90 times its true value. So 16·u·P and 96·u·P cover all of it.
//
// Low words. Where coordinates have low words, or were rounded to the lattice, the true differences are d + θ with
// |θ| ≤ t = 1 + 2^-30 in units of the high word. With P(a) as a function of the absolute differences a (a polynomial with
// no negative coefficients, and P' the sum of its derivatives), the determinants of d + θ and d differ by at most
// P(a + t) − P(a) ≤ t·P'(a + t), and P(a + t + k) ≥ k·P'(a + t) for every k > 0. So t/k·P(a + t + k) bounds the
// difference. K = t + k is chosen as 1/16 of the largest difference: large enough to make t/k small, small enough to
// leave P about as it is; at least 4 units, so that t/k ≤ 1.5/K, and at most 2^17, where 1.5/K is below the rounding.
// P is then taken of a + K, for the rounding too. A sign that comes out is that of the true coordinates.
//!include shared/filter_{width}

const SCALE: f32 = 0x1p-8;
const ORIENT3D_ROUNDING: f32 = 16 * 0x1p-23;
const INSPHERE_ROUNDING: f32 = 96 * 0x1p-23;

fn scaled(d: vec3i) -> vec3f {
    return vec3f(d) * SCALE;
}

fn certain_sign(value: f32, error: f32) -> i32 {
    return i32(value > error) - i32(value < -error);
}

fn minor_filter(p: vec3f, q: vec3f) -> f32 {
    return p.x * q.y - q.x * p.y;
}

fn minor_permanent(p: vec3f, q: vec3f) -> f32 {
    return p.x * q.y + q.x * p.y;
}

fn orient3d_filter(a: vec3i, b: vec3i, c: vec3i, d: vec3i) -> i32 {
    let u = scaled(b - a);
    let v = scaled(c - a);
    let w = scaled(d - a);
    let k = widening(max(max(abs(u), abs(v)), abs(w)));
    return orient3d_certain(u, v, w, k, ORIENT3D_ROUNDING + low_word_error(k), 0);
}

fn insphere_filter(a: vec3i, b: vec3i, c: vec3i, d: vec3i, e: vec3i) -> i32 {
    let p = scaled(a - e);
    let q = scaled(b - e);
    let r = scaled(c - e);
    let s = scaled(d - e);
    let k = widening(max(max(abs(p), abs(q)), max(abs(r), abs(s))));
    return insphere_certain(p, q, r, s, k, INSPHERE_ROUNDING + low_word_error(k), 0);
}

// det(u, v, w), if it is certain: `error` times the permanent of what is larger by k, and `least`, are what it may be off by.
fn orient3d_certain(u: vec3f, v: vec3f, w: vec3f, k: f32, error: f32, least: f32) -> i32 {
    let value = u.z * minor_filter(v, w) - v.z * minor_filter(u, w) + w.z * minor_filter(u, v);
    let p = abs(u) + k;
    let q = abs(v) + k;
    let r = abs(w) + k;
    let permanent = p.z * minor_permanent(q, r) + q.z * minor_permanent(p, r) + r.z * minor_permanent(p, q);
    return certain_sign(value, error * permanent + least);
}

// The in-sphere determinant of the differences to the last point, likewise.
fn insphere_certain(p: vec3f, q: vec3f, r: vec3f, s: vec3f, k: f32, error: f32, least: f32) -> i32 {
    let pq = minor_filter(p, q);
    let pr = minor_filter(p, r);
    let ps = minor_filter(p, s);
    let qr = minor_filter(q, r);
    let qs = minor_filter(q, s);
    let rs = minor_filter(r, s);
    let value = dot(p, p) * (q.z * rs - r.z * qs + s.z * qr) - dot(q, q) * (p.z * rs - r.z * ps + s.z * pr)
        + dot(r, r) * (p.z * qs - q.z * ps + s.z * pq) - dot(s, s) * (p.z * qr - q.z * pr + r.z * pq);
    let permanent = insphere_permanent(abs(p) + k, abs(q) + k, abs(r) + k, abs(s) + k);
    return certain_sign(value, error * permanent + least);
}

fn insphere_permanent(p: vec3f, q: vec3f, r: vec3f, s: vec3f) -> f32 {
    let pq = minor_permanent(p, q);
    let pr = minor_permanent(p, r);
    let ps = minor_permanent(p, s);
    let qr = minor_permanent(q, r);
    let qs = minor_permanent(q, s);
    let rs = minor_permanent(r, s);
    return dot(p, p) * (q.z * rs + r.z * qs + s.z * qr) + dot(q, q) * (p.z * rs + r.z * ps + s.z * pr)
        + dot(r, r) * (p.z * qs + q.z * ps + s.z * pq) + dot(s, s) * (p.z * qr + q.z * pr + r.z * pq);
}
