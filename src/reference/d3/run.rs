//! Phase 1 on the references.

use crate::gpu::layout::NONE;
use crate::gpu::layout::Pick;
use crate::gpu::start::first_simplex;
use crate::input::lattice::Width;

use crate::reference::d3::predicates::Vertex;
use crate::reference::d3::{
    State, flip_check, flip_commit, flip_link, locate, mark_failed, pick_point, pick_score, relocate, relocate_split,
    split, start,
};

/// How to run.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// How points are picked.
    pub pick: Pick,
    /// Insert all points before flipping (§5.3).
    pub insert_all: bool,
    /// With fewer active tetrahedra than this, flipping waits for the next round; except at the end.
    pub min_active: u32,
    /// Flip iterations in a round, at most; except at the end.
    pub iterations: u32,
    /// Blocks in the tail.
    pub tail: u32,
    /// Nodes that the history can hold.
    pub history: u32,
    /// Validate after every phase.
    pub validate: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            pick: Pick::Circumcenter,
            insert_all: false,
            min_active: 0,
            iterations: u32::MAX,
            tail: 16,
            history: 1 << 22,
            validate: false,
        }
    }
}

/// Runs Phase 1 on `sites`, which are sorted along the Hilbert curve and distinct. Nothing if they are coplanar.
pub fn run(width: Width, mut sites: Vec<Vertex>, settings: &Settings) -> Option<State> {
    let begin = first_simplex(width, sites.len(), |i| sites[i].position)?;
    sites.push(Vertex { position: begin.interior_point, index: sites.iter().map(|s| s.index).max()? + 1 });
    let mut state = State::new(width, sites, settings.tail, settings.history);
    state.params.pick = settings.pick as u32;
    state.params.min_active = settings.min_active;
    let check = |state: &State| {
        if settings.validate {
            state.validate();
        }
    };
    start(&mut state, begin.first);
    locate(&mut state);
    check(&state);
    state.waiting.retain(|w| w.tet != NONE);
    while !state.waiting.is_empty() {
        state.messages.fill([0; 4]);
        pick_score(&mut state);
        pick_point(&mut state);
        split(&mut state);
        relocate_split(&mut state);
        check(&state);
        if !settings.insert_all {
            flip(&mut state, settings.iterations);
            relocate(&mut state);
            check(&state);
        }
        state.waiting.retain(|w| w.tet != NONE);
        grow(&mut state);
    }
    state.params.min_active = 0;
    while !state.is_idle(state.counters.iteration) {
        flip(&mut state, settings.iterations);
        grow(&mut state);
        check(&state);
    }
    mark_failed(&mut state);
    Some(state)
}

fn flip(state: &mut State, iterations: u32) {
    for _ in 0..iterations {
        if state.is_idle(state.counters.iteration) || state.counters.overflow != 0 {
            break;
        }
        flip_check(state);
        flip_commit(state);
        flip_link(state);
        if (state.counters.iteration + 2) >= 1 << (32 - state.params.bid_bits) {
            clear_votes(state);
        }
    }
}

/// Forgets all votes, so that flip iterations can be counted from the start again; which half of the active list is
/// read stays the same.
pub fn clear_votes(state: &mut State) {
    state.status.iter_mut().for_each(|s| s.vote = 0);
    state.counters.iteration &= 1;
}

/// More slots where they ran out.
fn grow(state: &mut State) {
    if std::mem::take(&mut state.counters.overflow) & crate::gpu::layout::SLOTS_FULL == 0 {
        return;
    }
    let blocks = state.params.blocks + state.params.blocks / 2;
    let slots = (blocks * crate::gpu::layout::BLOCK) as usize;
    state.params.blocks = blocks;
    state.params.bid_bits = 33 - (slots as u32).leading_zeros();
    state.tets.resize(slots, [0; 4]);
    state.neighbors.resize(slots, [NONE; 4]);
    state.status.resize(slots, Default::default());
    state.messages.resize(slots, [0; 4]);
    state.free.resize(blocks as usize, 0xff);
    state.active.iter_mut().for_each(|half| half.resize(slots, Default::default()));
    clear_votes(state);
}
