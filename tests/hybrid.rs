//! The engine `gpu` gives the same set of tetrahedra as the engine `cpu`.
#![cfg(feature = "gpu")]

use gdel::{
    Mesh3, Options, Points, cpu,
    generate::{Distribution, generate},
    gpu::{AdapterChoice, Gpu},
    hybrid::Hybrid,
    verify::verify3d,
};
use pollster::block_on;
use proptest::prelude::*;
use std::sync::{LazyLock, Mutex, PoisonError};

static HYBRID: LazyLock<Mutex<Hybrid>> = LazyLock::new(|| {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a Vulkan driver: scripts/setup.sh");
    Mutex::new(block_on(Hybrid::new(gpu)).expect("the kernels compile"))
});

fn triangulate(points: &[[f64; 3]]) -> Mesh3 {
    let mut hybrid = HYBRID.lock().unwrap_or_else(PoisonError::into_inner);
    block_on(hybrid.delaunay3d(points.into(), &Options::default())).expect("triangulates")
}

/// Both engines agree, and the GPU's did the work.
fn agree(points: &[[f64; 3]]) {
    let mesh = triangulate(points);
    assert_eq!(mesh.stats.fallback, None);
    assert_eq!(mesh.stats.engine, "gpu");
    same(points, &mesh);
}

fn same(points: &[[f64; 3]], mesh: &Mesh3) {
    let expected = cpu::delaunay3d(points.into(), &Options::default()).expect("triangulates");
    assert_eq!(mesh.dimension, expected.dimension);
    assert_eq!(mesh.duplicate_of, expected.duplicate_of);
    assert_eq!(mesh.canonical(), expected.canonical());
    let report = verify3d(Points::from(points), mesh).expect("verifies");
    assert!(report.passed(), "{report}");
}

#[test]
fn the_papers_distributions() {
    for distribution in Distribution::ALL {
        for n in [5, 30, 500, 3000] {
            println!("{} {n}", distribution.name());
            agree(&generate(distribution, n, 7));
        }
    }
}

#[test]
fn twenty_thousand_uniform_points() {
    agree(&generate(Distribution::Uniform, 20_000, 1));
}

#[test]
fn five_thousand_points_on_a_sphere_in_single_precision() {
    let points = generate(Distribution::Sphere, 5_000, 1);
    agree(&points.iter().map(|p| p.map(|x| f64::from(x as f32))).collect::<Vec<_>>());
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
        assert!(mesh.stats.fallback.is_some());
        same(&points, &mesh);
    }
}

/// Points a few units in the last place apart share a place of the lattice when others lie far away.
#[test]
fn points_that_share_a_place_of_the_lattice() {
    let mut points = generate(Distribution::Uniform, 300, 3);
    for k in 0..40 {
        let scale = 2f64.powi(-70 - k % 3);
        points.push([f64::from(k % 7) * scale, f64::from(k % 5) * scale, f64::from(k % 3) * scale]);
    }
    agree(&points);
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
