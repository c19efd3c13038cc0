//! Phase 1 on the references.

use gdel::internals::dimension::Dimension;
use gdel::internals::gpu::dim::Dim;
use gdel::internals::gpu::start::{StartMesh, first_simplex};
use gdel::internals::input::lattice::{Lattice, Width};
use gdel::internals::input::points::Points;
use gdel::{
    NONE,
    internals::gpu::layout::{Pick, SLOTS_FULL},
};

use crate::dim::ReferenceDim;
use crate::kernels::Kernels;
use crate::{
    State, Vertex, begin_round, flip_check, flip_commit, flip_link, locate, pick_point, pick_score, relocate,
    relocate_split, split, start_mesh,
};

/// The settings of a run.
#[derive(Debug, Clone, Copy)]
pub struct Settings {
    /// How points are picked.
    pub pick: Pick,
    /// Insert all points before flipping (§5.3).
    pub insert_all: bool,
    /// With fewer active simplices than this, flipping waits for the next round; except at the end.
    pub min_active: u32,
    /// Blocks in the tail; 2D has none.
    pub tail: u32,
    /// Nodes that the history can hold.
    pub history: u32,
    /// Validate after every phase.
    pub validate: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            pick: Pick::default(),
            insert_all: false,
            min_active: 0,
            tail: 16,
            history: 1 << 20,
            validate: false,
        }
    }
}

/// Runs Phase 1 on `sites`, which are sorted along the Hilbert curve and distinct. Returns `None`
/// if they all lie in a line (2D) or plane (3D).
pub fn run<const D: usize>(width: Width, mut sites: Vec<Vertex<D>>, settings: &Settings) -> Option<State<D>>
where
    Dimension<D>: Kernels<D>,
{
    let begin = first_simplex(width, sites.len(), |i| sites[i].position)?;
    // The points that make the start are given in floating point.
    let is_exact = sites.iter().all(|s| s.position.iter().all(|&x| x < 1 << f64::MANTISSA_DIGITS));
    let start = if is_exact {
        let points: Vec<[f64; D]> = sites.iter().map(|s| s.position.map(|x| x as f64)).collect();
        let points = Points::F64(&points);
        StartMesh::new(points, &Lattice::fit(points), &begin, Dimension::<D>::start_points(sites.len()))
    } else {
        StartMesh::of_first(&begin)
    };
    let vertices = start.points.iter().map(|&[v, _]| v).collect();
    sites.push(Vertex { position: begin.interior_point, index: sites.iter().map(|s| s.index).max()? + 1 });
    let mut state = State::new(width, sites, settings.tail, settings.history);
    state.params.pick = settings.pick as u32;
    let check = |state: &State<D>| {
        if settings.validate {
            state.validate();
        }
    };
    state.set_start(start, vertices);
    start_mesh(&mut state);
    locate(&mut state);
    check(&state);
    while state.waiting.iter().any(|entry| entry.tet != NONE) {
        state.messages.fill([0; 4]);
        begin_round(&mut state);
        // Even if only a few points are inserted.
        state.counters.min_active = settings.min_active;
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
        grow(&mut state);
    }
    // In the last round no point waits, so its flips need no history.
    begin_round(&mut state);
    while !state.is_idle(state.counters.iteration) {
        flip(&mut state);
        grow(&mut state);
        check(&state);
    }
    Dimension::<D>::finish(&mut state);
    Some(state)
}

/// Runs flip iterations until too few simplices are active, or until slots or history are full.
fn flip<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: Kernels<D>,
{
    while !state.is_idle(state.counters.iteration) && state.counters.overflow == 0 {
        flip_check(state);
        flip_commit(state);
        flip_link(state);
        if state.counters.bid_base > u32::MAX / 2 {
            clear_votes(state);
        }
    }
}

/// Forgets all votes, so that bids start from the lowest number again.
pub fn clear_votes<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    state.status.iter_mut().for_each(|s| s.vote = 0);
    state.counters.bid_base = 1;
}

/// Adds slots where they ran out.
fn grow<const D: usize>(state: &mut State<D>)
where
    Dimension<D>: ReferenceDim<D>,
{
    if std::mem::take(&mut state.counters.overflow) & SLOTS_FULL == 0 {
        return;
    }
    state.grow(state.params.blocks + state.params.blocks / 2);
}
