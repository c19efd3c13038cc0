// Returns the place along the Hilbert curve through a 1024³ grid of the cell of a lattice point, by
// the high words of its coordinates.
//!include common/hilbert
fn hilbert_key(high: vec3u) -> u32 {
    var x = high >> vec3u(21);
    for (var q = 512u; q > 1; q >>= 1) {
        x.x ^= select(0u, q - 1, (x.x & q) != 0);
        x = vec3u(turned(x.xy, q), x.z);
        let xz = turned(x.xz, q);
        x = vec3u(xz.x, x.y, xz.y);
    }
    // Gray code.
    x.y ^= x.x;
    x.z ^= x.y;
    // Every bit of z flips all lower bits.
    x ^= vec3u(parity_above(x.z));
    return (spread(x.x) << 2) | (spread(x.y) << 1) | spread(x.z);
}

// Puts two zeros before each of ten bits.
fn spread(bits: u32) -> u32 {
    var b = bits & 0x3ff;
    b = (b | (b << 16)) & 0x030000ff;
    b = (b | (b << 8)) & 0x0300f00f;
    b = (b | (b << 4)) & 0x030c30c3;
    b = (b | (b << 2)) & 0x09249249;
    return b;
}
