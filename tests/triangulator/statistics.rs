//! The statistics and the trace of a run are true.

use crate::{engine, open};
use gdel::{
    Mesh3, Outputs,
    internals::{
        Options,
        d3::{
            generate::{Distribution3, generate3d},
            mesh::FACETS,
        },
        gpu::phase1::Settings,
        predicates,
    },
    stats::Round,
};
use pollster::block_on;
use std::collections::{HashMap, HashSet};

/// Triangulates points of a thin sphere, all of them inserted before the first flip. Flips then
/// leave hundreds of facets that are not locally Delaunay, whatever the order in which a device
/// flips. Each round is a submission of its own.
fn triangulate_thin_sphere(options: &Options) -> (Vec<[f64; 3]>, Mesh3) {
    let points = generate3d(Distribution3::ThinSphere, 8_000, 5);
    let mut engine = engine();
    engine.set_settings(Settings { insert_all: true, rounds: 1, batches: 1, ..Settings::default() });
    let mesh = block_on(engine.triangulate((&points).into(), options));
    engine.set_settings(Settings::default());
    (points, mesh.expect("triangulates"))
}

#[test]
fn the_statistics_add_up() {
    let (_, mesh) = triangulate_thin_sphere(&Options::default());
    let (gpu, splay) = (mesh.stats.gpu.expect("the GPU worked"), mesh.stats.splay.expect("and splaying"));
    let sum = |of: fn(&Round) -> u32| gpu.rounds.iter().map(|round| u64::from(of(round))).sum::<u64>();
    assert_eq!(gpu.adapter, engine().gpu().adapter().name);
    assert_eq!(sum(|round| round.inserted), 8_000);
    assert_eq!(sum(|round| round.flips), gpu.flips_23 + gpu.flips_32);
    assert_eq!(sum(|round| round.iterations), gpu.flip_iterations);
    assert_eq!(gpu.rounds.last().map(|round| round.active), Some(0));
    assert!(gpu.rounds.iter().all(|round| !round.time.is_zero()));
    assert!(gpu.failed_vertices > 0 && gpu.not_locally_delaunay >= gpu.failed_vertices / 3);
    assert!(splay.failed >= gpu.failed_vertices as usize && splay.built >= splay.failed);
    assert!(gpu.dispatches > gpu.submits && gpu.readbacks > gpu.submits);
    assert!(gpu.exact_tests > 0 && gpu.bytes > 500 * 8_000);
    assert_eq!(mesh.stats.trace, None);
}

/// The next batch is submitted before the counters of the last one are read: the device waits only
/// for the host to ask for the mesh, and to receive it. The engine has had no run by which this one could be
/// planned: then how many rounds a run takes would matter.
#[test]
fn the_device_does_not_wait_between_rounds() {
    let points = generate3d(Distribution3::Uniform, 20_000, 1);
    let mesh = block_on(open().triangulate((&points).into(), &Options::default())).expect("triangulates");
    let gpu = mesh.stats.gpu.expect("the GPU worked");
    assert_eq!(gpu.stalls, 2, "{gpu:?}");
    assert!(gpu.readbacks > gpu.rounds.len() as u64);
}

/// The CPU triangulates points while the device orders all of them. The first simplex alone has to
/// do where a sample has duplicates.
#[test]
fn phase_1_starts_with_points_that_the_cpu_has_triangulated() {
    let points = generate3d(Distribution3::Uniform, 20_000, 1);
    let start_points = |points: &[[f64; 3]]| {
        let mesh = block_on(engine().triangulate(points.into(), &Options::default())).expect("triangulates");
        mesh.stats.gpu.expect("the GPU worked").start_points
    };
    assert!((90..=100).contains(&start_points(&points)));
    // None of these is a point of the lattice.
    let rounded: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| x / 3.0)).collect();
    assert!((90..=100).contains(&start_points(&rounded)));
    let twice: Vec<[f64; 3]> = points.iter().flat_map(|&p| [p; 200]).take(20_000).collect();
    assert_eq!(start_points(&twice), 4);
}

/// The kernel that does iterations of few tetrahedra in one workgroup may not be compiled yet in a
/// first run. Both ways make the same mesh.
#[test]
fn iterations_in_one_workgroup_make_the_same_mesh() {
    let points = generate3d(Distribution3::Uniform, 20_000, 1);
    let mut engine = engine();
    block_on(engine.finish_compiling()).expect("the kernels compile");
    let [none, some] = [0, Settings::<3>::default().few].map(|few| {
        engine.set_settings(Settings { few, ..Settings::default() });
        block_on(engine.triangulate((&points).into(), &Options::default())).expect("triangulates")
    });
    engine.set_settings(Settings::default());
    assert!(none.canonical() == some.canonical());
}

#[test]
fn every_submission_is_counted() {
    let (points, mesh) = triangulate_thin_sphere(&Options::default());
    let gpu = mesh.stats.gpu.expect("the GPU worked");
    // One for the points, one per round, one for the end, and three to read the mesh.
    assert_eq!(gpu.submits, 1 + gpu.rounds.len() as u64 + 1 + 3);

    let mut engine = engine();
    engine.set_settings(Settings { insert_all: true, rounds: 1, batches: 1, ..Settings::default() });
    let mesh = block_on(engine.triangulate_resident((&points).into(), &Options::default())).expect("triangulates");
    engine.set_settings(Settings::default());
    let (gpu, splay) = (mesh.stats().gpu.clone().expect("the GPU worked"), mesh.stats().splay.expect("and splaying"));
    // One for the points, one per round, one for the end, which gathers the first stars, one for
    // each of the other gathers, and one for the arrays with what splaying has changed.
    assert_eq!(gpu.submits, 1 + gpu.rounds.len() as u64 + splay.gathers as u64 + 1, "{gpu:?}, {splay:?}");
    assert!(splay.gathers > 0 && splay.gathered > splay.removed);
    // And three to read them.
    let read = mesh.read(Outputs::ALL).expect("reads").stats.gpu.expect("the GPU worked");
    assert_eq!(read.submits, gpu.submits + 3);
    let bytes = 16 * (2 * mesh.simplex_count() as u64) + 12 * mesh.hull_count() as u64;
    assert_eq!(read.bytes_read, gpu.bytes_read + bytes);
}

#[test]
fn the_trace_has_every_round_and_what_splaying_did() {
    let (points, mesh) = triangulate_thin_sphere(&Options { trace: true, ..Options::default() });
    let (trace, gpu) = (mesh.stats.trace.as_ref().expect("asked for"), mesh.stats.gpu.as_ref().expect("used"));
    assert_eq!(trace.rounds.len(), gpu.rounds.len());

    let mut inserted = 0;
    for (tetrahedra, round) in trace.rounds.iter().zip(&gpu.rounds) {
        let present: HashSet<u32> = tetrahedra.iter().flatten().copied().collect();
        inserted += round.inserted as usize;
        assert_eq!(present.len(), inserted);
    }

    // The facets of the last round, each with the tetrahedra at it.
    let last = &trace.rounds[trace.rounds.len() - 1];
    let sorted = |facet: [usize; 3], t: [u32; 4]| {
        let mut corners = facet.map(|k| t[k]);
        corners.sort_unstable();
        corners
    };
    let mut facets: HashMap<[u32; 3], Vec<([u32; 4], u32)>> = HashMap::new();
    for &t in last {
        for (k, facet) in FACETS.into_iter().enumerate() {
            facets.entry(sorted(facet, t)).or_default().push((t, t[k]));
        }
    }
    let point = |v: u32| points[v as usize];
    let expected: HashSet<[u32; 3]> = facets
        .into_iter()
        .filter(|(_, at)| match at[..] {
            [(t, _), (_, apex)] => {
                let [a, b, c, d] = t.map(point);
                predicates::insphere(a, b, c, d, point(apex)) > 0
            }
            _ => false,
        })
        .map(|(facet, _)| facet)
        .collect();
    let found: HashSet<[u32; 3]> =
        trace.not_locally_delaunay.iter().map(|&f| sorted([0, 1, 2], [f[0], f[1], f[2], 0])).collect();
    assert!(!found.is_empty() && found.len() == trace.not_locally_delaunay.len());
    assert_eq!(found, expected);

    let canonical = |tetrahedra: &[[u32; 4]]| gdel::internals::mesh::canonical(tetrahedra);
    let before: HashSet<[u32; 4]> = canonical(last).into_iter().collect();
    assert_eq!(trace.splayed.len(), mesh.tetrahedra.len());
    for (&t, &splayed) in mesh.tetrahedra.iter().zip(&trace.splayed) {
        assert_eq!(splayed, !before.contains(&canonical(&[t])[0]));
    }
    assert!(trace.splayed.contains(&true) && trace.splayed.contains(&false));
}
