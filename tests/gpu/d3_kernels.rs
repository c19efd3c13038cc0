//! Every 3D kernel against its reference, on the same buffers.
//!
//! The points have coordinates, or high words of them, below 8, so that the scores are exact in
//! `f32` and ties of every kind abound. After each kernel the device gets the reference's buffers
//! again, so that each is compared on its own.

use crate::kernels::{Device, listed, shuffled};
use gdel::NONE;
use gdel::internals::{
    gpu::{
        Storage,
        layout::{CHECK, Counters, DONE, LOGGED, Pick},
        start::{StartMesh, StartSimplex, first_simplex},
    },
    input::lattice::{Lattice, Width},
};
use gdel_reference::{
    self as reference,
    d3::{self, predicates::Vertex},
};
use std::collections::BTreeSet;

type State = reference::State<3>;

/// What the choice of slots and numbers in the history leaves the same: the tetrahedra by their
/// vertices, with the facets to check and the neighbours across each facet, and the flips of the
/// history.
fn essence(state: &State) -> (BTreeSet<Vec<u32>>, BTreeSet<Vec<u32>>) {
    let tets = (0..state.simplices.len()).filter(|&t| state.is_used(t)).map(|t| {
        let mut record = state.simplices[t].to_vec();
        record.push(state.status[t].flags);
        for across in state.neighbors[t] {
            record.extend(state.simplices[(across >> 2) as usize]);
            record.push(across & 3);
        }
        record
    });
    let nodes = state.counters.next_node as usize;
    let flips = state.history[..nodes].iter().map(|node| {
        let mut record = [&node.ring[..], &[node.d, node.e, node.kind]].concat();
        record.extend(node.next.map(|next| match next {
            NONE => NONE,
            next => state.history[next as usize].ring[0],
        }));
        record
    });
    (tets.collect(), flips.collect())
}

/// The tetrahedra with facets to check.
fn to_check(state: &State) -> BTreeSet<u32> {
    (0..).zip(&state.status).filter(|(_, s)| s.flags & CHECK != 0).map(|(t, _)| t).collect()
}

/// Checks: one function of the reference, and two kernels.
fn check(device: &Device<3>, state: &mut State) {
    device.upload(state);
    device.run("flip_check");
    device.run("flip_check_exact");
    reference::flip_check(state);
    let after = device.download(state);
    assert_eq!(after.status, state.status, "check");
    assert_eq!(after.active, state.active, "check");
    assert_eq!(Counters { undecided: 0, ..after.counters }, state.counters, "check");
}

/// Returns points, the first simplex of them, and the state before they are triangulated.
fn begun(width: Width) -> (Vec<[i64; 3]>, StartSimplex<3>, State) {
    let positions = shuffled(width, (0..512).map(|i| [i & 7, i >> 3 & 7, i >> 6]).collect(), 250);
    let start = first_simplex(width, positions.len(), |i| positions[i]).expect("not coplanar");
    let mut points: Vec<Vertex> =
        (0..).zip(&positions).map(|(index, &position)| Vertex { position, index: index ^ 0x55 }).collect();
    points.push(Vertex { position: start.interior_point, index: 1000 });
    (positions, start, State::new(width, points, 64, 4096))
}

fn compare(width: Width, pick: Pick) {
    let (positions, start, mut state) = begun(width);
    state.params.pick = pick as u32;
    let floats: Vec<[f64; 3]> = positions.iter().map(|q| q.map(|x| x as f64)).collect();
    let points = (&floats).into();
    let start = StartMesh::new(points, &Lattice::fit(points), &start, 20);
    assert!(start.points.len() > 15);
    // The points are in the order of the vertices.
    let vertices = start.points.iter().map(|&[v, _]| v).collect();
    state.set_start(start, vertices);
    let device = Device::<3>::new(width, &state);
    let failed_points = Storage::new(&device.kernels.gpu, "failed points", 250).unwrap();
    let device = device.with(&[("failed_points", failed_points.buffer())]);
    device.start(&mut state);
    state.validate_mesh();
    while state.waiting.iter().any(|entry| entry.tet != NONE) {
        state.messages.fill([0; 4]);
        device.equal("begin_round", &mut state, reference::begin_round);
        device.pick_score(&mut state);
        device.equal("pick_point", &mut state, reference::pick_point);

        let split = device.both("split", &mut state, reference::split);
        assert_eq!((&split.simplices, &split.neighbors), (&state.simplices, &state.neighbors));
        assert_eq!((&split.status, &split.own.free), (&state.status, &state.own.free));
        let half = state.half();
        assert_eq!(listed(&split, half), listed(&state, half), "split");

        device.equal("relocate_split", &mut state, reference::relocate_split);
        while !state.is_idle(state.counters.iteration) {
            check(&device, &mut state);
            device.upload(&state);
            device.run("flip_commit");
            device.run("flip_link");
            reference::flip_commit(&mut state);
            let done = state.active[half_of(&state)].iter().filter(|a| a.outcome & DONE != 0).count();
            reference::flip_link(&mut state);
            let after = device.download(&state);
            assert!(done > 0 || state.counters.active_len[state.half()] == 0, "an iteration without progress");
            assert_eq!(after.counters, state.counters, "flip");
            assert_eq!(essence(&after), essence(&state), "flip");
            assert_eq!(listed(&after, after.half()), to_check(&after), "flip");
            assert_eq!(listed(&state, state.half()), to_check(&state), "flip");
            after.validate_mesh();
            state.validate_mesh();
        }
        device.equal("relocate", &mut state, reference::relocate);
    }
    // Every facet is suspect, so that there is something to look at.
    state.status.iter_mut().for_each(|s| s.flags |= CHECK << 4);
    device.equal("mark_failed", &mut state, d3::mark_failed);
    let mut failed: Vec<u32> = (0..)
        .zip(&state.own.failed)
        .filter(|&(_, &f)| f != 0)
        .map(|(v, _): (usize, _)| state.points[v].index)
        .collect();
    let mut points = device.read::<u32>(&failed_points);
    points.truncate(failed.len());
    failed.sort_unstable();
    points.sort_unstable();
    assert_eq!(points, failed);
    device.equal("clear_votes", &mut state, reference::run::clear_votes);
}

fn half_of(state: &State) -> usize {
    (state.counters.link_iteration & 1) as usize
}

/// The centroid decides where a round has multiplied many points, and few of all, by more than 6.5, and few signs were
/// exact.
#[test]
fn points_are_picked_by_what_rounds_insert() {
    const CIRCUMCENTER: u32 = Pick::Circumcenter as u32;
    const CENTROID: u32 = Pick::Centroid as u32;
    let (_, _, begun) = begun(Width::Wide);
    let device = Device::<3>::new(Width::Wide, &begun);
    // The points before the round, those that it inserted, the exact signs of 1,000 visits, and the criterion
    // before and after.
    let cases = [
        (600, 4_000, 0, CIRCUMCENTER, CENTROID),
        (600, 4_000, 15, CIRCUMCENTER, CENTROID),
        (600, 4_000, 16, CENTROID, CIRCUMCENTER),
        (600, 3_000, 0, CENTROID, CIRCUMCENTER),
        (255, 2_000, 0, CIRCUMCENTER, CIRCUMCENTER),
        (256, 2_000, 0, CIRCUMCENTER, CENTROID),
        (2_000, 13_625, 0, CIRCUMCENTER, CENTROID),
        (2_000, 13_626, 0, CIRCUMCENTER, CIRCUMCENTER),
        (900_000, 20_000, 0, CENTROID, CENTROID),
    ];
    for pick in Pick::ALL {
        for (round, (before, added, exact, criterion, expected)) in (1..).zip(cases) {
            let mut state = begun.clone();
            (state.params.infinite, state.params.pick) = (1_000_000, pick as u32);
            let counters = &mut state.counters;
            (counters.inserted, counters.visits, counters.exact) = (before + added, 1_000, exact);
            (counters.round, counters.criterion) = (round, criterion);
            counters.log[(round as usize - 1) % LOGGED][0] = before;
            device.equal("begin_round", &mut state, reference::begin_round);
            let expected = if pick == Pick::Adaptive { expected } else { pick as u32 };
            assert_eq!(
                state.counters.criterion, expected,
                "{pick:?}: {before} and {added} points, {exact} exact signs"
            );
        }
    }
}

#[test]
fn kernels_agree_with_their_references() {
    compare(Width::Narrow, Pick::Circumcenter);
    compare(Width::Wide, Pick::Centroid);
    compare(Width::Narrow, Pick::Random);
}
