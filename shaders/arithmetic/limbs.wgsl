// Integers of several 32-bit limbs, least significant first, in two's complement.
//
// Sums and products are taken modulo 2^(32 n); a result is right when its true value has a
// magnitude below 2^(32 n - 1), whatever the intermediate results were.
//!include arithmetic/multiply

// a where the sign bit of s is set, else 0.
fn if_negative(s: u32, a: u32) -> u32 {
    return a & u32(i32(s) >> 31);
}

// a + b + carry, and the carry out in the second component.
fn add_limb(a: u32, b: u32, carry: u32) -> vec2u {
    let s = a + b;
    let t = s + carry;
    return vec2u(t, u32(s < a) + u32(t < s));
}

// a − b − borrow, and the borrow out in the second component.
fn subtract_limb(a: u32, b: u32, borrow: u32) -> vec2u {
    let s = a - b;
    return vec2u(s - borrow, u32(a < b) + u32(s < borrow));
}

fn add_64(a: vec2u, b: vec2u) -> vec2u {
    let low = add_limb(a.x, b.x, 0);
    return vec2u(low.x, a.y + b.y + low.y);
}

fn subtract_64(a: vec2u, b: vec2u) -> vec2u {
    let low = subtract_limb(a.x, b.x, 0);
    return vec2u(low.x, a.y - b.y - low.y);
}

fn multiply_i32(a: i32, b: i32) -> vec2u {
    let p = multiply_add(u32(a), u32(b), 0, 0);
    return vec2u(p.x, p.y - if_negative(u32(a), u32(b)) - if_negative(u32(b), u32(a)));
}

// −1, 0 or 1, from the highest limb and the union of the bits of the others.
fn sign_of(high: u32, rest: u32) -> i32 {
    return select(i32((high | rest) != 0), -1, i32(high) < 0);
}
