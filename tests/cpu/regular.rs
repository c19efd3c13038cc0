//! The triangulation of weighted points on the CPU is the one that the definition names, and no other.

use crate::{
    degenerate::{cases, points},
    oracle,
};
use gdel::{
    Backend, Error, Mesh2, Mesh3, Triangulator,
    internals::{Options, cpu::regular_in_order, input::order::Order, predicates::exact::power_sign},
    stats::Fallback,
    verify::{Check, Report},
    verify2d, verify3d,
};
use rand::RngExt;
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};

/// Creates weights of a random kind for points.
fn weights<const D: usize>(random: &mut Pcg64Mcg, points: &[[f64; D]]) -> Vec<f64> {
    let square = |p: &[f64; D]| p.iter().map(|x| x * x).sum::<f64>();
    let largest = points.as_flattened().iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let unit = 2f64.powi(2 * (largest.max(1e-150).log2() as i32 - 2));
    let kind = random.random_range(0..8);
    let weight = |random: &mut Pcg64Mcg, p: &[f64; D]| match kind {
        // Few that differ, so that there are many ties.
        0 => unit * f64::from(random.random_range(0..3)),
        1 => unit * f64::from(random.random_range(-9..9)),
        // All lifted points in a plane, or nearly.
        2 => square(p),
        3 => square(p) * if random.random_range(0..4) == 0 { 1.0 + f64::EPSILON } else { 1.0 },
        // A few points that hide the others.
        4 => unit * if random.random_range(0..3) == 0 { 1000.0 } else { random.random::<f64>() },
        5 => unit * random.random::<f64>() * 4.0,
        // Of all sizes.
        6 => f64::from(random.random_range(-2..3)) * 2f64.powi(random.random_range(-1000..1000)),
        _ => unit * (1.0 + f64::from(random.random_range(-1..2)) * f64::EPSILON),
    };
    points.iter().map(|p| weight(random, p)).map(|w| if w.is_finite() { w } else { 0.0 }).collect()
}

const ORDERS: [Order; 3] = [Order::Brio, Order::Shuffled(1), Order::Shuffled(2)];

fn check3(points: &[[f64; 3]], weights: &[f64]) {
    let expected = oracle::regular::<3, 4>(points, weights);
    for order in ORDERS {
        let mesh: Mesh3 = regular_in_order::<3>(points.into(), weights, &Options::default(), order).unwrap();
        let context = || format!("{order:?} of {points:?} with {weights:?}");
        let report = verify3d(points, &mesh).unwrap();
        assert!(report.passed(), "{report}\n{}", context());
        let found =
            oracle::Regular { simplices: mesh.canonical(), duplicate_of: mesh.duplicate_of, hidden: mesh.hidden };
        assert_eq!(found, expected, "{}", context());
    }
}

fn check2(points: &[[f64; 2]], weights: &[f64]) {
    let expected = oracle::regular::<2, 3>(points, weights);
    for order in ORDERS {
        let mesh: Mesh2 = regular_in_order::<2>(points.into(), weights, &Options::default(), order).unwrap();
        let context = || format!("{order:?} of {points:?} with {weights:?}");
        let report = verify2d(points, &mesh).unwrap();
        assert!(report.passed(), "{report}\n{}", context());
        let found =
            oracle::Regular { simplices: mesh.canonical(), duplicate_of: mesh.duplicate_of, hidden: mesh.hidden };
        assert_eq!(found, expected, "{}", context());
    }
}

#[test]
fn small_degenerate_inputs_in_3d() {
    for seed in cases(3000) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let points = points::<3>(random, 12);
        let weights = weights(random, &points);
        check3(&points, &weights);
    }
}

#[test]
fn small_degenerate_inputs_in_2d() {
    for seed in cases(5000) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let points = points::<2>(random, 16);
        let weights = weights(random, &points);
        check2(&points, &weights);
    }
}

fn cloud<const D: usize>(random: &mut Pcg64Mcg, count: usize) -> Vec<[f64; D]> {
    (0..count).map(|_| std::array::from_fn(|_| random.random())).collect()
}

fn passes(report: &Report) {
    assert!(report.passed(), "{report}");
    assert!(report.outcome(Check::Hidden).is_some());
}

#[test]
fn larger_inputs_pass_the_verifier() {
    let random = &mut Pcg64Mcg::seed_from_u64(7);
    for (count, largest) in [(300, 0.5), (3000, 0.01), (3000, 0.1), (20_000, 3e-4), (20_000, 0.003)] {
        let points = cloud::<3>(random, count);
        let weights: Vec<f64> = points.iter().map(|_| largest * random.random::<f64>()).collect();
        let mesh = Triangulator::new().regular3d(&points, &weights).unwrap();
        passes(&verify3d(&points, &mesh).unwrap());
        let points = cloud::<2>(random, count);
        let mesh = Triangulator::new().regular2d(&points, &weights).unwrap();
        passes(&verify2d(&points, &mesh).unwrap());
        assert!(!mesh.hidden.is_empty());
        assert_eq!(mesh.vertices().count() + mesh.hidden.len(), count);
        let simplex = mesh.vertex_triangle();
        assert!(mesh.hidden.iter().all(|&i| simplex[i as usize] == gdel::NONE && mesh.is_hidden(i)));
    }
}

#[test]
fn all_but_the_corners_are_hidden() {
    let random = &mut Pcg64Mcg::seed_from_u64(1);
    let mut points = cloud::<3>(random, 5000);
    let mut weights: Vec<f64> = points.iter().map(|_| random.random()).collect();
    points.extend([[-9.0; 3], [30.0, -9.0, -9.0], [-9.0, 30.0, -9.0], [-9.0, -9.0, 30.0], [0.5; 3]]);
    weights.extend([1e6; 4]);
    weights.push(1e6 + 1e3);
    let mesh = Triangulator::new().regular3d(&points, &weights).unwrap();
    passes(&verify3d(&points, &mesh).unwrap());
    assert_eq!(mesh.hidden, (0..5000).collect::<Vec<_>>());
    assert_eq!((mesh.tetrahedra.len(), mesh.vertices().count()), (4, 5));

    let flat: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
    let mesh = Triangulator::new().regular2d(&flat[..5003], &weights[..5003]).unwrap();
    passes(&verify2d(&flat[..5003], &mesh).unwrap());
    assert_eq!((mesh.triangles.len(), mesh.hidden.len()), (1, 5000));
}

#[test]
fn equal_weights_change_nothing() {
    let random = &mut Pcg64Mcg::seed_from_u64(3);
    let (points, flat) = (cloud::<3>(random, 4000), cloud::<2>(random, 4000));
    let triangulator = Triangulator::new().backend(Backend::Cpu).threads(std::num::NonZeroUsize::MIN);
    for weight in [0.0, 1.0, -1e300, 1e-300] {
        let weights = vec![weight; 4000];
        let mesh = triangulator.regular3d(&points, &weights).unwrap();
        let expected = triangulator.delaunay3d(&points).unwrap();
        assert_eq!(
            (&mesh.tetrahedra, &mesh.neighbors, &mesh.hull),
            (&expected.tetrahedra, &expected.neighbors, &expected.hull)
        );
        assert!(mesh.weights.is_empty() && mesh.hidden.is_empty());
        let mesh = triangulator.regular2d(&flat, &weights).unwrap();
        let expected = triangulator.delaunay2d(&flat).unwrap();
        assert_eq!(
            (&mesh.triangles, &mesh.halfedges, &mesh.hull),
            (&expected.triangles, &expected.halfedges, &expected.hull)
        );
    }
}

/// An affine function of the coordinates, added to all weights, tilts the lifted points and moves the power diagram.
#[test]
fn affine_functions_change_nothing() {
    for seed in cases(300) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let count = random.random_range(5..400);
        let side = random.random_range(2..30);
        let mut point = |_| -> [f64; 3] { std::array::from_fn(|_| f64::from(random.random_range(0..side))) };
        let points: Vec<[f64; 3]> = (0..count).map(&mut point).collect();
        let weights: Vec<f64> = points.iter().map(|_| f64::from(random.random_range(0..side))).collect();
        let slope: [f64; 3] = std::array::from_fn(|_| f64::from(random.random_range(-20..20)));
        let offset = f64::from(random.random_range(-99..99));
        let moved = |p: &[f64], w: f64| p.iter().zip(slope).map(|(x, s)| x * s).sum::<f64>() + w + offset;
        let others: Vec<f64> = points.iter().zip(&weights).map(|(p, &w)| moved(p, w)).collect();
        let [a, b] = [&weights, &others].map(|weights| Triangulator::new().regular3d(&points, weights).unwrap());
        assert_eq!((a.canonical(), &a.hidden, &a.duplicate_of), (b.canonical(), &b.hidden, &b.duplicate_of), "{seed}");

        let flat: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
        let others: Vec<f64> = flat.iter().zip(&weights).map(|(p, &w)| moved(p, w)).collect();
        let [a, b] = [&weights, &others].map(|weights| Triangulator::new().regular2d(&flat, weights).unwrap());
        assert_eq!((a.canonical(), &a.hidden, &a.duplicate_of), (b.canonical(), &b.hidden, &b.duplicate_of), "{seed}");
    }
}

#[test]
fn the_heaviest_of_equal_points_stands_for_the_others() {
    let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [1.0, 1.0], [1.0, 1.0], [1.0, 1.0], [1.0, 1.0f64]];
    let mesh = Triangulator::new().regular2d(&points, &[0.0, 0.0, 0.0, 1.0, 3.0, 3.0, 2.0]).unwrap();
    assert_eq!(mesh.duplicate_of[3..], [4, gdel::NONE, 4, 4]);
    assert_eq!((mesh.triangles.len(), mesh.representative(3)), (3, 4));
    // All of them are hidden.
    let mesh = Triangulator::new().regular2d(&points, &[9.0, 9.0, 9.0, -1.0, -3.0, -3.0, -2.0]).unwrap();
    assert_eq!((mesh.triangles.len(), mesh.hidden.as_slice(), mesh.representative(6)), (1, &[3][..], 3));
    assert!(verify2d(&points, &mesh).unwrap().passed());
}

#[test]
fn weights_of_all_sizes() {
    let random = &mut Pcg64Mcg::seed_from_u64(5);
    let points = cloud::<3>(random, 300);
    for exponents in [-300..300, -300..-290, 290..308, -20..20] {
        let weights: Vec<f64> = points
            .iter()
            .map(|_| random.random::<f64>() * 10f64.powi(random.random_range(exponents.clone())))
            .collect();
        let mesh = Triangulator::new().regular3d(&points, &weights).unwrap();
        passes(&verify3d(&points, &mesh).unwrap());
        let flat: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
        let mesh = Triangulator::new().regular2d(&flat, &weights).unwrap();
        passes(&verify2d(&flat, &mesh).unwrap());
    }
}

#[test]
fn bad_weights_are_errors() {
    let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
    let regular = |weights: &[f64]| Triangulator::new().regular2d(&points, weights).map(|mesh| mesh.triangles.len());
    assert_eq!(regular(&[0.0, 1.0]), Err(Error::ValueCount { values: 2, points: 3 }));
    assert_eq!(regular(&[0.0, f64::NAN, f64::INFINITY]), Err(Error::BadWeight { index: 1 }));
    assert_eq!(regular(&[0.0, 0.0, f64::NEG_INFINITY]), Err(Error::BadWeight { index: 2 }));
    assert_eq!(regular(&[0.0, 1.0, 2.0]), Ok(1));
}

/// What exists for Delaunay triangulations only says so.
#[test]
fn a_weighted_mesh_is_not_taken_for_a_delaunay_triangulation() {
    let mut points = vec![[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [1.0, 1.0f64]];
    let triangulator = Triangulator::new();
    let mesh = triangulator.regular2d(&points, &[0.0, 0.0, 0.0, 1.0]).unwrap();
    assert_eq!(mesh.stats.fallback, Some(Fallback::Weights));
    for (backend, fallback) in [(Backend::Gpu, Some(Fallback::Weights)), (Backend::Cpu, None)] {
        let stats = Triangulator::new().backend(backend).regular2d(&points, &[0.0, 0.0, 0.0, 1.0]).unwrap().stats;
        assert_eq!((stats.backend, stats.fallback), (Backend::Cpu, fallback));
    }
    let refused = Some(Error::WeightedMesh);
    assert_eq!(gdel::Contours2::new(&mesh, &points, &[0.0; 4]).err(), refused);
    assert_eq!(gdel::Surface::new(&mesh, &points, &gdel::SurfaceOptions::default()).err(), refused);
    assert_eq!(gdel::AlphaShape2::new(&mesh, &points).err(), refused);
    assert_eq!(gdel::SpanningTree::new(&mesh, &points).err(), refused);
    let mut edited = mesh.clone();
    assert_eq!(triangulator.remove(&mut edited, &points, &[3]).err(), refused);
    assert_eq!(triangulator.insert(&mut edited, &mut points, &[[2.0, 1.0]]).err(), refused);
    assert_eq!((edited.canonical(), points.len()), (mesh.canonical(), 4));
}

/// The verifier notices a wrong weight, a point that is hidden wrongly, and one that should be.
#[test]
fn the_verifier_notices() {
    let random = &mut Pcg64Mcg::seed_from_u64(11);
    let points = cloud::<3>(random, 400);
    let weights: Vec<f64> = points.iter().map(|_| 0.02 * random.random::<f64>()).collect();
    let mesh = Triangulator::new().regular3d(&points, &weights).unwrap();
    passes(&verify3d(&points, &mesh).unwrap());
    assert!(mesh.hidden.len() > 10);
    let fails = |mesh: &Mesh3, check: Check| {
        let report = verify3d(&points, mesh).unwrap();
        assert!(report.failures().any(|(failed, ..)| failed == check), "{report}");
    };
    let mut other = mesh.clone();
    other.hidden.pop();
    fails(&other, Check::Hidden);
    let mut other = mesh.clone();
    other.weights[mesh.hidden[3] as usize] = 5.0;
    fails(&other, Check::Hidden);
    let mut other = mesh.clone();
    let vertex = mesh.vertices().next().unwrap();
    other.weights[vertex as usize] += 0.1;
    fails(&other, Check::Delaunay);
    // A Delaunay triangulation has no hidden points.
    let mut other = gdel::delaunay3d(&points).unwrap();
    other.weights = weights.clone();
    fails(&other, Check::Delaunay);
    let mut other = mesh;
    (other.weights, other.hidden) = (Vec::new(), Vec::new());
    fails(&other, Check::Vertices);
}

#[test]
fn the_sign_of_lifted_points_is_exact() {
    // On a common plane after lifting, but for the last bit of one weight.
    let points = [[0.0, 0.0], [3.0, 0.0], [0.0, 7.0], [1.0, 2.0]];
    let weights = points.map(|[x, y]: [f64; 2]| x * x + y * y - 2.0 * x + 5.0 * y);
    assert_eq!(power_sign(points, weights), 0);
    let [a, b, c, d] = weights;
    assert_eq!(power_sign(points, [a, b, c, d.next_up()]), 1);
    assert_eq!(power_sign(points, [a, b, c, d.next_down()]), -1);
    assert_eq!(power_sign(points, [a, b, c, 1e300]), 1);
    assert_eq!(power_sign(points, [1e300, b, c, -1e-300]), -1);
}
