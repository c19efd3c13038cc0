//! Phase 1 on the kernels' references: the algorithm, proven without a GPU.

use gdel::internals::gpu::layout::Pick;
use gdel::internals::input::lattice::Width;
use gdel::internals::reference::d3::predicates::{Vertex, insphere, orient3d};
use gdel::internals::reference::run::{Settings, run};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

type State = gdel::internals::reference::State<3>;

type Point = [i64; 3];

/// Distinct points in a scrambled input order, sorted along a coarse curve: by the interleaved bits
/// of their coordinates.
fn sites(mut points: Vec<Point>) -> Vec<Vertex> {
    points.sort_unstable();
    points.dedup();
    let count = points.len() as u32;
    let mut order: Vec<u32> = (0..count).collect();
    let mut rng = Pcg32::seed_from_u64(99);
    for i in (1..order.len()).rev() {
        order.swap(i, rng.random_range(0..=i));
    }
    let mut sites: Vec<Vertex> =
        points.into_iter().zip(order).map(|(q, index)| Vertex { position: q, index }).collect();
    let bits = sites.iter().flat_map(|s| s.position).max().map_or(0, |m| 64 - m.leading_zeros());
    let morton =
        |q: Point| (0..bits).rev().fold(0u128, |key, b| q.iter().fold(key, |k, x| k << 1 | (x >> b & 1) as u128));
    sites.sort_by_key(|s| morton(s.position));
    sites
}

fn random(count: usize, seed: u64, size: i64) -> Vec<Point> {
    let mut rng = Pcg32::seed_from_u64(seed);
    (0..count).map(|_| std::array::from_fn(|_| rng.random_range(0..size))).collect()
}

fn valid(points: Vec<Point>, settings: Settings) -> (State, usize) {
    let sites = sites(points);
    let count = sites.len();
    let state = run(Width::Narrow, sites, &Settings { validate: true, ..settings }).expect("not flat");
    assert_eq!(state.counters.inserted as usize, count);
    let bad = state.validate_end();
    (state, bad)
}

#[test]
fn uniform() {
    for (count, seed) in [(5, 1), (6, 2), (20, 3), (200, 4), (3000, 5)] {
        valid(random(count, seed, 1 << 24), Settings::default());
    }
}

/// All points of a box, some of its faces, and points on spheres: every kind of tie.
#[test]
fn degenerate() {
    let grid = |[a, b, c]: [i64; 3]| -> Vec<Point> {
        (0..a * b * c).map(|i| [i % a, i / a % b, i / (a * b)].map(|x| 4 * x)).collect()
    };
    let sphere: Vec<Point> = random(200_000, 7, 51)
        .into_iter()
        .filter(|q| q.iter().map(|x| (x - 25) * (x - 25)).sum::<i64>() == 625)
        .collect();
    let layers = random(600, 8, 64).into_iter().map(|[x, y, z]| [x * 97, y * 31, 4 * (z % 2)]).collect();
    let two_lines = (0..40).map(|i| if i % 2 == 0 { [4 * i, 0, 0] } else { [0, 4 * i, 40] }).collect();
    let inputs: Vec<Vec<Point>> = vec![
        grid([2, 2, 2]),
        grid([3, 3, 3]),
        grid([8, 8, 8]),
        grid([30, 30, 2]),
        grid([40, 2, 2]),
        sphere,
        layers,
        two_lines,
    ];
    for (i, points) in inputs.into_iter().enumerate() {
        println!("input {i}, {} points", points.len());
        let (state, bad) = valid(points.clone(), Settings::default());
        println!("{:?} {bad}", state.counters);
        valid(points.clone(), Settings { insert_all: true, ..Settings::default() });
        // Flips wait for slots and for room in the history, and nothing is lost.
        valid(points, Settings { min_active: 30, tail: 1, history: 20, ..Settings::default() });
    }
}

#[test]
fn failed_vertices_are_few() {
    let sites = sites(random(100_000, 11, 1 << 24));
    for pick in [Pick::Circumcenter, Pick::Centroid, Pick::Random] {
        let start = std::time::Instant::now();
        let state = run(Width::Narrow, sites.clone(), &Settings { pick, ..Settings::default() }).expect("not flat");
        let failed: u32 = state.own.failed.iter().sum();
        println!("{pick:?} failed {failed} {:?} {:?}", state.counters, start.elapsed());
        if pick == Pick::Circumcenter {
            assert!(failed <= 150, "{failed} of 100,000 vertices failed");
        }
    }
}

fn five(rng: &mut Pcg32, size: i64) -> [Vertex; 5] {
    loop {
        let q: [[i64; 3]; 5] = std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(0..size)));
        if (0..5).all(|i| (0..i).all(|j| q[i] != q[j])) {
            let mut index = 0;
            return q.map(|q| {
                index += rng.random_range(1..3);
                Vertex { position: q, index: index ^ 5 }
            });
        }
    }
}

/// A point inside a tetrahedron is inside its circumsphere, in every kind of degenerate position.
#[test]
fn inside_is_inside_the_sphere() {
    let mut rng = Pcg32::seed_from_u64(3);
    let mut found = 0;
    for _ in 0..20_000 {
        let mut s = five(&mut rng, 3);
        if rng.random() {
            s.iter_mut().for_each(|s| s.position[2] = s.position[0] + s.position[1]);
        }
        if (0..5).any(|i| (0..i).any(|j| s[i].position == s[j].position)) {
            continue;
        }
        let replaced = |k: usize| {
            let mut four = [s[0], s[1], s[2], s[3]];
            four[k] = s[4];
            four
        };
        let positive = orient3d(Width::Narrow, [s[0], s[1], s[2], s[3]]) > 0;
        if positive && (0..4).all(|k| orient3d(Width::Narrow, replaced(k)) > 0) {
            found += 1;
            assert_eq!(insphere(Width::Narrow, s), 1, "{s:?}");
        }
    }
    assert!(found > 20);
}
