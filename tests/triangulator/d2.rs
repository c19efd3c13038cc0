//! In 2D, the backend `gpu` gives the same set of triangles as the backend `cpu`.

use crate::degenerate;
use gdel::{
    Backend, DeviceMesh2, Mesh2, NONE, Outputs, Points2,
    internals::{
        Options,
        cpu::delaunay_in_order,
        d2::generate::{Distribution2, generate2d},
        gpu::{
            AdapterChoice, Gpu,
            engine::GpuEngine,
            layout::Pick,
            phase1::{Budget, MemorySettings, Settings},
        },
        input::order::Order,
    },
    stats::{Fallback, Phase},
};
use pollster::block_on;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// The engine that the tests of 2D share.
static ENGINE: LazyLock<Mutex<GpuEngine<2>>> = LazyLock::new(|| {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a Vulkan driver: scripts/setup.sh");
    Mutex::new(block_on(GpuEngine::new(gpu)).expect("the kernels compile"))
});

/// The engine that the tests share.
pub fn engine() -> MutexGuard<'static, GpuEngine<2>> {
    ENGINE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn triangulate(points: Points2<'_>, settings: &Settings<2>) -> Mesh2 {
    let mut engine = engine();
    engine.set_settings(*settings);
    block_on(engine.triangulate(points, &Options::default())).expect("triangulates")
}

pub fn same(points: Points2<'_>, mesh: &Mesh2) {
    let expected = delaunay_in_order::<2>(points, &Options::default(), Order::default()).expect("triangulates");
    assert_eq!(mesh.dimension, expected.dimension);
    assert_eq!(mesh.duplicate_of, expected.duplicate_of);
    assert_eq!(mesh.canonical(), expected.canonical());
    assert_eq!(mesh.hull, expected.hull);
    let (halfedges, from) = (mesh.halfedges.as_flattened(), mesh.triangles.as_flattened());
    let to = |e: usize| from[e / 3 * 3 + (e + 1) % 3];
    assert_eq!(halfedges.iter().filter(|&&e| e == NONE).count(), if mesh.dimension == 2 { mesh.hull.len() } else { 0 });
    for (e, &against) in halfedges.iter().enumerate().filter(|&(_, &against)| against != NONE) {
        assert_eq!(halfedges[against as usize], e as u32);
        assert_eq!([from[e], to(e)], [to(against as usize), from[against as usize]]);
    }
}

/// Both engines agree, and the GPU's did the work.
fn agree(name: &str, points: Points2<'_>) {
    println!("{name}");
    let mesh = triangulate(points, &Settings::default());
    assert_eq!(mesh.stats.fallback, None, "{name}");
    assert_eq!(mesh.stats.backend, Backend::Gpu);
    same(points, &mesh);
    // The same where the device makes the arrays.
    let resident = resident(points);
    assert_eq!(resident.stats().fallback, None, "{name}");
    same(points, &resident.read(Outputs::ALL).expect("reads"));
}

fn resident(points: Points2<'_>) -> DeviceMesh2 {
    let mut engine = engine();
    engine.set_settings(Settings::default());
    block_on(engine.triangulate_resident(points, &Options::default())).expect("triangulates")
}

fn random(n: usize, seed: u64, point: impl Fn(&mut Pcg64Mcg) -> [f64; 2]) -> Vec<[f64; 2]> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    (0..n).map(|_| point(&mut rng)).collect()
}

fn uniform(n: usize, seed: u64) -> Vec<[f64; 2]> {
    random(n, seed, |rng| std::array::from_fn(|_| rng.random()))
}

/// Box and Muller.
fn gaussian(rng: &mut Pcg64Mcg) -> [f64; 2] {
    let (radius, angle) =
        ((-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt(), std::f64::consts::TAU * rng.random::<f64>());
    [radius * angle.cos(), radius * angle.sin()]
}

/// At a distance of 1 and up to `thickness` more from the origin.
fn ring(rng: &mut Pcg64Mcg, thickness: f64) -> [f64; 2] {
    let (radius, angle) = (1.0 + thickness * rng.random::<f64>(), std::f64::consts::TAU * rng.random::<f64>());
    [radius * angle.cos(), radius * angle.sin()]
}

fn grid(columns: usize, rows: usize) -> Vec<[f64; 2]> {
    (0..columns * rows).map(|i| [(i % columns) as f64, (i / columns) as f64]).collect()
}

#[test]
fn the_same_triangles_on_all_kinds_of_input() {
    for n in [3, 4, 5, 30, 500] {
        agree("few", (&uniform(n, n as u64)).into());
    }
    agree("uniform", (&uniform(10_000, 1)).into());
    let single: Vec<[f32; 2]> = uniform(2_000, 2).iter().map(|p| p.map(|x| x as f32)).collect();
    agree("uniform, single precision", (&single).into());
    agree("gaussian", (&random(5_000, 3, gaussian)).into());
    agree("grid", (&grid(100, 100)).into());
    agree("ribbon", (&grid(500, 2)).into());
    agree("circle", (&random(1_000, 4, |rng| ring(rng, 0.0))).into());
    let on_circle: Vec<[f32; 2]> = random(1_000, 5, |rng| ring(rng, 0.0)).iter().map(|p| p.map(|x| x as f32)).collect();
    agree("circle, single precision", (&on_circle).into());
    agree("thin circle", (&random(5_000, 6, |rng| ring(rng, 1e-3))).into());
    let two_lines: Vec<_> = (0..600).map(|i| [f64::from(i / 2), f64::from(i % 2) * 500.0]).collect();
    agree("two lines", (&two_lines).into());
    let clusters = random(3_000, 7, |rng| {
        let centre = [rng.random_range(0..5), rng.random_range(0..5)].map(f64::from);
        let [x, y] = gaussian(rng);
        [centre[0] + 1e-4 * x, centre[1] + 1e-4 * y]
    });
    agree("clusters", (&clusters).into());
    let utm = random(3_000, 8, |rng| {
        let [x, y] = [rng.random_range(0..200_000), rng.random_range(0..200_000)].map(f64::from);
        [(45_000_000.0 + x) / 100.0, (548_000_000.0 + y) / 100.0]
    });
    agree("offsets", (&utm).into());
    let mut duplicates = uniform(2_100, 9);
    duplicates.extend(duplicates.clone().into_iter().take(900));
    agree("duplicates", (&duplicates).into());
}

/// Returns settings under which a run may take so many flip iterations, and one more for so many flips.
fn with_budget(spare_iterations: u32, flips_per_iteration: u32) -> Settings<2> {
    let default = Settings::default();
    let budget = Budget { spare_iterations, flips_per_iteration, ..default.budget };
    Settings { budget, ..default }
}

#[test]
fn settings_do_not_change_the_answer() {
    let points = random(2_000, 10, |rng| ring(rng, 1e-2));
    // Most of these take more flip iterations than the default settings.
    let default = with_budget(u32::MAX, 256);
    for settings in [
        Settings { insert_all: true, ..default },
        Settings { sort: false, ..default },
        Settings { pick: Pick::Centroid, min_active: 0, ..default },
        Settings { pick: Pick::Random, memory: MemorySettings { history: 0, ..default.memory }, ..default },
    ] {
        let mesh = triangulate((&points).into(), &settings);
        assert_eq!(mesh.stats.fallback, None);
        same((&points).into(), &mesh);
    }
}

#[test]
fn fewer_than_two_dimensions_are_left_to_the_cpu() {
    for points in [vec![], vec![[1.0; 2]; 3], vec![[0.0; 2], [1.0; 2], [2.0; 2]]] {
        let mesh = triangulate((&points).into(), &Settings::default());
        assert!(mesh.stats.fallback.is_some());
        same((&points).into(), &mesh);
    }
}

/// Points a few units in the last place apart share a place of the lattice when others lie far
/// away; those a little farther apart are rounded, and the exact flips decide.
#[test]
fn points_that_the_lattice_does_not_tell_apart() {
    let mut points = uniform(300, 3);
    for k in 0..40 {
        let scale = 2f64.powi(-70 - k % 3);
        points.push([f64::from(k % 7) * scale, f64::from(k % 5) * scale]);
    }
    agree("shared places", (&points).into());
    let mut rng = Pcg64Mcg::seed_from_u64(11);
    points.extend((0..500).map(|_| -> [f64; 2] { std::array::from_fn(|_| 0.5 + rng.random::<f64>() * 1e-14) }));
    agree("few steps of the lattice", (&points).into());
}

/// Some coordinates of Gaussian points and of points on a circle are rounded to the lattice. What
/// that leaves open is looked at by itself, and none of it changes the triangulation.
#[test]
fn few_signs_are_open_where_few_points_are_rounded() {
    for (name, points) in [
        ("gaussian", random(20_000, 12, gaussian)),
        ("thin circle", random(20_000, 13, |rng| ring(rng, 1e-2))),
        ("circle", random(5_000, 14, |rng| ring(rng, 0.0))),
        ("clusters", generate2d(Distribution2::Clusters, 20_000, 15)),
    ] {
        let mesh = triangulate((&points).into(), &Settings::default());
        same((&points).into(), &mesh);
        assert_eq!(mesh.stats.fallback, None, "{name}");
        assert!(mesh.stats.phases.iter().all(|&(phase, _)| phase != Phase::Flip), "{name}: {:?}", mesh.stats.phases);
        let exact = mesh.stats.exact.expansion;
        println!("{name}: {exact} signs by expansions");
        assert!(exact < points.len() as u64 / 20, "{name}: {exact} signs by expansions");
    }
}

/// Points some steps of the lattice apart, all of them rounded, with others far away: the lattice's
/// triangulation is wrong in many places, and flips and insertions mend it.
#[test]
fn what_rounding_made_wrong_is_mended() {
    let mut rng = Pcg64Mcg::seed_from_u64(16);
    for (count, size) in [(40, 50), (300, 58), (300, 60)] {
        let mut points = uniform(500, count);
        points.push([0.999; 2]);
        // The lattice has steps of about 2⁻⁶².
        points.extend((0..count).map(|_| -> [f64; 2] { [0; 2].map(|_| rng.random::<f64>() * 2f64.powi(-size)) }));
        let mesh = triangulate((&points).into(), &Settings::default());
        same((&points).into(), &mesh);
        let flips = mesh.stats.phases.iter().any(|&(phase, _)| phase == Phase::Flip);
        println!("{count} points of size 2^-{size}: flips {flips}, fallback {:?}", mesh.stats.fallback);
        assert!(flips || mesh.stats.fallback.is_some() || size < 60);
    }
}

/// Two lines have thousands of points on each edge of the hull, and two fans of triangles between
/// them: no flips wait for each other.
#[test]
fn two_lines_take_few_flip_iterations() {
    for n in [4_000, 60_000] {
        agree("two lines", (&generate2d(Distribution2::TwoLines, n, 1)).into());
    }
}

#[test]
fn flips_that_wait_for_each_other_are_left_to_the_cpu() {
    let points = uniform(3_000, 1);
    // A run may take what its flips have earned.
    let settings = with_budget(4, 100_000);
    let mesh = triangulate((&points).into(), &settings);
    assert_eq!(mesh.stats.fallback, Some(Fallback::Flips));
    same((&points).into(), &mesh);
}

#[test]
fn every_submission_is_counted() {
    let points = generate2d(Distribution2::Uniform, 1_000, 1);
    // No other test comes between these runs.
    let mut engine = engine();
    let mut run = |points: &[[f64; 2]], settings: Settings<2>| {
        engine.set_settings(settings);
        let mesh = block_on(engine.triangulate(points.into(), &Options::default())).expect("triangulates");
        mesh.stats.gpu.expect("the GPU worked")
    };
    let gpu = run(&points, Settings { rounds: 1, batches: 1, ..Settings::default() });
    // One for the points, one per round, one for the end, and three to read the mesh.
    assert_eq!(gpu.submits, 1 + gpu.rounds.len() as u64 + 1 + 3);
    // The round that is submitted ahead of the last one's counters has nothing to do.
    run(&points[..900], Settings::default());
    let gpu = run(&points, Settings::default());
    assert_eq!(gpu.submits, 1 + gpu.rounds.len() as u64 + 1 + 1 + 3);
    // If the run before had as many points, none is submitted beyond the round that it ended with. This run
    // may end with another one.
    let gpu = run(&points, Settings::default());
    assert!((0..=1).contains(&(gpu.submits - (1 + gpu.rounds.len() as u64 + 1 + 3))), "{gpu:?}");
}

#[test]
fn random_degenerate_points() {
    for seed in degenerate::cases(40) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let points = degenerate::points(random, 300);
        println!("seed {seed}: {} points", points.len());
        same((&points).into(), &triangulate((&points).into(), &Settings::default()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn small_grids(side in 2u32..9, places in prop::collection::vec(0u32..64, 3..80)) {
        let points: Vec<_> = places.iter().map(|&k| [k % side, k / side % side].map(f64::from)).collect();
        same((&points).into(), &triangulate((&points).into(), &Settings::default()));
    }

    #[test]
    fn mixed_scales(points in prop::collection::vec(prop::array::uniform2((-4i32..5, -90i32..2).prop_map(|(m, e)| f64::from(m) * 2f64.powi(e))), 3..60)) {
        same((&points).into(), &triangulate((&points).into(), &Settings::default()));
    }
}
