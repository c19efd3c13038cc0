// The filter of d3/filter once more, on differences with their low words: for points that are near
// to each other, where the high words alone decide little.
//
// Differences are multiples of 2^-31 in units of the high word, so, scaled as there, multiples of
// 2^-39 below 2^23 (or 2^23).
//
// Rounding. A difference takes two conversions, of its limbs' absolute values, and their sum: at
// most two roundings, where arithmetic/filter counts one. So orientation has 13 roundings,
// in-sphere 85, and the bounds there cover them.
//
// Range. Intermediate results of degree three or less are multiples of 2^-117 and do not underflow.
// Those of degree four and five may, and then lose at most 2^-126, times a factor below 2^26 at
// most, in each of some hundred operations: less than UNDERFLOW in all.
//
// Expects: d3/exact_wide; d3/filter.

const UNDERFLOW: f32 = 0x1p-80;

fn scaled_row(r: Row) -> vec3f {
    let negative = (r.high >> vec3u(31)) != vec3u(0);
    let low = select(r.low, vec3u(0) - r.low, negative);
    let high = select(r.high, vec3u(0) - r.high - vec3u(r.low != vec3u(0)), negative);
    let magnitude = vec3f(high) * 0x1p-7 + vec3f(low) * 0x1p-39;
    return select(magnitude, -magnitude, negative);
}

fn orient3d_refined(a: Vertex, b: Vertex, c: Vertex, d: Vertex) -> i32 {
    let u = scaled_row(difference(b, a));
    let v = scaled_row(difference(c, a));
    let w = scaled_row(difference(d, a));
    return orient3d_certain(u, v, w, 0, ORIENT3D_ROUNDING, UNDERFLOW);
}

fn insphere_refined(a: Vertex, b: Vertex, c: Vertex, d: Vertex, e: Vertex) -> i32 {
    let p = scaled_row(difference(a, e));
    let q = scaled_row(difference(b, e));
    let r = scaled_row(difference(c, e));
    let s = scaled_row(difference(d, e));
    return insphere_certain(p, q, r, s, 0, INSPHERE_ROUNDING, UNDERFLOW);
}
