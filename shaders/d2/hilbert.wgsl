// Returns the place along the Hilbert curve through a 32768² grid of the cell of a lattice point,
// by the high words of its coordinates.
//!include common/hilbert
fn hilbert_key(high: vec3u) -> u32 {
    var x = high.xy >> vec2u(16);
    for (var q = 16384u; q > 1; q >>= 1) {
        x.x ^= select(0u, q - 1, (x.x & q) != 0);
        x = turned(x, q);
    }
    // Gray code.
    x.y ^= x.x;
    // Every bit of y flips all lower bits.
    x ^= vec2u(parity_above(x.y));
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
