// Tetrahedra: what the buffers hold of them, and the functions that d2/simplex has for triangles.
//!include common/layout
//!include common/slots

// Slots 8v to 8v + 7 belong to vertex v.
const SLOTS_PER_POINT: u32 = BLOCK;

const EDGE_SHIFT: u32 = 12;
const FLIP_23: u32 = 1;
const FLIP_32: u32 = 2;
// In what a flip that was carried out leaves: bit 0 of a 2-3 flip, and the slot that a 3-2 flip gives back,
// which has 30 bits.
const DONE_23: u32 = 1;
const SLOT_SHIFT: u32 = 1;

// Its parts take 16 bytes each, so that they are written and read as a whole.
struct FlipNode {
    ring: vec3u,
    d: u32,
    tets: vec3u,
    e: u32,
    next: vec3u,
    kind: u32,
}

// A flip in the history.
alias HistoryNode = FlipNode;

// A tetrahedron by its vertices.
alias Simplex = vec4u;
const CORNERS: u32 = 4;

// Returns the words of a slot for a tetrahedron.
fn packed(tet: Simplex) -> vec4u {
    return tet;
}

// Returns the tetrahedron of the words of a slot.
fn unpacked(words: vec4u) -> Simplex {
    return words;
}

// Returns the corners of the facet opposite vertex k, counter-clockwise as seen from outside.
fn facet(k: u32) -> vec3u {
    return select(select(select(vec3u(0, 2, 1), vec3u(0, 1, 3), k == 2), vec3u(0, 3, 2), k == 1), vec3u(1, 2, 3), k == 0);
}

// Returns a facet's corners from corner `turn` on.
fn turned(f: vec3u, turn: u32) -> vec3u {
    return select(select(f, f.yzx, turn == 1), f.zxy, turn == 2);
}

// Returns the place of a vertex in a tetrahedron that has it.
fn place_of(tet: vec4u, v: u32) -> u32 {
    return select(select(select(3u, 2u, tet.z == v), 1u, tet.y == v), 0u, tet.x == v);
}

// Returns the tetrahedron with vertex k replaced.
fn replaced(tet: vec4u, k: u32, v: u32) -> vec4u {
    return select(tet, vec4u(v), vec4u(0, 1, 2, 3) == vec4u(k));
}

// Returns the slots of all children.
fn child_slots(t: u32, p: u32) -> vec4u {
    return vec4u(t, child_slot(t, p, 1), child_slot(t, p, 2), child_slot(t, p, 3));
}
