// Orientation and in-circle in f32: the sign where it is certain, else 0.
//
// The arguments are the high words of lattice points, 0 ≤ q < 2^31. The derivation is that of
// arithmetic/filter. The orientation has n = 2 factors and N = 2 monomials: 2n + N − 2 = 4
// roundings. In-circle has n = 4, N = 2·2·3 = 12: 18. The permanents come out at least (1 − u)^30
// times their true value, so 6·u·P and 24·u·P cover all of it.
//!include arithmetic/filter

const ORIENT2D_ROUNDING: f32 = 6 * 0x1p-23;
const INCIRCLE_ROUNDING: f32 = 24 * 0x1p-23;

fn scaled(d: vec2i) -> vec2f {
    return vec2f(d) * SCALE;
}

fn cross_filter(p: vec2f, q: vec2f) -> f32 {
    return p.x * q.y - q.x * p.y;
}

fn cross_permanent(p: vec2f, q: vec2f) -> f32 {
    return p.x * q.y + q.x * p.y;
}

fn orient2d_filter(a: vec2i, b: vec2i, c: vec2i) -> i32 {
    let u = scaled(b - a);
    let v = scaled(c - a);
    let k = widening(vec3f(max(abs(u), abs(v)), 0));
    let permanent = cross_permanent(abs(u) + k, abs(v) + k);
    return certain_sign(cross_filter(u, v), (ORIENT2D_ROUNDING + low_word_error(k)) * permanent);
}

fn incircle_filter(a: vec2i, b: vec2i, c: vec2i, d: vec2i) -> i32 {
    let p = scaled(a - d);
    let q = scaled(b - d);
    let r = scaled(c - d);
    let value = dot(p, p) * cross_filter(q, r) + dot(q, q) * cross_filter(r, p) + dot(r, r) * cross_filter(p, q);
    let k = widening(vec3f(max(max(abs(p), abs(q)), abs(r)), 0));
    let s = abs(p) + k;
    let t = abs(q) + k;
    let u = abs(r) + k;
    let permanent = dot(s, s) * cross_permanent(t, u) + dot(t, t) * cross_permanent(u, s) + dot(u, u) * cross_permanent(s, t);
    return certain_sign(value, (INCIRCLE_ROUNDING + low_word_error(k)) * permanent);
}
