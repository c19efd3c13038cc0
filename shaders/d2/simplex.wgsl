// Triangles: what the buffers hold of them, and the functions that d3/simplex has for tetrahedra.
// src/d2/gpu/layout.rs explains the structures.
//!include common/layout
//!include common/slots

// Slots 2v and 2v + 1 belong to vertex v.
const SLOTS_PER_POINT: u32 = 2;
// A flip of two triangles into two, beside the kinds of flips of d3/simplex.
const FLIP_22: u32 = 3;

struct EdgeFlip {
    edge: vec2u,
    triangles: vec2u,
    next: vec2u,
}

struct UncertainTest {
    triangle: vec3u,
    beyond: u32,
}

const COUNTER_CLOCKWISE: u32 = 0xffffffff;
const FLAT: u32 = 0xfffffffe;

// A flip in the history.
alias HistoryNode = EdgeFlip;

// A triangle by its vertices.
alias Simplex = vec3u;
const CORNERS: u32 = 3;

// Returns the words of a slot for a triangle.
fn packed(tri: Simplex) -> vec4u {
    return vec4u(tri, 0);
}

// Returns the triangle of the words of a slot.
fn unpacked(words: vec4u) -> Simplex {
    return words.xyz;
}

// Returns the triangle with vertex k replaced.
fn replaced(tri: vec3u, k: u32, v: u32) -> vec3u {
    return select(tri, vec3u(v), vec3u(0, 1, 2) == vec3u(k));
}

// Returns the place of a vertex in a triangle that has it.
fn place_of(tri: vec3u, v: u32) -> u32 {
    return select(select(2u, 1u, tri.y == v), 0u, tri.x == v);
}

// Returns the slots of all children.
fn child_slots(t: u32, p: u32) -> vec3u {
    return vec3u(t, child_slot(t, p, 1), child_slot(t, p, 2));
}
