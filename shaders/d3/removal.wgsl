// The removal of facets that lie between the same two vertices, d and e (multi-face removal; de Cougny and
// Shephard 1995; Shewchuk 2002): each is the facet of a tetrahedron at d and of one at e. A ring of tetrahedra
// around the edge from d to e takes their place.

// The most facets that are removed together.
const MOST_FACETS: u32 = 4;

// Removals are stored in the buffer of the history, and have the size of its nodes.
struct Removal {
    // For each facet, the tetrahedron at d and that at e.
    tets: array<u32, 2 * MOST_FACETS>,
    // The edges around the facets in their order, 4 bits each: 4·facet + which of its edges.
    ring: u32,
    // How many facets there are.
    facets: u32,
    d: u32,
    e: u32,
}

// Returns the corners of a facet's tetrahedron at d: both ends of an edge of the facet, then the corner opposite.
fn corners_of(tet: vec4u, d: u32, edge: u32) -> vec3u {
    return turned(facet(place_of(tet, d)), edge & 3);
}
