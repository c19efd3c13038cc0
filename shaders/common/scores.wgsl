// Scores in the order in which points are wanted: as unsigned numbers, at least 1.

// The share of the sum of a determinant's terms, taken as positive, below which it may be nothing but
// rounding.
const ROUNDING: f32 = 0x1p-20;

// Returns a score by how far a point is from what bounds a simplex, a determinant whose terms sum up
// to `permanent` if none is negative. A point in the plane of a facet or of a flat tetrahedron, or on
// the line of an edge, is at no distance: it gets a lower score, by the square of its distance from
// the nearest vertex. So such points are taken from the middle of the largest gaps, and not in an
// order in which each is next to the last one.
fn score(distance: f32, permanent: f32, from_nearest: f32) -> u32 {
    let beyond = abs(distance) > ROUNDING * permanent;
    return select(bitcast<u32>(from_nearest) + 1, bitcast<u32>(abs(distance)) | 0x80000000, beyond);
}
