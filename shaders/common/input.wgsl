// Input points on the device: their coordinates' bits, and their place on the lattice.
//
// Expects: params: InputParams; input: array<u32>, whose elements are the coordinates' bits: x, y,
// z or x, y; one word each for f32, low and high word each for f64.
//!include primitives/workgroup
//!include arithmetic/limbs

struct InputParams {
    // The number of points.
    count: u32,
    // The lattice's k: coordinates are multiplied by 2^k.
    exponent: i32,
    // 1 for f64 input, 0 for f32.
    doubles: u32,
    // Bit a is set where the points do not all agree on axis a.
    varies: u32,
    // What is subtracted, modulo 2^64.
    origin_low: vec3u,
    // The size of the hash table, a power of two, less one.
    table_mask: u32,
    origin_high: vec3u,
    // The bits of a lattice coordinate: 31 or 62.
    width: u32,
    // The coordinates of a point: 3, or 2, where z counts as 0.
    dimension: u32,
    unused: array<u32, 3>,
}

// Returns the bits of a coordinate, low and high word; of an f32, the high word. −0 counts as 0.
fn coordinate_bits(point: u32, axis: u32) -> vec2u {
    var bits = vec2u();
    let at = params.dimension * point + axis;
    if axis < params.dimension {
        if params.doubles != 0 {
            bits = vec2u(input[2 * at], input[2 * at + 1]);
        } else {
            bits.y = input[at];
        }
    }
    bits.y = select(bits.y, 0, bits.x == 0 && bits.y == 0x80000000);
    return bits;
}

struct LatticePoint {
    high: vec3u,
    low: vec3u,
    exact: bool,
}

struct LatticeCoordinate {
    // 64 bits.
    value: vec2u,
    exact: bool,
}

// Returns v·2^by, modulo 2^64.
fn shift_left(v: vec2u, by: u32) -> vec2u {
    let bits = by & 31;
    let carried = select(v.x >> (32 - max(bits, 1)), 0, bits == 0);
    let near = vec2u(v.x << bits, (v.y << bits) | carried);
    return select(select(near, vec2u(0, near.x), by >= 32), vec2u(0), by >= 64);
}

// Returns v / 2^by, rounded down.
fn shift_right(v: vec2u, by: u32) -> vec2u {
    let bits = by & 31;
    let carried = select(v.y << (32 - max(bits, 1)), 0, bits == 0);
    let near = vec2u((v.x >> bits) | carried, v.y >> bits);
    return select(select(near, vec2u(near.y, 0), by >= 32), vec2u(0), by >= 64);
}

// Returns round(x·2^k) − origin, halves up, and whether it is exact. All modulo 2^64, which leaves
// the result as it is, because it has at most 62 bits.
fn lattice_coordinate(bits: vec2u, axis: u32) -> LatticeCoordinate {
    let negative = (bits.y >> 31) != 0;
    let biased = select((bits.y >> 23) & 0xff, (bits.y >> 20) & 0x7ff, params.doubles != 0);
    let normal = u32(biased != 0);
    // |x| = mantissa·2^(exponent).
    let mantissa = select(
        vec2u((bits.y & 0x7fffff) | (normal << 23), 0),
        vec2u(bits.x, (bits.y & 0xfffff) | (normal << 20)),
        params.doubles != 0
    );
    let exponent = i32(max(biased, 1)) - select(150, 1075, params.doubles != 0);
    let shift = exponent + params.exponent;
    let left = shift_left(mantissa, u32(clamp(shift, 0, 64)));
    // Rounding to the right by r: magnitudes become (m + 2^(r − 1)) / 2^r, less 1 in the numerator
    // if negative, rounded down. Beyond 54 bits nothing of the 53 is left.
    let r = u32(clamp(-shift, 1, 55));
    let half = shift_left(vec2u(1, 0), r - 1);
    let rounded = shift_right(subtract_64(add_64(mantissa, half), vec2u(u32(negative), 0)), r);
    let zero = all(mantissa == vec2u(0));
    let right = select(rounded, vec2u(0), zero);
    let magnitude = select(right, left, shift >= 0);
    let scaled = select(magnitude, subtract_64(vec2u(0), magnitude), negative);
    let value = subtract_64(scaled, vec2u(params.origin_low[axis], params.origin_high[axis]));
    let back = shift_left(right, r);
    let exact = shift >= 0 || all(back == mantissa);
    // Where all points agree there is no origin.
    let constant = ((params.varies >> axis) & 1) == 0;
    return LatticeCoordinate(select(value, vec2u(0), constant), exact || constant);
}

// Returns a point's lattice coordinates in words of 31 bits; in the narrow form, there is only the
// high one.
fn lattice_point(point: u32) -> LatticePoint {
    let x = lattice_coordinate(coordinate_bits(point, 0), 0);
    let y = lattice_coordinate(coordinate_bits(point, 1), 1);
    let z = lattice_coordinate(coordinate_bits(point, 2), 2);
    let low = vec3u(x.value.x, y.value.x, z.value.x);
    let upper = vec3u(x.value.y, y.value.y, z.value.y);
    let exact = x.exact && y.exact && z.exact;
    let wide = params.width > 31;
    return LatticePoint(
        select(low, (upper << vec3u(1)) | (low >> vec3u(31)), wide), select(vec3u(0), low & vec3u(0x7fffffff), wide), exact
    );
}
