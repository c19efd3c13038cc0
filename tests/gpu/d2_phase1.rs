//! Phase 1 in 2D on the GPU: a valid triangulation after every round, and the answer that of the
//! references.

use crate::states::{download, read};
use std::{collections::HashSet, time::Duration};

use gdel::internals::Options;
use gdel::internals::d2::gpu::vertex;
use gdel::internals::gpu::host::{Fit, Here, Host};
use gdel::internals::gpu::layout::Pick;
use gdel::internals::gpu::phase1::{Begin, Budget, MemorySettings, Phase1, Phase1Run, Settings};
use gdel::internals::gpu::{AdapterChoice, Gpu};
use gdel::internals::input::lattice::{Lattice, Width};
use gdel::internals::{dimension::Dimension, gpu::dim::Dim};
use gdel_reference::d2::{mesh_compact, mesh_mark, predicates::Vertex};
use pollster::block_on;

type State = gdel_reference::State<2>;

/// The buffers of a run, as the references have them.
fn state_of(gpu: &Gpu, width: Width, run: &Phase1Run<'_, 2>) -> State {
    let (params, counters) = run.control();
    let b = run.buffers();
    let pairs = read(gpu, &b.points.pairs);
    let indices = pairs.iter().map(|&[_, point]| point).chain([params.infinite]);
    let words = read(gpu, &b.points.vertices);
    let points = words.chunks(Dimension::<2>::vertex_words(width)).zip(indices);
    let points = points.map(|(words, index)| Vertex { position: vertex::position(words), index }).collect();
    let merged = pairs.iter().map(|&[key, _]| key == u32::MAX).collect();
    download(gpu, b, &State { params, counters, merged, ..State::new(width, points, 0, 0) })
}

fn run_and_validate(gpu: &Gpu, kernels: &mut [Phase1<2>; 2], name: &str, points: &[[f64; 2]], settings: Settings<2>) {
    let lattice = Lattice::<2>::fit(points.into());
    let width = lattice.width();
    let kernels = &mut kernels[usize::from(width == Width::Wide)];
    let options = Options::default();
    let mut host = Here::new(points.into(), &options, Default::default());
    let begin = Begin::of(block_on(host.ask(Fit::default())).unwrap());
    let mut run = block_on(Phase1Run::new(kernels, gpu, &mut host, begin, settings, None)).unwrap();
    let mut more = true;
    while more {
        more = block_on(run.advance()).unwrap();
        // Where batches overlap, the device is ahead of what was read.
        if settings.batches == 1 || !more {
            state_of(gpu, width, &run).validate();
        }
    }
    let state = state_of(gpu, width, &run);
    state.validate_end();
    let output = block_on(run.finish()).unwrap();

    let distinct: HashSet<[u64; 2]> = points.iter().map(|p| p.map(|x| (x + 0.0).to_bits())).collect();
    assert_eq!(output.merged.len(), points.len() - distinct.len(), "{name}");
    for [p, q] in output.merged {
        assert_eq!(points[p as usize], points[q as usize]);
        assert!(p > q);
    }
    assert_eq!(output.result.uncertain, Some(vec![]), "{name}: nothing was rounded");
    let mut mesh = output.result.mesh;
    let marks = mesh_mark(&state);
    let numbers: Vec<u32> = marks.iter().scan(0, |sum, &m| Some(std::mem::replace(sum, *sum + m))).collect();
    let mut expected = mesh_compact(&state, &numbers);
    mesh.hull.sort_unstable();
    expected.hull.sort_unstable();
    assert_eq!(mesh, expected, "{name}");
    assert_eq!(mesh.triangles.len() + mesh.hull.len() + 2, 2 * distinct.len(), "{name}: Euler");
    assert!(
        output.stats.readbacks as u32 <= output.stats.rounds.len() as u32 + output.stats.counters.iterations / 64 + 10,
        "{name}: {} readbacks in {} rounds",
        output.stats.readbacks,
        output.stats.rounds.len()
    );
}

#[test]
fn every_round_is_valid() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = [Width::Narrow, Width::Wide].map(|width| block_on(Phase1::new(&gpu, width)).unwrap());
    let settings = Settings { rounds: 1, batches: 1, ..Settings::default() };
    for (name, points) in crate::d2_inputs::all() {
        // The factor makes too many bits for a narrow lattice, but not for `f64`.
        for factor in [1, 0x4000_0003] {
            let points: Vec<_> = points.iter().map(|q| q.map(|x| (x * factor) as f64)).collect();
            run_and_validate(&gpu, &mut kernels, name, &points, settings);
        }
        if points.len() > 400 {
            continue;
        }
        let points: Vec<_> = points.iter().map(|q| q.map(|x| x as f64)).collect();
        let unsorted = Settings { sort: false, pick: Pick::Random, ..settings };
        run_and_validate(&gpu, &mut kernels, name, &points, unsorted);
        let all = Settings { insert_all: true, pick: Pick::Centroid, ..settings };
        run_and_validate(&gpu, &mut kernels, name, &points, all);
        // Flips wait for room in the history, and nothing is lost.
        let memory = MemorySettings { history: 0, ..settings.memory };
        let narrow = Settings { memory, min_active: 100, ..settings };
        run_and_validate(&gpu, &mut kernels, name, &points, narrow);
        // A device that takes long gets its work in submissions of a few dispatches.
        let split = Settings { budget: Budget { submission: Duration::ZERO, ..settings.budget }, ..settings };
        run_and_validate(&gpu, &mut kernels, name, &points, split);
    }
}
