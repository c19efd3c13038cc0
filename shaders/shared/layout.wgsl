// What the kernels of Phase 1 keep in buffers: the twin of src/gpu/layout.rs, which explains it.

const NONE: u32 = 0xffffffff;
const BLOCK: u32 = 8;

// Parameters, then counters.
struct Control {
    infinite: u32,
    blocks: u32,
    history: u32,
    bid_bits: u32,
    min_active: u32,
    pick: u32,
    entries: u32,
    entries_before: u32,
    blocks_before: u32,
    compact_from: u32,
    clockwise: u32,

    iteration: u32,
    link_iteration: u32,
    active_len: array<atomic<u32>, 2>,
    round: u32,
    next_node: atomic<u32>,
    first_node: u32,
    inserted: atomic<u32>,
    flips_23: atomic<u32>,
    flips_32: atomic<u32>,
    exact: atomic<u32>,
    overflow: atomic<u32>,
    iterations: u32,
    visits: u32,
    failed: atomic<u32>,
    merged: u32,
    uncertain: atomic<u32>,
    ghosts: atomic<u32>,
    undecided: atomic<u32>,
    not_locally_delaunay: atomic<u32>,
    flips_22: atomic<u32>,
    hull: atomic<u32>,
}

struct Status {
    flags: atomic<u32>,
    vote: atomic<u32>,
    last: u32,
    first: u32,
}

const CHECK: u32 = 0xf;
const SUSPECT_SHIFT: u32 = 4;
const HELD_SHIFT: u32 = 16;

struct Active {
    tet: u32,
    outcome: u32,
}

const KIND_SHIFT: u32 = 8;
const FACET_SHIFT: u32 = 10;
const EDGE_SHIFT: u32 = 12;
const FLIP_23: u32 = 1;
const FLIP_32: u32 = 2;
const DONE: u32 = 0x80000000;
const SLOT_SHIFT: u32 = 2;

struct FlipNode {
    vertices: array<u32, 5>,
    kind: u32,
    tets: array<u32, 3>,
    next: array<u32, 3>,
}

const SLOTS_FULL: u32 = 1;
const HISTORY_FULL: u32 = 2;

struct Waiting {
    point: u32,
    tet: u32,
}

// The corners of the facet opposite vertex k, counter-clockwise as seen from outside.
fn facet(k: u32) -> vec3u {
    return select(select(select(vec3u(0, 2, 1), vec3u(0, 1, 3), k == 2), vec3u(0, 3, 2), k == 1), vec3u(1, 2, 3), k == 0);
}

// The place of a vertex in a tetrahedron that has it.
fn place_of(tet: vec4u, v: u32) -> u32 {
    return select(select(select(3u, 2u, tet.z == v), 1u, tet.y == v), 0u, tet.x == v);
}

// The tetrahedron with vertex k replaced.
fn replaced(tet: vec4u, k: u32, v: u32) -> vec4u {
    return select(tet, vec4u(v), vec4u(0, 1, 2, 3) == vec4u(k));
}

// The slot of child k of tetrahedron t, split at point p: the one with p in place of vertex k.
fn child_slot(t: u32, p: u32, k: u32) -> u32 {
    return select(p * BLOCK + k - 1, t, k == 0);
}
