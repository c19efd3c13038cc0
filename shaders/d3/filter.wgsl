// Orientation and in-sphere in f32: the sign where it is certain, else 0.
//
// The arguments are the high words of lattice points, 0 ≤ q < 2^31. See arithmetic/filter for the
// derivation of the bounds.
//!include arithmetic/filter

const ORIENT3D_ROUNDING: f32 = 16 * 0x1p-23;
const INSPHERE_ROUNDING: f32 = 96 * 0x1p-23;

fn scaled(d: vec3i) -> vec3f {
    return vec3f(d) * SCALE;
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

// Returns the orientation of four vertices if `of_four`, otherwise whether e is inside the
// circumsphere of four that are positively oriented; 0 where that is not certain.
fn filtered_sign(v: vec4u, e: u32, of_four: bool) -> i32 {
    let a = load_high(v.x);
    let b = load_high(v.y);
    let c = load_high(v.z);
    let d = load_high(v.w);
    if of_four {
        return orient3d_filter(a, b, c, d);
    }
    return insphere_filter(a, b, c, d, load_high(e));
}

// det(u, v, w), if it is certain: `error` times the permanent of what is larger by k, and
// `underflow`, are what it may be off by.
fn orient3d_certain(u: vec3f, v: vec3f, w: vec3f, k: f32, error: f32, underflow: f32) -> i32 {
    let value = u.z * minor_filter(v, w) - v.z * minor_filter(u, w) + w.z * minor_filter(u, v);
    let p = abs(u) + k;
    let q = abs(v) + k;
    let r = abs(w) + k;
    let permanent = p.z * minor_permanent(q, r) + q.z * minor_permanent(p, r) + r.z * minor_permanent(p, q);
    return certain_sign(value, error * permanent + underflow);
}

// The in-sphere determinant of the differences to the last point, likewise.
fn insphere_certain(p: vec3f, q: vec3f, r: vec3f, s: vec3f, k: f32, error: f32, underflow: f32) -> i32 {
    let pq = minor_filter(p, q);
    let pr = minor_filter(p, r);
    let ps = minor_filter(p, s);
    let qr = minor_filter(q, r);
    let qs = minor_filter(q, s);
    let rs = minor_filter(r, s);
    let value = dot(p, p) * (q.z * rs - r.z * qs + s.z * qr) - dot(q, q) * (p.z * rs - r.z * ps + s.z * pr)
        + dot(r, r) * (p.z * qs - q.z * ps + s.z * pq) - dot(s, s) * (p.z * qr - q.z * pr + r.z * pq);
    let permanent = insphere_permanent(abs(p) + k, abs(q) + k, abs(r) + k, abs(s) + k);
    return certain_sign(value, error * permanent + underflow);
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
