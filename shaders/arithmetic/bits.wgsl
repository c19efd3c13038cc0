// Sizes of integers of several limbs; see arithmetic/limbs.

// Returns the number of bits of a 64-bit magnitude, low limb first.
fn bits_of(a: vec2u) -> u32 {
    return select(32 - countLeadingZeros(a.x), 64 - countLeadingZeros(a.y), a.y != 0);
}

fn bits_of_128(a: vec4u) -> u32 {
    return select(bits_of(a.xy), 64 + bits_of(a.zw), any(a.zw != vec2u(0)));
}
