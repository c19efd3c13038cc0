//! Inputs of Phase 1: generic and degenerate.

use std::collections::HashSet;

use gdel::internals::d3::generate::{Distribution3, generate3d};
use gdel::internals::input::lattice::Width;
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg32;

type Point = [i64; 3];

/// Points in input order, which is random.
#[derive(Debug, Clone)]
pub struct Input {
    pub name: &'static str,
    pub positions: Vec<[f64; 3]>,
    /// How many share their position with one before.
    pub sharing: usize,
}

fn input(name: &'static str, width: Width, mut positions: Vec<Point>) -> Input {
    positions.shuffle(&mut Pcg32::seed_from_u64(99));
    let distinct: HashSet<&Point> = positions.iter().collect();
    let sharing = positions.len() - distinct.len();
    // Too many bits for a narrow lattice, but not for `f64`.
    let factor = if width == Width::Wide { 0x4000_0003 } else { 1 };
    let positions = positions.into_iter().map(|q| q.map(|x| (x * factor) as f64)).collect();
    Input { name, positions, sharing }
}

fn random(count: usize, seed: u64, size: i64) -> Vec<Point> {
    let mut rng = Pcg32::seed_from_u64(seed);
    (0..count).map(|_| std::array::from_fn(|_| rng.random_range(0..size))).collect()
}

fn grid([a, b, c]: [i64; 3]) -> Vec<Point> {
    (0..a * b * c).map(|i| [i % a, i / a % b, i / (a * b)].map(|x| 4 * x)).collect()
}

/// Points with random coordinates.
pub fn uniform(width: Width, count: usize) -> Input {
    input("uniform", width, random(count, 5, 1 << 22))
}

/// Points of a sphere, rounded.
pub fn sphere(width: Width, count: usize) -> Input {
    let on_sphere = generate3d(Distribution3::Sphere, count, 5);
    input(
        "sphere",
        width,
        on_sphere.into_iter().map(|p: [f64; 3]| p.map(|x| (x * f64::from(1 << 22)) as i64)).collect(),
    )
}

/// Points on two skew lines: all pairs of segments make tetrahedra, a quadratic number.
pub fn two_lines(width: Width, count: i64) -> Input {
    let points = (0..count).map(|i| if i % 2 == 0 { [4 * i, 0, 0] } else { [0, 4 * i, 40] }).collect();
    input("two lines", width, points)
}

/// Points in a needle, nearly all of them different, that is a few of the units thick in which `f64`
/// has its length.
pub fn needle(count: usize) -> Input {
    let thin = |x: f64| 1.0 + 1e-15 * x;
    let points = generate3d(Distribution3::Uniform, count, 1);
    let positions: Vec<[f64; 3]> = points.into_iter().map(|[x, y, z]: [f64; 3]| [x, thin(y), thin(z)]).collect();
    let distinct: HashSet<[u64; 3]> = positions.iter().map(|p| p.map(f64::to_bits)).collect();
    Input { name: "needle", sharing: positions.len() - distinct.len(), positions }
}

/// All kinds.
pub fn all(width: Width) -> Vec<Input> {
    let sphere = grid([51, 51, 51]).into_iter().map(|q| q.map(|x| x / 4));
    let sphere = sphere.filter(|q| q.iter().map(|x| (x - 25) * (x - 25)).sum::<i64>() == 625).collect();
    let layers = random(600, 8, 64).into_iter().map(|[x, y, z]| [x * 97, y * 31, 4 * (z % 2)]).collect();
    vec![
        input("five", width, vec![[0, 0, 0], [40, 0, 0], [0, 40, 0], [0, 0, 40], [44, 44, 44]]),
        uniform(width, 3000),
        input("cube", width, grid([2, 2, 2])),
        input("grid", width, grid([9, 9, 9])),
        input("thin grid", width, grid([24, 24, 2])),
        input("sphere", width, sphere),
        input("layers", width, layers),
        input("shared coordinates", width, random(400, 9, 6).into_iter().map(|q| q.map(|x| 4 * x)).collect()),
        two_lines(width, 40),
    ]
}
