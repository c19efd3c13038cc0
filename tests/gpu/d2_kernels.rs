//! Every 2D kernel against its reference, on the same buffers.
//!
//! The points have coordinates, or high words of them, below 16, so that the scores are exact in
//! `f32` and ties of every kind abound. After each kernel the device gets the reference's buffers
//! again, so that each is compared on its own.

use crate::kernels::{Device, listed, shuffled};
use crate::states::read_counters;
use gdel::NONE;
use gdel::internals::{
    d2::gpu::aliases::Aliases,
    gpu::{
        layout::{DONE, Pick},
        phase1::Aliases as _,
        start::{StartMesh, first_simplex},
    },
    input::lattice::{Lattice, Width},
};
use gdel_reference::{
    self as reference,
    d2::{self, predicates::Vertex},
};
use std::collections::BTreeSet;

type State = reference::State<2>;

/// What the choice of numbers in the history leaves the same: the flips by their edges.
fn flips(state: &State) -> BTreeSet<Vec<u32>> {
    let nodes = state.counters.next_node as usize;
    let flips = state.history[..nodes].iter().map(|node| {
        let next = node.next.map(|next| match next {
            NONE => [NONE; 2],
            next => state.history[next as usize].edge,
        });
        [node.edge, node.triangles, next[0], next[1]].concat()
    });
    flips.collect()
}

/// The statuses but for the numbers in the history.
fn statuses(state: &State) -> Vec<[u32; 2]> {
    state.status.iter().map(|s| [s.flags, s.vote]).collect()
}

fn compare(width: Width, pick: Pick) {
    let positions = shuffled(width, (0..256).map(|i| [i & 15, i >> 4]).collect(), 200);
    let start = first_simplex(width, positions.len(), |i| positions[i]).expect("not collinear");
    let mut points: Vec<Vertex> =
        (0..).zip(&positions).map(|(i, &position)| Vertex { position, index: (i * 77) % 200 }).collect();
    points.push(Vertex { position: start.interior_point, index: 200 });
    let mut state = State::new(width, points, 0, 4096);
    state.params.pick = pick as u32;
    let floats: Vec<[f64; 2]> = positions.iter().map(|q| q.map(|x| x as f64)).collect();
    let points = (&floats).into();
    let start = StartMesh::new(points, &Lattice::fit(points), &start, 20);
    assert!(start.points.len() > 15);
    // The points are in the order of the vertices.
    let vertices = start.points.iter().map(|&[v, _]| v).collect();
    state.set_start(start, vertices);
    let device = Device::<2>::new(width, &state);
    let aliases = Aliases::new(&device.buffers);
    let device = device.with(&aliases.bindings());
    device.start(&mut state);
    state.validate_mesh();
    while state.waiting.iter().any(|entry| entry.tet != NONE) {
        state.messages.fill([0; 4]);
        device.equal("begin_round", &mut state, reference::begin_round);
        device.pick_score(&mut state);
        device.equal("pick_point", &mut state, reference::pick_point);

        let split = device.both("split", &mut state, reference::split);
        assert_eq!((&split.simplices, &split.neighbors), (&state.simplices, &state.neighbors));
        assert_eq!(split.status, state.status);
        let half = state.half();
        assert_eq!(listed(&split, half), listed(&state, half), "split");

        device.equal("relocate_split", &mut state, reference::relocate_split);
        while !state.is_idle(state.counters.iteration) {
            device.equal("flip_check", &mut state, reference::flip_check);
            device.upload(&state);
            device.run("flip_commit");
            device.run("flip_link");
            reference::flip_commit(&mut state);
            let half = (state.counters.link_iteration & 1) as usize;
            let done = state.active[half].iter().filter(|a| a.outcome & DONE != 0).count();
            reference::flip_link(&mut state);
            let after = device.download(&state);
            assert!(done > 0 || state.counters.active_len[state.half()] == 0, "an iteration without progress");
            assert_eq!(after.counters, state.counters, "flip");
            assert_eq!((&after.simplices, &after.neighbors), (&state.simplices, &state.neighbors), "flip");
            assert_eq!(statuses(&after), statuses(&state), "flip");
            assert_eq!(flips(&after), flips(&state), "flip");
            after.validate_mesh();
            state.validate_mesh();
        }
        device.equal("relocate", &mut state, reference::relocate);
    }
    device.equal("clear_votes", &mut state, reference::run::clear_votes);

    device.upload(&state);
    device.run("mesh_mark");
    let marks = d2::mesh_mark(&state);
    assert_eq!(device.read(&device.buffers.numbering.marks), marks);
    let numbers: Vec<u32> = marks.iter().scan(0, |sum, &m| Some(std::mem::replace(sum, *sum + m))).collect();
    device.buffers.numbering.numbers.write(&device.kernels.gpu, 0, &numbers);
    device.run("mesh_compact");
    let mesh = d2::mesh_compact(&state, &numbers);
    let count = mesh.triangles.len();
    assert_eq!(device.read(&aliases.triangles)[..count], mesh.triangles);
    assert_eq!(device.read(&aliases.halfedges)[..count], mesh.halfedges);
    let hull: Vec<[u32; 2]> = device.read(&aliases.hull);
    let counters = read_counters(&device.kernels.gpu, &device.buffers.control);
    let hull: BTreeSet<[u32; 2]> = hull[..counters.hull as usize].iter().copied().collect();
    assert_eq!(hull, mesh.hull.into_iter().collect());
}

#[test]
fn kernels_agree_with_their_references() {
    compare(Width::Narrow, Pick::Circumcenter);
    compare(Width::Wide, Pick::Centroid);
    compare(Width::Narrow, Pick::Random);
}
