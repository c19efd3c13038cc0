//! The GPU engine on the inputs that make other codes fail.

use crate::{agree, clouds, degenerate, motions, open, same, triangulate};
use gdel::{
    Backend, Error, Outputs,
    internals::{
        Options,
        d3::generate::{Distribution3, generate3d},
        gpu::phase1::{MemorySettings, Settings, WayToHost},
    },
    stats::Fallback,
};
use pollster::block_on;
use proptest::prelude::*;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

#[test]
fn the_papers_distributions() {
    for distribution in Distribution3::ALL {
        for n in [5, 30, 500, 3000] {
            println!("{} {n}", distribution.name());
            agree(&generate3d(distribution, n, 7));
        }
    }
}

#[test]
fn twenty_thousand_uniform_points() {
    agree(&generate3d(Distribution3::Uniform, 20_000, 1));
}

#[test]
fn five_thousand_points_on_a_sphere_in_single_precision() {
    let points = generate3d(Distribution3::Sphere, 5_000, 1);
    agree(&points.iter().map(|p| p.map(|x| x as f32)).collect::<Vec<_>>());
}

/// Arrays that are larger than one binding are in parts: here of 60,000 slots.
#[test]
fn arrays_in_parts() {
    let mut engine = open();
    let options = Options::default();
    let of_slots = |slots: u64| {
        let default = Settings::default();
        let memory = MemorySettings { part_bytes: Some(slots * 16), ..default.memory };
        Settings { memory, ..default }
    };
    let uniform = generate3d(Distribution3::Uniform, 20_000, 3);
    for points in [&uniform, &generate3d(Distribution3::Sphere, 3_000, 1), &clouds::shuffled(&clouds::grid(20), 1)] {
        for way_to_host in [None, Some(WayToHost::MadeOnDevice)] {
            engine.set_settings(Settings { way_to_host, ..of_slots(60_000) });
            let mesh = block_on(engine.triangulate(points.into(), &options)).expect("triangulates");
            assert_eq!(mesh.stats.fallback, None);
            same(points, &mesh);
        }
    }

    // A mesh that follows its points.
    let moved = motions::displaced(20_000, 0.002);
    let mesh = block_on(engine.triangulate_resident((&moved[0]).into(), &options)).expect("triangulates");
    let mesh = block_on(engine.update_resident(&mesh, (&moved[1]).into(), &options)).expect("updates");
    assert_eq!(mesh.stats().update.map(|update| update.restarted), Some(None));
    same(&moved[1], &mesh.read(Outputs::ALL).expect("reads"));

    // Four parts are too few.
    engine.set_settings(of_slots(40_000));
    let error = block_on(engine.triangulate((&uniform).into(), &options)).expect_err("it does not fit");
    assert!(matches!(error, Error::BufferTooLarge { points: Some(18_000..20_000), .. }), "{error}");
    engine.set_settings(Settings::default());
    same(&uniform, &block_on(engine.triangulate((&uniform).into(), &options)).expect("triangulates"));
}

#[test]
fn fewer_than_three_dimensions_are_left_to_the_cpu() {
    for points in [
        vec![],
        vec![[1.0; 3]; 3],
        vec![[0.0; 3], [1.0; 3], [2.0; 3]],
        vec![[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
    ] {
        let mesh = triangulate(&points);
        assert_eq!(mesh.stats.fallback, Some(Fallback::Coplanar));
        same(&points, &mesh);
    }
}

/// Points a few units in the last place apart share a place of the lattice when others lie far
/// away.
#[test]
fn points_that_share_a_place_of_the_lattice() {
    let mut points = generate3d(Distribution3::Uniform, 300, 3);
    for k in 0..40 {
        let scale = 2f64.powi(-70 - k % 3);
        points.push([f64::from(k % 7) * scale, f64::from(k % 5) * scale, f64::from(k % 3) * scale]);
    }
    agree(&points);
}

#[test]
fn what_makes_other_codes_fail() {
    let inputs = [
        ("grid 8", clouds::grid(8)),
        ("grid 12, shuffled", clouds::shuffled(&clouds::grid(12), 1)),
        ("grid 64 with duplicates", clouds::grid_64_with_duplicates(5_000)),
        ("two skew lines", clouds::two_skew_lines(60)),
        ("circle and its axis", clouds::circle_and_its_axis(60)),
        ("circle of integers and its axis", clouds::circle_of_integers_and_its_axis()),
        ("clusters", clouds::clusters_at_1e_9_spacing(2_000)),
        ("grids, far apart", clouds::grids_at_1e_9_spacing(6)),
        ("offset by 1e7", clouds::survey(3_000)),
        ("flat ground", clouds::flat_ground(1_000)),
        ("30 % duplicates", clouds::thirty_percent_duplicates(300)),
    ];
    for (name, points) in inputs {
        println!("{name}");
        agree(&points);
    }
}

#[test]
fn the_bunny() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/bunny.ply");
    let cloud = gdel_io::files::read_points(std::path::Path::new(path)).expect("the bunny");
    agree(&cloud);
}

/// Points of small grids, of lines, of planes and of spheres, some of them several times.
fn small(rng: &mut impl Rng) -> Vec<[f64; 3]> {
    let n = rng.random_range(4..=200);
    let kind = rng.random_range(0..5);
    let side = rng.random_range(2..=5);
    let mut points: Vec<[f64; 3]> = (0..n)
        .map(|_| {
            let [i, j, k]: [i32; 3] = std::array::from_fn(|_| rng.random_range(0..side));
            match kind {
                0 => [i, j, k],
                // Up to four parallel and skew lines.
                1 => [[50 * i + j, 0, 0], [0, 50 * j + k, 10], [7 * k, 7 * k, 5 * k], [0, 0, i]][k as usize % 4],
                // Up to three planes.
                2 => [[i * 9 + j, j * 7 + k, 0], [i, i + 5 * j, 1 + i], [j, k, 2 * j + 3 * k]][i as usize % 3],
                // On the sphere of radius 9, and its centre.
                3 => {
                    let [a, b, c] = [[0, 0, 9], [1, 4, 8], [4, 4, 7], [3, 6, 6], [0, 0, 0]][i as usize];
                    let sign = |bit: u32| if rng.random_bool(0.5) { 1 << bit } else { -(1 << bit) };
                    let [s, t, u] = [0; 3].map(sign);
                    [[a * s, b * t, c * u], [b * s, c * t, a * u], [c * s, a * t, b * u]][j as usize % 3]
                }
                _ => std::array::from_fn(|_| rng.random_range(-1_000_000..1_000_000)),
            }
            .map(f64::from)
        })
        .collect();
    for _ in 0..rng.random_range(0..=n / 4) {
        points.push(points[rng.random_range(0..points.len())]);
    }
    points
}

#[test]
fn two_hundred_small_inputs() {
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let mut flat = 0;
    for _ in 0..200 {
        let points = small(&mut rng);
        let mesh = triangulate(&points);
        // Nothing but flat input is left to the CPU engine.
        let expected = (mesh.dimension < 3).then_some(Fallback::Coplanar);
        assert_eq!(mesh.stats.fallback, expected, "{points:?}");
        flat += usize::from(expected.is_some());
        same(&points, &mesh);
    }
    assert!(flat < 20, "{flat} inputs were flat");
}

/// Half a million points on a sphere, as computed and rounded to single precision.
#[test]
#[ignore = "takes minutes on a software adapter"]
fn five_hundred_thousand_points_on_a_sphere() {
    let points = generate3d(Distribution3::Sphere, 500_000, 1);
    agree(&points);
    agree(&points.iter().map(|p| p.map(|x| x as f32)).collect::<Vec<_>>());
}

#[test]
#[ignore = "needs scripts/fetch-dragon.sh, and minutes on a software adapter"]
fn the_dragon() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/.cache/dragon.ply");
    let cloud = gdel_io::files::read_points(std::path::Path::new(path)).expect("run scripts/fetch-dragon.sh");
    agree(&cloud);
}

#[test]
fn random_degenerate_points() {
    for seed in degenerate::cases(40) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let points = degenerate::points(random, 300);
        println!("seed {seed}: {} points", points.len());
        same(&points, &triangulate(&points));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(30))]

    #[test]
    fn small_grids(side in 2u32..6, places in prop::collection::vec(0u32..125, 5..120)) {
        let points: Vec<_> = places.iter().map(|&k| {
            let k = k % (side * side * side);
            [k % side, k / side % side, k / side / side].map(f64::from)
        }).collect();
        same(&points, &triangulate(&points));
    }

    #[test]
    fn mixed_scales(points in prop::collection::vec(prop::array::uniform3((-4i32..5, -60i32..2).prop_map(|(m, e)| f64::from(m) * 2f64.powi(e))), 5..60)) {
        same(&points, &triangulate(&points));
    }
}

/// In browsers, the first narrow input does not wait for kernels.
#[test]
fn the_wide_kernels_serve_until_the_narrow_ones_are_compiled() {
    let mut engine = crate::open();
    engine.compile_meanwhile();
    let grid = clouds::grid(12);
    // Half of the points twice, and far from the origin.
    let shifted: Vec<[f64; 3]> = grid.iter().chain(&grid[..864]).map(|p| p.map(|x| x + 4_000_000.0)).collect();
    let mut exact_tests_of = |points: &Vec<[f64; 3]>| {
        let mesh = block_on(engine.triangulate(points.into(), &Options::default())).expect("triangulates");
        assert_eq!((mesh.stats.backend, &mesh.stats.fallback), (Backend::Gpu, &None));
        same(points, &mesh);
        mesh.stats.gpu.expect("the GPU made it").exact_tests
    };
    let wide = exact_tests_of(&grid);
    exact_tests_of(&shifted);
    // Where all points are of a grid, the wide arithmetic has more steps: the first run had it. Some later one has not,
    // as soon as the kernels are compiled.
    assert!((0..1000).any(|_| exact_tests_of(&grid) != wide));
}
