// Products of 32-bit limbs, from 16-bit halves: WGSL has no high half of a product. Where the device has
// 64-bit integers, arithmetic/multiply_int64 takes the place of this file.

// a·b + c + d, which never exceeds 64 bits.
fn multiply_add(a: u32, b: u32, c: u32, d: u32) -> vec2u {
    let a0 = a & 0xffff;
    let a1 = a >> 16;
    let b0 = b & 0xffff;
    let b1 = b >> 16;
    let m0 = a0 * b1 + ((a0 * b0) >> 16);
    let m1 = a1 * b0 + (m0 & 0xffff);
    let low = a * b;
    let high = a1 * b1 + (m0 >> 16) + (m1 >> 16);
    let low_c = low + c;
    let low_cd = low_c + d;
    return vec2u(low_cd, high + u32(low_c < low) + u32(low_cd < d));
}
