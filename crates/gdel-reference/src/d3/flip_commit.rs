//! Carrying out a flip of two tetrahedra into three or of three into two.

use gdel::internals::d3::mesh::FACETS;
use gdel::{
    NONE,
    internals::gpu::layout::{
        ALL_FREE, BLOCK, DONE, DONE_23, EDGE_SHIFT, FACET_SHIFT, FLIP_23, FLIP_32, FlipNode, KIND_SHIFT, SLOT_SHIFT,
        SLOTS_FULL,
    },
};

use crate::State;
use crate::state::scramble;

/// A flip, with what it changes. See [`FlipNode`] for the ring and the edge.
struct Flip {
    kind: u32,
    ring: [u32; 3],
    d: u32,
    e: u32,
    /// The old tetrahedra: 2-3, that with d and that with e; 3-2, those with ring edges 01, 12 and
    /// 20.
    old: [u32; 3],
}

/// Carries out the flip that entry `i` of the active list proposes, if it has won.
pub(super) fn commit(state: &mut State<3>, i: usize) {
    let Some(flip) = flip_of(state, i) else { return };
    let old = if flip.kind == FLIP_23 { &flip.old[..2] } else { &flip.old[..] };
    if !state.has_won(i, old) {
        return;
    }
    let Some(node) = state.node_for(old) else { return };
    let third = match flip.kind {
        FLIP_23 => match free_slot(state, &flip) {
            Some(slot) => slot,
            None => return,
        },
        _ => flip.old[2],
    };
    let tets = [flip.old[0], flip.old[1], third];
    let [x0, x1, x2] = flip.ring;
    let (ring, d, e) = ([x0, x1, x2], flip.d, flip.e);
    state.record(node, FlipNode { ring, d, e, kind: flip.kind, tets, next: [NONE; 3] }, old);
    for (place, &t) in tets.iter().enumerate() {
        let check = match (flip.kind, place) {
            (FLIP_23, _) => 0b1100,
            (_, 2) => 0,
            _ => 0b0111,
        };
        state.mark_changed(t, check, node, place);
    }
    let freed = if flip.kind == FLIP_23 { two_to_three(state, &flip, tets) } else { three_to_two(state, &flip) };
    let half = state.half();
    state.active[half][i].outcome = DONE | if flip.kind == FLIP_23 { DONE_23 } else { freed << SLOT_SHIFT };
}

/// Returns the flip that entry `i` of the active list proposes.
fn flip_of(state: &State<3>, i: usize) -> Option<Flip> {
    let entry = state.active[state.half()][i];
    let kind = entry.outcome >> KIND_SHIFT & 3;
    let k = (entry.outcome >> FACET_SHIFT & 3) as usize;
    let edge = (entry.outcome >> EDGE_SHIFT & 3) as usize;
    if kind == 0 {
        return None;
    }
    let tet = state.corners(entry.tet);
    let (u, face) = state.across(entry.tet, k);
    let apex = state.corners(u)[face];
    let corners: [usize; 3] = std::array::from_fn(|i| FACETS[k][(edge + i) % 3]);
    let x = corners.map(|c| tet[c]);
    Some(if kind == FLIP_23 {
        Flip { kind, ring: x, d: tet[k], e: apex, old: [entry.tet, u, NONE] }
    } else {
        let (w, _) = state.across(entry.tet, corners[2]);
        Flip { kind, ring: [tet[k], x[2], apex], d: x[0], e: x[1], old: [entry.tet, u, w] }
    })
}

/// Takes a free slot: from the block of a vertex of the flip or of one beside it, else from one of a few
/// blocks of the tail.
fn free_slot(state: &mut State<3>, flip: &Flip) -> Option<u32> {
    const TRIES: u32 = 12;
    const NEAR_TRIES: u32 = 2;
    const WINDOW: u32 = 16;
    let tail = state.params.blocks - state.params.infinite - 1;
    let seed = scramble(flip.old[0], state.counters.iteration, 31);
    let infinite = state.params.infinite;
    let place = flip.ring[0].min(flip.ring[1]) / (infinite / tail.max(1)).max(1);
    let in_tail = (0..if tail == 0 { 0 } else { 4 * TRIES }).map(|probe| {
        let near = probe / 4;
        let window = if near < NEAR_TRIES { (WINDOW << (4 * near)).min(tail) } else { tail };
        infinite + 1 + (place + seed.wrapping_add(probe.wrapping_mul(0x9e37_79b9)) % window) % tail
    });
    let own = || flip.ring.into_iter().chain([flip.d, flip.e]);
    let beside = |by: u32| own().map(move |v| v.wrapping_add(by).min(infinite));
    let of_others = beside(1).chain(beside(u32::MAX)).map(|block| (block, true));
    let of_flip = own().map(|block| (block, false));
    for (block, is_beside) in of_flip.chain(of_others).chain(in_tail.map(|block| (block, false))) {
        let free = &mut state.own.free[block as usize];
        // The slots of vertices that are not inserted yet are all free, and not for others.
        if *free & ALL_FREE != 0 && !(is_beside && *free == ALL_FREE) {
            let place = free.trailing_zeros();
            *free &= !(1 << place);
            return Some(block * BLOCK + place);
        }
    }
    state.counters.overflow |= SLOTS_FULL;
    None
}

fn place_of(tet: [u32; 4], v: u32) -> usize {
    tet.iter().position(|&w| w == v).expect("the vertex is of the tetrahedron")
}

/// Makes the tetrahedra (xᵢ, xᵢ₊₁, d, e): face 0 leads to the next of the three, face 1 to the one
/// before, faces 2 and 3 are the old facets with e and with d. Returns 0: no slot is given back.
fn two_to_three(state: &mut State<3>, flip: &Flip, tets: [u32; 3]) -> u32 {
    let [t, u] = [flip.old[0] as usize, flip.old[1] as usize];
    let outer = [state.neighbors[u], state.neighbors[t]];
    let places = [state.simplices[u], state.simplices[t]].map(|tet| flip.ring.map(|x| place_of(tet, x)));
    for i in 0..3 {
        let [x, y] = [flip.ring[i], flip.ring[(i + 1) % 3]];
        let opposite = (i + 2) % 3;
        let slot = tets[i] as usize;
        state.simplices[slot] = [x, y, flip.d, flip.e];
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

/// Makes the upper tetrahedron (x₀, x₁, x₂, e) and the lower one (x₀, x₂, x₁, d), joined by their
/// faces 3. Returns the slot that is given back.
fn three_to_two(state: &mut State<3>, flip: &Flip) -> u32 {
    let [upper, lower, freed] = flip.old;
    let old = flip.old.map(|t| t as usize);
    let outer = old.map(|t| state.neighbors[t]);
    let places = old.map(|t| [flip.d, flip.e].map(|v| place_of(state.simplices[t], v)));
    let [x0, x1, x2] = flip.ring;
    state.simplices[upper as usize] = [x0, x1, x2, flip.e];
    state.simplices[lower as usize] = [x0, x2, x1, flip.d];
    state.simplices[freed as usize] = [0; 4];
    state.neighbors[upper as usize][3] = 4 * lower + 3;
    state.neighbors[lower as usize][3] = 4 * upper + 3;
    for j in 0..3 {
        // The facets of the new tetrahedra opposite ring vertex j were of the old one with the
        // other two.
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
