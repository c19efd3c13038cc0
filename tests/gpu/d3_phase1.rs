//! Phase 1 on the GPU: a valid triangulation after every round, and every stage against the
//! references of its kernels.

use crate::states::{download, read};
use std::{collections::BTreeSet, time::Duration};

use crate::d3_inputs::{self as inputs, Input as Points};
use gdel::internals::d3::mesh::FACETS;
use gdel::internals::input::lattice::{Lattice, Width};
use gdel::internals::{
    Options,
    d3::gpu::vertex,
    gpu::{
        AdapterChoice, Gpu, Parts,
        host::{Fit, Here, Host},
        layout::{Counters, Pick},
        phase1::{Begin, Budget, MemorySettings, Phase1, Phase1Output, Phase1Run, Settings},
    },
};
use gdel::internals::{dimension::Dimension, gpu::dim::Dim};
use gdel_reference::d3::{self, predicates::Vertex};
use pollster::block_on;

type State = gdel_reference::State<3>;

/// The vertices of a buffer.
fn vertices(width: Width, words: &[i32]) -> Vec<Vertex> {
    words
        .chunks(Dimension::<3>::vertex_words(width))
        .map(|words| Vertex { position: vertex::position(words), index: words[3] as u32 })
        .collect()
}

/// The buffers of a run, as the references have them.
fn state_of(gpu: &Gpu, width: Width, run: &Phase1Run<'_, 3>) -> State {
    let (params, counters) = run.control();
    let b = run.buffers();
    let points = vertices(width, &read(gpu, &b.points.vertices));
    let merged = read(gpu, &b.points.pairs).into_iter().map(|[key, _]| key == u32::MAX).collect();
    download(gpu, b, &State { params, counters, merged, ..State::new(width, points, 0, 0) })
}

/// Begins a run. Returns the width of its coordinates, too.
fn begin<'a>(
    gpu: &'a Gpu,
    kernels: &'a mut [Phase1<3>; 2],
    points: &Points,
    settings: Settings<3>,
) -> (Width, Phase1Run<'a, 3>) {
    let lattice = Lattice::fit((&points.positions).into());
    let width = lattice.width();
    let kernels = &mut kernels[usize::from(width == Width::Wide)];
    let options = Options::default();
    let mut host = Here::new((&points.positions).into(), &options, Default::default());
    let begin = Begin::of(block_on(host.ask(Fit::default())).unwrap());
    (width, block_on(Phase1Run::new(kernels, gpu, &mut host, begin, settings, None)).unwrap())
}

/// Returns the counters of the run.
fn run_and_validate(gpu: &Gpu, kernels: &mut [Phase1<3>; 2], points: &Points, settings: Settings<3>) -> Counters {
    let count = points.positions.len();
    let (width, mut run) = begin(gpu, kernels, points, settings);
    let mut more = true;
    while more {
        more = block_on(run.advance()).unwrap();
        // Where batches overlap, the device is ahead of what was read.
        if settings.batches == 1 || !more {
            state_of(gpu, width, &run).validate();
        }
    }
    let state = state_of(gpu, width, &run);
    let Phase1Output { result: output, merged, stats } = block_on(run.finish()).unwrap();

    let index = |v: u32| if v as usize == count { v } else { state.points[v as usize].index };
    let mut marked = state.clone();
    d3::mark_failed(&mut marked);
    let mut failed: Vec<u32> = (0..).zip(&marked.own.failed).filter(|&(_, &f)| f != 0).map(|(v, _)| index(v)).collect();
    failed.sort_unstable();
    assert_eq!(output.failed, failed, "{}", points.name);
    assert_eq!(marked.validate_end(), stats.counters.not_locally_delaunay as usize, "{}", points.name);

    // The finite tetrahedra are in the order of their slots, and no infinite one is lost or turned
    // over.
    let infinite = count as u32;
    let used: Vec<[u32; 4]> = state.simplices.iter().copied().filter(|t| *t != [0; 4]).collect();
    let (ghosts, finite): (Vec<_>, Vec<_>) = used.iter().map(|t| t.map(index)).partition(|t| t.contains(&infinite));
    assert_eq!(output.tets[..output.finite], finite, "{}", points.name);
    let facet = |t: &[u32; 4]| {
        let k = t.iter().position(|&v| v == infinite).unwrap();
        let mut facet = FACETS[k].map(|i| t[i]);
        let lowest = (0..3).min_by_key(|&i| facet[i]).unwrap();
        facet.rotate_left(lowest);
        facet
    };
    let sorted = |mut facets: Vec<[u32; 3]>| {
        facets.sort_unstable();
        facets
    };
    assert!(output.tets[output.finite..].iter().all(|t| t[3] == infinite), "{}", points.name);
    let expected = sorted(ghosts.iter().map(facet).collect());
    assert_eq!(sorted(output.tets[output.finite..].iter().map(facet).collect()), expected, "{}", points.name);
    for (t, near) in output.neighbors.iter().enumerate() {
        for (k, across) in near.iter().enumerate() {
            let (u, face) = ((across >> 2) as usize, (across & 3) as usize);
            assert_eq!(output.neighbors[u][face], (4 * t + k) as u32);
            let shared: BTreeSet<u32> = FACETS[k].map(|i| output.tets[t][i]).into();
            assert_eq!(shared, FACETS[face].map(|i| output.tets[u][i]).into(), "{}", points.name);
        }
    }
    let is_merged: BTreeSet<u32> = merged.iter().map(|&[p, _]| p).collect();
    for (v, &t) in (0..).zip(&output.vertex_simplex) {
        assert_eq!(t == u32::MAX, is_merged.contains(&v), "{}: point {v}", points.name);
        assert!(t == u32::MAX || output.tets[t as usize].contains(&v));
    }
    // Where nothing is rounded, exactly the flat ones are uncertain.
    let flat = |t: &[u32; 4]| {
        let [a, b, c, d] = t.map(|v| points.positions[v as usize]);
        gdel::internals::predicates::orient3d(a, b, c, d) == 0
    };
    let flat: Vec<[u32; 2]> =
        (0..).zip(&output.tets[..output.finite]).filter(|(_, t)| flat(t)).map(|(t, _)| [t, 16]).collect();
    assert_eq!(output.uncertain, flat, "{}", points.name);
    assert_eq!(merged.len(), points.sharing, "{}", points.name);
    for [p, q] in merged {
        assert_eq!(points.positions[p as usize], points.positions[q as usize]);
        assert!(p > q);
    }
    // One for each batch of rounds, and a few at the end: of two arrays one for each of up to four parts.
    let batches = stats.rounds.len();
    let of_parts = if settings.memory.part_bytes.is_some() { 2 * 3 } else { 0 };
    assert!(
        stats.readbacks <= batches + 10 + of_parts,
        "{}: {} readbacks in {batches} rounds",
        points.name,
        stats.readbacks
    );
    let distinct: BTreeSet<[u32; 4]> = output.tets.iter().copied().collect();
    assert_eq!(distinct.len(), output.tets.len());
    stats.counters
}

fn kernels(gpu: &Gpu) -> [Phase1<3>; 2] {
    [Width::Narrow, Width::Wide].map(|width| {
        let kernels = block_on(Phase1::new(gpu, width)).unwrap();
        // How the flips are done must not depend on when a thread has compiled them.
        block_on(kernels.finish_compiling(gpu)).unwrap();
        kernels
    })
}

#[test]
fn every_round_is_valid() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = kernels(&gpu);
    let settings = Settings { rounds: 1, batches: 1, ..Settings::default() };
    for points in inputs::all(Width::Narrow).iter().chain(&inputs::all(Width::Wide)) {
        let counters = run_and_validate(&gpu, &mut kernels, points, settings);
        assert_eq!(counters.long_walks, 0, "{}", points.name);
    }
    let uniform = &inputs::all(Width::Narrow)[1];
    let some = Settings { min_active: 100, pick: Pick::Centroid, ..settings };
    run_and_validate(&gpu, &mut kernels, uniform, some);
    run_and_validate(&gpu, &mut kernels, uniform, Settings { insert_all: true, pick: Pick::Random, ..settings });
}

/// Facets that cannot be flipped are removed with those beside them, when nothing else is left to do. Then fewer vertices
/// fail. When all points are inserted before the first flip, hundreds of facets get stuck, whatever the order in which
/// a device flips.
#[test]
fn facets_that_cannot_be_flipped_are_removed() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = kernels(&gpu);
    let settings = Settings { insert_all: true, rounds: 1, batches: 1, ..Settings::default() };
    for points in [inputs::uniform(Width::Narrow, 10_000), inputs::sphere(Width::Wide, 10_000)] {
        let (width, mut run) = begin(&gpu, &mut kernels, &points, settings);
        let mut before = None;
        while block_on(run.advance()).unwrap() {
            if run.waiting() == 0 && run.active() == 0 && run.control().1.removals == 0 {
                let mut state = state_of(&gpu, width, &run);
                d3::mark_failed(&mut state);
                before = Some(state.own.failed.iter().sum::<u32>() as usize);
            }
        }
        state_of(&gpu, width, &run).validate();
        let Phase1Output { result, stats, .. } = block_on(run.finish()).unwrap();
        let before = before.expect("facets are removed after a round that leaves nothing active");
        println!("{}: {before} failed, then {}; {:?}", points.name, result.failed.len(), stats.counters);
        assert!(stats.counters.removals == 1 && stats.counters.removed > 0, "{}: {:?}", points.name, stats.counters);
        assert!(result.failed.len() < before, "{}: {before} failed, then {}", points.name, result.failed.len());
    }
}

/// Returns the same settings with far too few slots and a far too small history.
fn tight(settings: Settings<3>) -> Settings<3> {
    let memory = MemorySettings { points_per_tail_block: 1 << 20, history: 0, ..settings.memory };
    Settings { memory, ..settings }
}

/// Slots and history that are far too small: flips wait, buffers grow, and nothing is lost.
#[test]
fn small_buffers_grow() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let settings = tight(Settings::default());
    run_and_validate(&gpu, &mut kernels(&gpu), &inputs::two_lines(Width::Narrow, 300), settings);
}

/// Runs of one size share their buffers: nothing of a run may be left for the next.
#[test]
fn kept_buffers_do_not_matter() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = kernels(&gpu);
    let settings = Settings::default();
    for width in [Width::Narrow, Width::Wide] {
        for points in [inputs::two_lines(width, 80), inputs::uniform(width, 80), inputs::uniform(width, 80)] {
            run_and_validate(&gpu, &mut kernels, &points, settings);
        }
    }
}

/// Rounds that are submitted together, and ahead of what is known of the last ones: nothing is
/// lost, also where slots and history run out meanwhile.
#[test]
fn batches_overlap() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = kernels(&gpu);
    for points in [inputs::two_lines(Width::Narrow, 200), inputs::uniform(Width::Wide, 2000)] {
        for (rounds, batches) in [(1, 2), (3, 2), (8, 3)] {
            let settings = Settings { rounds, batches, ..Settings::default() };
            run_and_validate(&gpu, &mut kernels, &points, settings);
            run_and_validate(&gpu, &mut kernels, &points, tight(settings));
        }
    }
}

/// A device that takes long gets its work in submissions of a few dispatches.
#[test]
fn submissions_are_split() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = kernels(&gpu);
    let default = Settings::default();
    let settings = Settings { budget: Budget { submission: Duration::ZERO, ..default.budget }, ..default };
    for points in [inputs::two_lines(Width::Narrow, 200), inputs::uniform(Width::Wide, 2000)] {
        run_and_validate(&gpu, &mut kernels, &points, settings);
        run_and_validate(&gpu, &mut kernels, &points, tight(settings));
    }
}

/// Flip iterations with a dispatch per pass, and in one workgroup.
#[test]
fn few_flips_are_done_in_one_workgroup() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = kernels(&gpu);
    for points in [inputs::two_lines(Width::Narrow, 100), inputs::uniform(Width::Wide, 1000)] {
        for few in [0, 1, 50, 1 << 20] {
            let settings = Settings { few, rounds: 1, batches: 1, ..Settings::default() };
            run_and_validate(&gpu, &mut kernels, &points, settings);
        }
    }
}

/// The kernel that does them in one workgroup takes longer to compile than all others, so that a
/// first run may have to do without.
#[test]
fn a_first_run_does_without_the_kernel_that_takes_longest_to_compile() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = [Width::Narrow, Width::Wide].map(|width| block_on(Phase1::of_first_run(&gpu, width)).unwrap());
    for points in [inputs::two_lines(Width::Narrow, 100), inputs::uniform(Width::Wide, 1000)] {
        let first = run_and_validate(&gpu, &mut kernels, &points, Settings::default());
        assert!(first.iterations > 0 && first.few_done == 0, "{first:?}");
    }
    kernels.iter().for_each(|kernels| block_on(kernels.finish_compiling(&gpu)).unwrap());
    for points in [inputs::two_lines(Width::Narrow, 100), inputs::uniform(Width::Wide, 1000)] {
        let second = run_and_validate(&gpu, &mut kernels, &points, Settings::default());
        assert!(second.few_done > 0, "{second:?}");
    }
}

/// Arrays that are larger than one binding are in parts, here of a few blocks of slots: accesses go
/// across their borders, the history ends with them, and buffers grow by parts.
#[test]
fn arrays_in_parts() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let settings = Settings { rounds: 1, batches: 1, ..Settings::default() };
    for (points, settings, blocks_per_part) in [
        (inputs::uniform(Width::Narrow, 1000), settings, 400),
        (inputs::uniform(Width::Wide, 1000), Settings { batches: 2, ..settings }, 300),
        (inputs::two_lines(Width::Narrow, 100), tight(Settings::default()), 130),
    ] {
        let bytes = 8 * 16 * blocks_per_part;
        let parts = Parts::with_bytes(&gpu.device().limits(), bytes).expect("lavapipe binds 32 buffers");
        let memory = MemorySettings { part_bytes: Some(bytes), ..settings.memory };
        let settings = Settings { memory, ..settings };
        let mut kernels = [Width::Narrow, Width::Wide]
            .map(|width| block_on(Phase1::in_parts(&gpu, width, Some(parts))).expect("they compile"));
        let counters = run_and_validate(&gpu, &mut kernels, &points, settings);
        assert_eq!(counters.few_done, 0, "{counters:?}");
    }
}

/// In a needle of few lattice points, the device sees some points in no simplex of a large start:
/// the run begins anew with the first simplex alone.
#[test]
fn points_in_no_simplex_of_the_start_are_inserted() {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("lavapipe or a GPU");
    let mut kernels = kernels(&gpu);
    let settings = Settings { start_points: Some(5000), ..Settings::default() };
    let points = inputs::needle(6000);
    let counters = run_and_validate(&gpu, &mut kernels, &points, settings);
    assert!(counters.long_walks > 0);
}
