// Places along the Hilbert curves of space and plane.

// The key of a cell of a 1024³ grid: its place along the curve (Skilling, *Programming the Hilbert curve*, 2004).
fn hilbert_key(cell: vec3u) -> u32 {
    var x = cell;
    for (var q = 512u; q > 1; q >>= 1) {
        let p = q - 1;
        // For each axis: where its bit is set, invert the lower bits of x, else exchange them with those of the axis.
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

// Ten bits, with two zeros put before each.
fn spread(bits: u32) -> u32 {
    var b = bits & 0x3ff;
    b = (b | (b << 16)) & 0x030000ff;
    b = (b | (b << 8)) & 0x0300f00f;
    b = (b | (b << 4)) & 0x030c30c3;
    b = (b | (b << 2)) & 0x09249249;
    return b;
}

// The same for a cell of a 32768² grid.
fn plane_hilbert_key(cell: vec2u) -> u32 {
    var x = cell;
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
    return (plane_spread(x.x) << 1) | plane_spread(x.y);
}

// Fifteen bits, with a zero put before each.
fn plane_spread(bits: u32) -> u32 {
    var b = bits & 0x7fff;
    b = (b | (b << 8)) & 0x00ff00ff;
    b = (b | (b << 4)) & 0x0f0f0f0f;
    b = (b | (b << 2)) & 0x33333333;
    b = (b | (b << 1)) & 0x55555555;
    return b;
}
