// Scores: numbers of at least 1, the higher the more a point is wanted.

// The share of the sum of a determinant's terms, all taken as positive, up to which its value may
// be nothing but rounding.
const ROUNDING: f32 = 0x1p-20;

// Returns whether a determinant is distinct from 0. `permanent` is that sum.
fn is_distinct(value: f32, permanent: f32) -> bool {
    return abs(value) > ROUNDING * permanent;
}

// Returns a score by the size of a determinant. It is above the others.
fn score_by_volume(value: f32) -> u32 {
    return bitcast<u32>(abs(value)) | 0x80000000;
}

// Returns a score by the square of the distance from the nearest vertex. It is below the others:
// where nothing else tells points apart, because they lie on the line of an edge, the gaps between
// the vertices are halved, and points do not follow each other along the line.
fn score_by_distance(square: f32) -> u32 {
    return (bitcast<u32>(square) >> 1) | 1;
}
