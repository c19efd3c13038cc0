// The parameters of gathering tetrahedra of the mesh, and of writing changed ones back.
struct Gathering {
    // The number of the first tetrahedron that is gathered: 1 at the first time.
    first: u32,
    // The entries of the patch.
    patched: u32,
}

// Where the vertices start, in the word of a gathered slot, for which the tetrahedron is the one of the
// vertex.
const NAMED_SHIFT: u32 = 28;

// In a patch: the neighbour stays what it is.
const KEEP: u32 = 0xffffffff;
