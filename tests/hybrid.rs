//! The engine `gpu` gives the same set of tetrahedra as the engine `cpu`.
#![cfg(feature = "gpu")]

use gdel::{
    Mesh3, Options, Points, cpu,
    generate::{Distribution, generate},
    gpu::{AdapterChoice, Gpu},
    hybrid::Hybrid,
    mesh::FACETS,
    predicates,
    stats::Round,
    verify::verify3d,
};
use pollster::block_on;
use proptest::prelude::*;
use std::{
    collections::{HashMap, HashSet},
    sync::LazyLock,
};

static HYBRID: LazyLock<Hybrid> = LazyLock::new(|| {
    let gpu = block_on(Gpu::open(&AdapterChoice::Default)).expect("the tests need a Vulkan driver: scripts/setup.sh");
    block_on(Hybrid::new(gpu)).expect("the kernels compile")
});

fn triangulate(points: &[[f64; 3]]) -> Mesh3 {
    block_on(HYBRID.delaunay3d(points.into(), &Options::default())).expect("triangulates")
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

#[test]
fn the_statistics_add_up() {
    let points = generate(Distribution::ThinSphere, 3_000, 5);
    let mesh = triangulate(&points);
    let (gpu, splay) = (mesh.stats.gpu.expect("the GPU worked"), mesh.stats.splay.expect("and splaying"));
    let sum = |of: fn(&Round) -> u32| gpu.rounds.iter().map(|round| u64::from(of(round))).sum::<u64>();
    assert_eq!(gpu.adapter, HYBRID.gpu().adapter().name);
    assert_eq!(sum(|round| round.inserted), 3_000);
    assert_eq!(sum(|round| round.flips), gpu.flips_23 + gpu.flips_32);
    assert_eq!(sum(|round| round.iterations), gpu.flip_iterations);
    assert_eq!(gpu.rounds.last().map(|round| round.active), Some(0));
    assert!(gpu.rounds.iter().all(|round| round.milliseconds > 0.0));
    assert!(gpu.failed_vertices > 0 && gpu.not_locally_delaunay >= gpu.failed_vertices / 3);
    assert!(splay.failed >= gpu.failed_vertices as usize && splay.built >= splay.failed);
    assert!(gpu.submits >= gpu.rounds.len() as u64 && gpu.dispatches > gpu.submits && gpu.readbacks > gpu.submits);
    assert!(gpu.exact_tests > 0 && gpu.bytes > 500 * 3_000);
    assert_eq!(mesh.stats.trace, None);
}

#[test]
fn the_trace_has_every_round_and_what_splaying_did() {
    let points = generate(Distribution::ThinSphere, 2_000, 5);
    let options = Options { trace: true, ..Options::default() };
    let mesh = block_on(HYBRID.delaunay3d((&points).into(), &options)).expect("triangulates");
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

    let canonical = |tetrahedra: &[[u32; 4]]| Mesh3 { tetrahedra: tetrahedra.to_vec(), ..Mesh3::default() }.canonical();
    let before: HashSet<[u32; 4]> = canonical(last).into_iter().collect();
    assert_eq!(trace.splayed.len(), mesh.tetrahedra.len());
    for (&t, &splayed) in mesh.tetrahedra.iter().zip(&trace.splayed) {
        assert_eq!(splayed, !before.contains(&canonical(&[t])[0]));
    }
    assert!(trace.splayed.contains(&true) && trace.splayed.contains(&false));
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
