//! Phase 1 on the GPU: a valid triangulation after every round, and every stage against the twins of its kernels.
#![cfg(feature = "gpu")]

mod common;

use common::phase1::{self as inputs, Input as Points};
use gdel::gpu::layout::{Active, Counters, FlipNode, Status, Waiting};
use gdel::gpu::phase1::{Input, Phase1, Run, Settings};
use gdel::gpu::start::first_tetrahedron;
use gdel::gpu::twin::{State, predicates::Vertex};
use gdel::gpu::{AdapterChoice, Gpu, Readback, Storage, vertex};
use gdel::lattice::Width;
use pollster::block_on;

fn read<T: bytemuck::Pod>(gpu: &Gpu, storage: &Storage<T>) -> Vec<T> {
    block_on(Readback::default().read(gpu, storage, 0, storage.len())).unwrap()
}

/// The vertices of a buffer.
fn vertices(width: Width, words: &[[i32; 4]]) -> Vec<Vertex> {
    words
        .chunks(vertex::stride(width))
        .map(|words| Vertex {
            position: std::array::from_fn(|axis| match words {
                [high, low] => i64::from(high[axis]) << 31 | i64::from(low[axis]),
                _ => i64::from(words[0][axis]),
            }),
            index: words[0][3] as u32,
        })
        .collect()
}

/// The buffers of a run, as the twins have them.
fn state_of(gpu: &Gpu, width: Width, run: &Run<'_>) -> State {
    let b = run.buffers();
    let (params, counters) = run.control();
    let active: Vec<Active> = read(gpu, &b.active);
    let (even, odd) = active.split_at(active.len() / 2);
    let mut waiting: Vec<Waiting> = read(gpu, &b.waiting);
    waiting.truncate(params.entries as usize);
    State {
        width,
        params,
        points: vertices(width, &read(gpu, &b.vertices)),
        same: read(gpu, &b.same),
        tets: read(gpu, &b.tets),
        neighbors: read(gpu, &b.neighbors),
        status: read::<Status>(gpu, &b.status),
        free: read(gpu, &b.free),
        messages: read(gpu, &b.messages),
        active: [even.to_vec(), odd.to_vec()],
        history: read::<FlipNode>(gpu, &b.history),
        waiting,
        scores: read(gpu, &b.scores),
        failed: read(gpu, &b.failed),
        counters,
    }
}

fn words(points: &Points) -> Vec<[i32; 4]> {
    let mut words = Vec::new();
    for (index, &q) in (0..).zip(&points.positions) {
        vertex::append_words(&mut words, points.width, q, index);
    }
    words
}

fn run_and_validate(gpu: &Gpu, kernels: &Phase1, points: &Points, settings: Settings) {
    let words = words(points);
    let count = points.positions.len();
    let start = first_tetrahedron(points.width, count, |i| points.positions[i]).expect("not coplanar");
    let input = Input { width: points.width, words: &words, start };
    let mut run = block_on(Run::new(kernels, gpu, input, settings, None)).unwrap();
    let mut more = true;
    while more {
        more = block_on(run.round()).unwrap();
        state_of(gpu, points.width, &run).validate();
    }
    let mut state = state_of(gpu, points.width, &run);
    let before: Counters = state.counters;
    let output = block_on(run.finish()).unwrap();

    gdel::gpu::twin::mark_failed(&mut state);
    let failed: Vec<u32> = (0..).zip(&state.failed).filter(|&(_, &f)| f != 0).map(|(v, _)| v).collect();
    assert_eq!(output.failed, failed, "{}", points.name);
    state.validate_end();

    let mut expected: Vec<[u32; 4]> = state.tets.iter().copied().filter(|t| *t != [0; 4]).collect();
    assert_eq!(output.tets, expected, "{}: the mesh keeps the order of the slots", points.name);
    for (t, near) in output.neighbors.iter().enumerate() {
        for (k, across) in near.iter().enumerate() {
            assert_eq!(output.neighbors[(across >> 2) as usize][(across & 3) as usize], (4 * t + k) as u32);
        }
    }
    let aside: Vec<u32> = output.set_aside.iter().map(|&[v, _]| v).collect();
    for (v, &t) in (0..).zip(&output.tet_of) {
        assert_eq!(t == u32::MAX, aside.contains(&v));
        assert!(t == u32::MAX || output.tets[t as usize].contains(&v));
    }
    assert_eq!(aside.len(), points.sharing, "{}", points.name);
    for [v, w] in output.set_aside {
        assert_eq!(state.points[v as usize].position, state.points[w as usize].position);
        assert!(state.points[v as usize].index > state.points[w as usize].index);
    }
    let mut order = output.order.clone();
    order.sort_unstable();
    assert!(order.into_iter().eq(0..count as u32));
    let limit = 2 * output.stats.rounds as usize + 10;
    assert!(
        output.stats.readbacks <= limit + before.iterations as usize / 64 + 4,
        "{}: {} readbacks in {} rounds",
        points.name,
        output.stats.readbacks,
        output.stats.rounds
    );
    expected.sort_unstable();
    expected.dedup();
    assert_eq!(expected.len(), output.tets.len());
}

#[test]
fn every_round_is_valid() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let settings = Settings { workgroups: 8, ..Settings::default() };
    for width in [Width::Narrow, Width::Wide] {
        let kernels = block_on(Phase1::new(&gpu, width)).unwrap();
        for points in inputs::all(width) {
            println!("{} {width:?} {}", points.name, points.positions.len());
            run_and_validate(&gpu, &kernels, &points, settings);
        }
    }
}

/// Slots and history that are far too small: flips wait, buffers grow, and nothing is lost.
#[test]
fn small_buffers_grow() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let kernels = block_on(Phase1::new(&gpu, Width::Narrow)).unwrap();
    let settings =
        Settings { workgroups: 8, points_per_tail_block: 1 << 20, history: 0, ..Settings::default() };
    run_and_validate(&gpu, &kernels, &inputs::two_lines(Width::Narrow, 300), settings);
}
