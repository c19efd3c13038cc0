// What the checks of the arrays of a mesh have to know.
struct CheckParams {
    // The simplices.
    count: u32,
    // From a simplex that the host looks at to the next one.
    stride: u32,
    points: u32,
    // The facets of the hull, in 3D.
    hull: u32,
}

// What the host gets, before the corners of each sample and those beyond its facets: the sum of the hashes of facets, the
// facets without a tetrahedron across, the vertices on the hull, and the points that have one of their simplices.
const CHECK_SUM: u32 = 0;
const CHECK_OUTSIDE: u32 = 1;
const CHECK_ON_HULL: u32 = 2;
const CHECK_VERTICES: u32 = 3;
const CHECK_WORDS: u32 = 4;
// The most simplices that the host looks at.
const CHECK_SAMPLES: u32 = 256;
