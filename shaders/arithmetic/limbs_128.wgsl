// Integers of four and five 32-bit limbs; see arithmetic/limbs.
//!include arithmetic/limbs

fn add_128(a: vec4u, b: vec4u) -> vec4u {
    let x = add_limb(a.x, b.x, 0);
    let y = add_limb(a.y, b.y, x.y);
    let z = add_limb(a.z, b.z, y.y);
    return vec4u(x.x, y.x, z.x, a.w + b.w + z.y);
}

struct Sum {
    limbs: vec4u,
    carry: u32,
}

// a + b, unsigned, and the carry out.
fn add_carrying(a: vec4u, b: vec4u) -> Sum {
    let x = add_limb(a.x, b.x, 0);
    let y = add_limb(a.y, b.y, x.y);
    let z = add_limb(a.z, b.z, y.y);
    let w = add_limb(a.w, b.w, z.y);
    return Sum(vec4u(x.x, y.x, z.x, w.x), w.y);
}

fn subtract_128(a: vec4u, b: vec4u) -> vec4u {
    let x = subtract_limb(a.x, b.x, 0);
    let y = subtract_limb(a.y, b.y, x.y);
    let z = subtract_limb(a.z, b.z, y.y);
    return vec4u(x.x, y.x, z.x, a.w - b.w - z.y);
}

// m where the sign bit of s is set, else 0.
fn if_negative_128(s: u32, m: vec4u) -> vec4u {
    return vec4u(if_negative(s, m.x), if_negative(s, m.y), if_negative(s, m.z), if_negative(s, m.w));
}

fn multiply_i64(a: vec2u, b: vec2u) -> vec4u {
    let p0 = multiply_add(a.x, b.x, 0, 0);
    let p1 = multiply_add(a.y, b.x, p0.y, 0);
    let q0 = multiply_add(a.x, b.y, p1.x, 0);
    let q1 = multiply_add(a.y, b.y, p1.y, q0.y);
    let upper = subtract_64(q1, vec2u(if_negative(a.y, b.x), if_negative(a.y, b.y)));
    return vec4u(p0.x, q0.x, subtract_64(upper, vec2u(if_negative(b.y, a.x), if_negative(b.y, a.y))));
}

struct Product {
    low: vec4u,
    high: u32,
}

// a·m + c, unsigned.
fn multiply_row(a: u32, m: vec4u, c: vec4u) -> Product {
    let x = multiply_add(a, m.x, c.x, 0);
    let y = multiply_add(a, m.y, c.y, x.y);
    let z = multiply_add(a, m.z, c.z, y.y);
    let w = multiply_add(a, m.w, c.w, z.y);
    return Product(vec4u(x.x, y.x, z.x, w.x), w.y);
}

// a·m plus the part of the product before that lies one limb higher.
fn next_row(before: Product, a: u32, m: vec4u) -> Product {
    return multiply_row(a, m, vec4u(before.low.yzw, before.high));
}
