// The contents of the buffers that the kernels of Phase 1 share in both dimensions.
// src/gpu/layout.rs explains them; the build checks that its structures have the same layout.
//!include primitives/workgroup

const NONE: u32 = 0xffffffff;
const BLOCK: u32 = 8;
// The free slots of a block, if all are.
const ALL_FREE: u32 = 0xff;
// In 3D, where the round in which its vertex was inserted starts in the word of a block.
const ROUND_SHIFT: u32 = 8;
// The sort key of a point that was merged into another: it goes behind all vertices.
const MERGED_KEY: u32 = 0xffffffff;

// The rounds of which `log` keeps the state at their ends.
const LOGGED: u32 = 8;
// Flips wait for the next round with fewer active simplices than one per 2^WAITING_SHIFT inserted points;
// than one per 2^WAITING_EXACT_SHIFT if more than one visited simplex in WAITING_EXACT_SHARE needed exact signs.
const WAITING_SHIFT: u32 = 2;
const WAITING_EXACT_SHIFT: u32 = 4;
const WAITING_EXACT_SHARE: u32 = 64;

// How a simplex picks its point.
const PICK_CIRCUMCENTER: u32 = 0;
const PICK_CENTROID: u32 = 1;
const PICK_RANDOM: u32 = 2;
const PICK_ADAPTIVE: u32 = 3;
// PICK_ADAPTIVE goes by the last round that began with at least GROWTH_FROM points and ended with at most one in
// GROWTH_SHARE of all: if it inserted at least TWICE_GROWTH / 2 times the points that it began with, they fill space
// evenly.
const GROWTH_FROM: u32 = 256;
const GROWTH_SHARE: u32 = 64;
const TWICE_GROWTH: u32 = 11;

// The parameters (`Params` on the host), then from `iteration` on the counters (`Counters`).
struct Control {
    infinite: u32,
    blocks: u32,
    history: u32,
    few: u32,
    few_limit: u32,
    few_iterations: u32,
    max_min_active: u32,
    insert_all: u32,
    pick: u32,
    blocks_before: u32,
    clockwise: u32,
    start_points: u32,
    start_simplices: u32,
    start_stride: u32,
    moved_simplices: u32,
    moved_ghosts: u32,
    moved_spread: u32,
    moved_inverted: u32,
    moved_violated: u32,

    iteration: u32,
    link_iteration: u32,
    bid_base: u32,
    link_bid_base: u32,
    min_active: u32,
    entries: u32,
    entries_before: u32,
    waiting_half: u32,
    active_len: array<atomic<u32>, 2>,
    round: u32,
    next_node: atomic<u32>,
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
    few_done: u32,
    kept: atomic<u32>,
    moved_hull: atomic<u32>,
    inverted: atomic<u32>,
    violated: atomic<u32>,
    criterion: u32,
    long_walks: atomic<u32>,
    gathered: atomic<u32>,
    removed: atomic<u32>,
    removals: u32,
    mesh_sum: atomic<u32>,
    mesh_vertices: atomic<u32>,
    taken: array<atomic<u32>, 5>,
    log: array<array<u32, 5>, LOGGED>,

    free: array<atomic<u32>>,
}

struct Status {
    flags: atomic<u32>,
    last: u32,
    vote: atomic<u32>,
    first: u32,
}

// The same for kernels in which no two invocations share the flags of a simplex.
struct OwnedStatus {
    // The flags, and the last node.
    made: vec2u,
    vote: atomic<u32>,
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
const DONE: u32 = 0x80000000;

const SLOTS_FULL: u32 = 1;
const HISTORY_FULL: u32 = 2;

struct Waiting {
    point: u32,
    tet: u32,
}
