// Returns the place along the Hilbert curve through a 1024³ grid of the cell of a lattice point, by
// the high words of its coordinates (Skilling, *Programming the Hilbert curve*, 2004).
fn hilbert_key(high: vec3u) -> u32 {
    var x = high >> vec3u(21);
    for (var q = 512u; q > 1; q >>= 1) {
        let p = q - 1;
        // For each axis: where its bit is set, invert the lower bits of x, else exchange them with
        // those of the axis.
        x.x ^= select(0u, p, (x.x & q) != 0);
        let t = (x.x ^ x.y) & p;
        let invert_y = (x.y & q) != 0;
        x = vec3u(x.x ^ select(t, p, invert_y), x.y ^ select(t, 0u, invert_y), x.z);
        let u = (x.x ^ x.z) & p;
        let invert_z = (x.z & q) != 0;
        x = vec3u(x.x ^ select(u, p, invert_z), x.y, x.z ^ select(u, 0u, invert_z));
    }
    // Gray code.
    x.y ^= x.x;
    x.z ^= x.y;
    // Every bit of z flips all lower bits.
    var t = x.z >> 1;
    t ^= t >> 1;
    t ^= t >> 2;
    t ^= t >> 4;
    t ^= t >> 8;
    x ^= vec3u(t);
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
