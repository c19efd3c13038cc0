//! `orient3d` and `insphere` on 1,024 argument lists at a time: this crate's, and those of the
//! crates `robust` and `geometry-predicates`.
//!
//! * `vertices`: what the engine calls: [`PredicateContext`], with its filters, lattice integers
//!   and symbolic ties;
//! * `exact`: [`gdel::internals::predicates`] for coordinates on their own;
//! * `robust`, `geometry-predicates`: Shewchuk's adaptive predicates as those crates have them.
//!
//! All must agree on every sign before anything is timed.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gdel::internals::{
    input::lattice::Lattice,
    predicates::{
        self, Sign,
        filter::{PredicateContext, PredicateContext3},
    },
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use robust::Coord3D;

type Point = [f64; 3];

/// Returns lists of `N` different points each.
fn lists<const N: usize>(mut point: impl FnMut(&mut Pcg64) -> Point) -> Vec<[Point; N]> {
    let mut rng = Pcg64::seed_from_u64(1);
    std::iter::repeat_with(|| std::array::from_fn(|_| point(&mut rng)))
        .filter(|list: &[Point; N]| (1..N).all(|i| !list[..i].contains(&list[i])))
        .take(1024)
        .collect()
}

fn in_cube(rng: &mut Pcg64) -> Point {
    std::array::from_fn(|_| rng.random())
}

/// Returns a point near the plane 3z = x + y: z is rounded.
fn near_plane(rng: &mut Pcg64) -> Point {
    let [x, y]: [f64; 2] = std::array::from_fn(|_| rng.random());
    [x, y, (x + y) / 3.0]
}

/// Returns an integer point on the plane x + y + z = 0.
fn on_plane(rng: &mut Pcg64) -> Point {
    let [x, y]: [f64; 2] = std::array::from_fn(|_| f64::from(rng.random_range(-512..512)));
    [x, y, -x - y]
}

/// Returns a point near the unit sphere: the coordinates are rounded.
fn near_sphere(rng: &mut Pcg64) -> Point {
    loop {
        let p: Point = std::array::from_fn(|_| rng.random_range(-1.0..1.0));
        let norm = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        if (0.1..=1.0).contains(&norm) {
            return p.map(|x| x / norm);
        }
    }
}

/// Returns an integer point on the sphere of radius 9.
fn on_sphere(rng: &mut Pcg64) -> Point {
    let mut p = [[0.0, 0.0, 9.0], [1.0, 4.0, 8.0], [4.0, 4.0, 7.0], [3.0, 6.0, 6.0]][rng.random_range(0..4)];
    p.swap(0, rng.random_range(0..3));
    p.swap(1, rng.random_range(1..3));
    p.map(|x: f64| if rng.random() { x } else { -x })
}

/// Times the implementations of one predicate on the `lists`.
fn compare<const N: usize>(
    c: &mut Criterion,
    predicate: &str,
    cases: [(&str, Vec<[Point; N]>); 3],
    filtered: impl Fn(&PredicateContext3<'_>, [u32; N]) -> Sign,
    exact: impl Fn([Point; N]) -> Sign,
    robust: impl Fn([Coord3D<f64>; N]) -> f64,
    geometry_predicates: impl Fn([Point; N]) -> f64,
) {
    // Those crates count an orientation as positive that is negative here; see
    // `gdel::internals::predicates`.
    let sign = |value: f64| (value < 0.0) as Sign - (value > 0.0) as Sign;
    let robust = |list: [Point; N]| sign(robust(list.map(|[x, y, z]| Coord3D { x, y, z })));
    let geometry_predicates = |list| sign(geometry_predicates(list));

    let mut group = c.benchmark_group(predicate);
    for (case, lists) in cases {
        group.throughput(Throughput::Elements(lists.len() as u64));
        let points = lists.as_flattened().into();
        let indices: Vec<u32> = (0..(N * lists.len()) as u32).collect();
        let vertices = PredicateContext::new(points, &Lattice::fit(points), indices.clone());
        let (numbers, _) = indices.as_chunks::<N>();

        for (&list, &numbers) in lists.iter().zip(numbers) {
            let expected = exact(list);
            let sign = filtered(&vertices, numbers);
            let tie_broken = predicate == "insphere" && expected == 0;
            assert!(sign == expected || tie_broken, "{predicate}, vertices, {list:?}: {sign}, not {expected}");
            assert_eq!(robust(list), expected, "{predicate}, robust, {list:?}");
            assert_eq!(geometry_predicates(list), expected, "{predicate}, geometry-predicates, {list:?}");
        }

        let mut time = |name: &str, pass: &dyn Fn() -> i32| {
            group.bench_function(BenchmarkId::new(name, case), |b| b.iter(pass));
        };
        time("vertices", &|| numbers.iter().map(|&n| i32::from(filtered(&vertices, n))).sum());
        time("exact", &|| lists.iter().map(|&list| i32::from(exact(list))).sum());
        time("robust", &|| lists.iter().map(|&list| i32::from(robust(list))).sum());
        time("geometry-predicates", &|| lists.iter().map(|&list| i32::from(geometry_predicates(list))).sum());
    }
}

fn orient3d(c: &mut Criterion) {
    compare(
        c,
        "orient3d",
        [("generic", lists(in_cube)), ("nearly coplanar", lists(near_plane)), ("coplanar", lists(on_plane))],
        |vertices, [a, b, c, d]| vertices.orient3d(a, b, c, d),
        |[a, b, c, d]| predicates::orient3d(a, b, c, d),
        |[a, b, c, d]| robust::orient3d(a, b, c, d),
        |[a, b, c, d]| geometry_predicates::orient3d(a, b, c, d),
    );
}

fn insphere(c: &mut Criterion) {
    compare(
        c,
        "insphere",
        [("generic", lists(in_cube)), ("nearly cospherical", lists(near_sphere)), ("cospherical", lists(on_sphere))],
        |vertices, [a, b, c, d, e]| vertices.insphere([a, b, c, d], e),
        |[a, b, c, d, e]| predicates::insphere(a, b, c, d, e),
        |[a, b, c, d, e]| robust::insphere(a, b, c, d, e),
        |[a, b, c, d, e]| geometry_predicates::insphere(a, b, c, d, e),
    );
}

criterion_group!(benches, orient3d, insphere);
criterion_main!(benches);
