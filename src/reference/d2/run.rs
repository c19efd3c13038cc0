//! The whole run on the references.

use crate::gpu::layout::NONE;
use crate::gpu::layout::Pick;
use crate::gpu::start::first_simplex;
use crate::input::lattice::Width;

use crate::reference::d2::predicates::Vertex;
use crate::reference::d2::{
    State, flip_check, flip_commit, flip_link, locate, pick_point, pick_score, relocate, relocate_split, split, start,
};

/// How to run.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// How points are picked.
    pub pick: Pick,
    /// Insert all points before flipping (§5.3).
    pub insert_all: bool,
    /// With fewer active triangles than this, flipping waits for the next round; except at the end.
    pub min_active: u32,
    /// Nodes that the history can hold.
    pub history: u32,
    /// Validate after every phase.
    pub validate: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { pick: Pick::Circumcenter, insert_all: false, min_active: 0, history: 1 << 20, validate: false }
    }
}

/// Triangulates `sites`, which are sorted along the Hilbert curve and distinct. Nothing if they are collinear.
pub fn run(width: Width, mut sites: Vec<Vertex>, settings: &Settings) -> Option<State> {
    let begin = first_simplex(width, sites.len(), |i| sites[i].position)?;
    sites.push(Vertex { position: begin.interior_point, index: sites.len() as u32 });
    let mut state = State::new(width, sites, settings.history);
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
            flip(&mut state);
            relocate(&mut state);
            check(&state);
        }
        state.waiting.retain(|w| w.tet != NONE);
    }
    state.params.min_active = 0;
    // Nothing waits: the flips of this round need no history.
    pick_score(&mut state);
    flip(&mut state);
    state.validate_end();
    Some(state)
}

/// Flip iterations until too few triangles are active or the history is full.
fn flip(state: &mut State) {
    while !state.is_idle(state.counters.iteration) && std::mem::take(&mut state.counters.overflow) == 0 {
        flip_check(state);
        flip_commit(state);
        flip_link(state);
        if (state.counters.iteration + 2) >= 1 << (32 - state.params.bid_bits) {
            clear_votes(state);
        }
    }
}

/// Forgets all votes, so that flip iterations can be counted from the start again; which half of the active list is read
/// stays the same.
pub fn clear_votes(state: &mut State) {
    state.status.iter_mut().for_each(|s| s.vote = 0);
    state.counters.iteration &= 1;
}
