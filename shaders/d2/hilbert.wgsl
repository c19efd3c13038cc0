// Returns the place along the Hilbert curve through a 32768² grid of the cell of a lattice point,
// by the high words of its coordinates; d3/hilbert has the source.
fn hilbert_key(high: vec3u) -> u32 {
    var x = high.xy >> vec2u(16);
    for (var q = 16384u; q > 1; q >>= 1) {
        let p = q - 1;
        x.x ^= select(0u, p, (x.x & q) != 0);
        let t = (x.x ^ x.y) & p;
        let invert_y = (x.y & q) != 0;
        x = vec2u(x.x ^ select(t, p, invert_y), x.y ^ select(t, 0u, invert_y));
    }
    x.y ^= x.x;
    // Every bit of y flips all lower bits.
    var t = x.y >> 1;
    t ^= t >> 1;
    t ^= t >> 2;
    t ^= t >> 4;
    t ^= t >> 8;
    x ^= vec2u(t);
    return (spread(x.x) << 1) | spread(x.y);
}

// Puts a zero before each of fifteen bits.
fn spread(bits: u32) -> u32 {
    var b = bits & 0x7fff;
    b = (b | (b << 8)) & 0x00ff00ff;
    b = (b | (b << 4)) & 0x0f0f0f0f;
    b = (b | (b << 2)) & 0x33333333;
    b = (b | (b << 1)) & 0x55555555;
    return b;
}
