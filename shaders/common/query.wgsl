// Queries: points to locate, which need not be on the lattice of the mesh's points.
//
// The lattice has room around the points. A query that is near has a place on it, which rounding
// may have moved by half a step; the others are left to the host.
//
// Expects: input: array<u32>, the bits of the coordinates; see common/input.
//!include common/input
//!include common/query_params
//!include {dim}/query_curve

// The answer outside of every simplex, if there are none.
const NOWHERE: u32 = 0x80000000;

// Every simplex of this number is a place to start from.
const START_STRIDE: u32 = 64;

// Returns whether a coordinate is neither infinite nor NaN.
fn is_finite(bits: vec2u) -> bool {
    let mask = select(0x7f800000u, 0x7ff00000u, params.doubles != 0);
    return (bits.y & mask) != mask;
}

// Returns integers in the order of the coordinates.
fn ordered(bits: vec2u) -> vec2u {
    return select(bits ^ vec2u(0, 0x80000000), ~bits, (bits.y >> 31) != 0);
}

// Returns whether a ≤ b.
fn is_ordered(a: vec2u, b: vec2u) -> bool {
    return a.y < b.y || (a.y == b.y && a.x <= b.x);
}

// Returns the cell of a coordinate of a query that is near, or the nearest one of the grid.
fn cell_of(bits: vec2u, axis: u32) -> u32 {
    let negative = (bits.y >> 31) != 0;
    let biased = select((bits.y >> 23) & 0xff, (bits.y >> 20) & 0x7ff, params.doubles != 0);
    let normal = u32(biased != 0);
    let mantissa = select(
        vec2u((bits.y & 0x7fffff) | (normal << 23), 0),
        vec2u(bits.x, (bits.y & 0xfffff) | (normal << 20)),
        params.doubles != 0
    );
    let exponent = i32(max(biased, 1)) - select(150, 1075, params.doubles != 0);
    let shift = exponent + params.cell_exponents[axis];
    let left = shift_left(mantissa, u32(clamp(shift, 0, 64)));
    // Magnitudes are rounded down, or up if negative. With 53 bits, 2^63 divides none.
    let r = u32(clamp(-shift, 0, 63));
    let up = subtract_64(shift_left(vec2u(1, 0), r), vec2u(1, 0));
    let right = shift_right(select(mantissa, add_64(mantissa, up), negative), r);
    let magnitude = select(right, left, shift >= 0);
    let floored = select(magnitude, subtract_64(vec2u(0), magnitude), negative);
    let cell = subtract_64(floored, vec2u(params.cell_origin_low[axis], params.cell_origin_high[axis]));
    let last = (1u << cell_bits()) - 1;
    let within = select(min(cell.x, last), last, cell.y != 0);
    return select(within, 0u, (cell.y >> 31) != 0);
}

// Returns the place along the curve of the cell of a query that is near, or of the nearest cell.
fn curve_key(query: u32) -> u32 {
    var cell = vec3u(cell_of(coordinate_bits(query, 0), 0), cell_of(coordinate_bits(query, 1), 1), 0);
    if params.dimension > 2 {
        cell.z = cell_of(coordinate_bits(query, 2), 2);
    }
    return place_of_cell(cell);
}
