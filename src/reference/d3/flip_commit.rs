//! Carrying out the flips that won all of their tetrahedra.

use crate::d3::mesh::FACETS;
use crate::gpu::layout::{
    BLOCK, DONE, EDGE_SHIFT, FACET_SHIFT, FLIP_23, FLIP_32, FlipNode, HELD_SHIFT, HISTORY_FULL, KIND_SHIFT, NONE,
    SLOT_SHIFT, SLOTS_FULL, Status,
};

use crate::reference::d3::State;
use crate::reference::d3::state::scramble;

/// A flip, with what it changes. See [`FlipNode::vertices`] for the ring and the edge.
struct Flip {
    kind: u32,
    ring: [u32; 3],
    d: u32,
    e: u32,
    /// The old tetrahedra: 2-3, that with d and that with e; 3-2, those with ring edges 01, 12 and 20.
    old: [u32; 3],
}

/// Carries out the proposed flips that won. One thread an entry of the active list.
///
/// A flip owns its tetrahedra, so it overwrites them in place; the outer facets of the new ones keep their old
/// neighbours until [`flip_link`](crate::reference::d3::flip_link), and each old tetrahedron gets a message that says where its outer
/// facets went. A flip that finds no slot, or no room in the history, is put off: it stays in the active list.
pub fn flip_commit(state: &mut State) {
    let iteration = state.counters.iteration;
    state.counters.link_iteration = iteration;
    if state.is_idle(iteration) {
        return;
    }
    state.counters.active_len[((iteration + 1) & 1) as usize] = 0;
    let half = state.half();
    for i in 0..state.counters.active_len[half] as usize {
        let Some(flip) = flip_of(state, i) else { continue };
        let old = if flip.kind == FLIP_23 { &flip.old[..2] } else { &flip.old[..] };
        let bid = state.bid(i);
        if old.iter().any(|&t| state.status[t as usize].vote != bid) {
            continue;
        }
        let Some(node) = node_for(state, old) else { continue };
        let third = match flip.kind {
            FLIP_23 => match free_slot(state, &flip) {
                Some(slot) => slot,
                None => continue,
            },
            _ => flip.old[2],
        };
        let tets = [flip.old[0], flip.old[1], third];
        if node != NONE {
            record(state, &flip, old, tets, node);
        }
        let mark = state.changed_mark(iteration);
        for (place, &t) in tets.iter().enumerate() {
            let held = if node == NONE { 0 } else { state.counters.round << HELD_SHIFT };
            let check = match (flip.kind, place) {
                (FLIP_23, _) => 0b1100,
                (_, 2) => 0,
                _ => 0b0111,
            };
            let last = if node == NONE { 0 } else { node << 2 | place as u32 };
            state.status[t as usize] =
                Status { flags: held | check, vote: mark, last, first: state.status[t as usize].first };
        }
        let freed = if flip.kind == FLIP_23 { two_to_three(state, &flip, tets) } else { three_to_two(state, &flip) };
        state.active[half][i].outcome = DONE | freed << SLOT_SHIFT | flip.kind;
    }
}

/// The flip that entry `i` of the active list proposes.
fn flip_of(state: &State, i: usize) -> Option<Flip> {
    let entry = state.active[state.half()][i];
    let kind = entry.outcome >> KIND_SHIFT & 3;
    let k = (entry.outcome >> FACET_SHIFT & 3) as usize;
    let edge = (entry.outcome >> EDGE_SHIFT & 3) as usize;
    if kind == 0 {
        return None;
    }
    let tet = state.tets[entry.tet as usize];
    let across = state.neighbors[entry.tet as usize][k];
    let u = across >> 2;
    let apex = state.tets[u as usize][(across & 3) as usize];
    let corners: [usize; 3] = std::array::from_fn(|i| FACETS[k][(edge + i) % 3]);
    let x = corners.map(|c| tet[c]);
    Some(if kind == FLIP_23 {
        Flip { kind, ring: x, d: tet[k], e: apex, old: [entry.tet, u, NONE] }
    } else {
        let w = state.neighbors[entry.tet as usize][corners[2]] >> 2;
        Flip { kind, ring: [tet[k], x[2], apex], d: x[0], e: x[1], old: [entry.tet, u, w] }
    })
}

/// A number in the history for a flip of `old`: [`NONE`] where no waiting point can lie in them, nothing when the
/// history is full.
fn node_for(state: &mut State, old: &[u32]) -> Option<u32> {
    if !old.iter().any(|&t| state.is_held(t)) {
        return Some(NONE);
    }
    let node = state.counters.next_node;
    if node - state.counters.first_node >= state.params.history {
        state.counters.overflow |= HISTORY_FULL;
        return None;
    }
    state.counters.next_node += 1;
    Some(node)
}

/// Takes a free slot: from the block of a vertex of the flip, else from one of a few blocks of the tail.
fn free_slot(state: &mut State, flip: &Flip) -> Option<u32> {
    const PROBES: u32 = 16;
    let tail = state.params.blocks - state.params.infinite - 1;
    let seed = scramble(flip.old[0], state.counters.iteration, 31);
    let in_tail = (0..if tail == 0 { 0 } else { PROBES })
        .map(|probe| state.params.infinite + 1 + seed.wrapping_add(probe.wrapping_mul(0x9e37_79b9)) % tail);
    let blocks = flip.ring.into_iter().chain([flip.d, flip.e]).chain(in_tail);
    for block in blocks {
        let free = &mut state.free[block as usize];
        if *free != 0 {
            let place = free.trailing_zeros();
            *free &= !(1 << place);
            return Some(block * BLOCK + place);
        }
    }
    state.counters.overflow |= SLOTS_FULL;
    None
}

/// Writes a node of the history, and makes those before it point to it. (Algorithm 2 does this from the last flip to
/// the first after the fact; since a flip owns its tetrahedra, it can be done at once.)
fn record(state: &mut State, flip: &Flip, old: &[u32], tets: [u32; 3], node: u32) {
    let first = state.counters.first_node;
    let [x0, x1, x2] = flip.ring;
    state.history[(node - first) as usize] =
        FlipNode { vertices: [x0, x1, x2, flip.d, flip.e], kind: flip.kind, tets, next: [NONE; 3] };
    for &t in old {
        let last = state.status[t as usize].last;
        if !state.is_held(t) {
            continue;
        }
        if last >> 2 >= first {
            state.history[((last >> 2) - first) as usize].next[(last & 3) as usize] = node;
        } else {
            state.status[t as usize].first = node;
        }
    }
}

fn place_of(tet: [u32; 4], v: u32) -> usize {
    tet.iter().position(|&w| w == v).expect("the vertex is of the tetrahedron")
}

/// (xᵢ, xᵢ₊₁, d, e): face 0 leads to the next of the three, face 1 to the one before, faces 2 and 3 are the old facets
/// with e and with d. Returns no slot.
fn two_to_three(state: &mut State, flip: &Flip, tets: [u32; 3]) -> u32 {
    let [t, u] = [flip.old[0] as usize, flip.old[1] as usize];
    let outer = [state.neighbors[u], state.neighbors[t]];
    let places = [state.tets[u], state.tets[t]].map(|tet| flip.ring.map(|x| place_of(tet, x)));
    for i in 0..3 {
        let [x, y] = [flip.ring[i], flip.ring[(i + 1) % 3]];
        let opposite = (i + 2) % 3;
        let slot = tets[i] as usize;
        state.tets[slot] = [x, y, flip.d, flip.e];
        state.neighbors[slot] = [
            4 * tets[(i + 1) % 3] + 1,
            4 * tets[(i + 2) % 3],
            outer[0][places[0][opposite]],
            outer[1][places[1][opposite]],
        ];
    }
    for (i, tet) in tets.into_iter().enumerate() {
        let opposite = (i + 2) % 3;
        state.messages[u][places[0][opposite]] = 4 * tet + 2;
        state.messages[t][places[1][opposite]] = 4 * tet + 3;
    }
    0
}

/// The upper tetrahedron (x₀, x₁, x₂, e) and the lower one (x₀, x₂, x₁, d), joined by their faces 3. Returns the slot
/// that is given back.
fn three_to_two(state: &mut State, flip: &Flip) -> u32 {
    let [upper, lower, freed] = flip.old;
    let old = flip.old.map(|t| t as usize);
    let outer = old.map(|t| state.neighbors[t]);
    let places = old.map(|t| [flip.d, flip.e].map(|v| place_of(state.tets[t], v)));
    let [x0, x1, x2] = flip.ring;
    state.tets[upper as usize] = [x0, x1, x2, flip.e];
    state.tets[lower as usize] = [x0, x2, x1, flip.d];
    state.tets[freed as usize] = [0; 4];
    state.neighbors[upper as usize][3] = 4 * lower + 3;
    state.neighbors[lower as usize][3] = 4 * upper + 3;
    for j in 0..3 {
        // The facets of the new tetrahedra opposite ring vertex j were of the old one with the other two.
        let i = (j + 1) % 3;
        let in_lower = [0, 2, 1][j];
        state.neighbors[upper as usize][j] = outer[i][places[i][0]];
        state.neighbors[lower as usize][in_lower] = outer[i][places[i][1]];
        state.messages[old[i]][places[i][0]] = 4 * upper + j as u32;
        state.messages[old[i]][places[i][1]] = 4 * lower + in_lower as u32;
    }
    debug_assert_eq!(flip.kind, FLIP_32);
    freed
}
