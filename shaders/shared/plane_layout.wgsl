// What the kernels of the plane keep in buffers besides what those of space do: the twin of src/gpu/plane/layout.rs, which
// explains it.
//!include shared/layout

// Slots 2v and 2v + 1 belong to vertex v.
const PLANE_BLOCK: u32 = 2;
// A flip of two triangles into two, beside FLIP_23 and FLIP_32.
const FLIP_22: u32 = 3;

struct EdgeFlip {
    edge: vec2u,
    triangles: vec2u,
    next: vec2u,
}

struct Question {
    triangle: vec3u,
    beyond: u32,
}

const COUNTER_CLOCKWISE: u32 = 0xffffffff;
const FLAT: u32 = 0xfffffffe;

// The triangle with vertex k replaced.
fn with_vertex(tri: vec3u, k: u32, v: u32) -> vec3u {
    return select(tri, vec3u(v), vec3u(0, 1, 2) == vec3u(k));
}

// The place of a vertex in a triangle that has it.
fn corner_of(tri: vec3u, v: u32) -> u32 {
    return select(select(2u, 1u, tri.y == v), 0u, tri.x == v);
}

// The slot of child k of triangle t, split at point p: the one with p in place of vertex k.
fn plane_child_slot(t: u32, p: u32, k: u32) -> u32 {
    return select(PLANE_BLOCK * p + k - 1, t, k == 0);
}
