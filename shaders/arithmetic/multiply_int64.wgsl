// Products of 32-bit limbs on devices with 64-bit integers, which are not part of WebGPU.

// a·b + c + d, which never exceeds 64 bits.
fn multiply_add(a: u32, b: u32, c: u32, d: u32) -> vec2u {
    let sum = u64(a) * u64(b) + u64(c) + u64(d);
    return vec2u(u32(sum & 0xfffffffflu), u32(sum >> 32u));
}
