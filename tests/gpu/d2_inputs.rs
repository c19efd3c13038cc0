//! 2D inputs: generic and degenerate.

use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg32;

type Point = [i64; 2];

fn random(count: usize, seed: u64, size: i64) -> Vec<Point> {
    let mut rng = Pcg32::seed_from_u64(seed);
    (0..count).map(|_| std::array::from_fn(|_| rng.random_range(0..size))).collect()
}

fn grid(columns: i64, rows: i64) -> Vec<Point> {
    (0..columns * rows).map(|i| [4 * (i % columns), 4 * (i / columns)]).collect()
}

/// Points of integer coordinates, in input order, which is random. Some share their place with
/// others.
pub fn all() -> Vec<(&'static str, Vec<Point>)> {
    let mut circle: Vec<Point> = Vec::new();
    for x in -1105i64..=1105 {
        // 1105 = 5·13·17 has many representations.
        let y = ((1105 * 1105 - x * x) as f64).sqrt().round() as i64;
        if x * x + y * y == 1105 * 1105 {
            circle.extend([[x + 1105, y + 1105], [x + 1105, 1105 - y]]);
        }
    }
    circle.sort_unstable();
    circle.dedup();
    let clusters = random(400, 21, 40)
        .into_iter()
        .enumerate()
        .map(|(i, [x, y])| [x + (i as i64 % 3) * 100_000, y + 50_000 * (i as i64 % 2)]);
    let parabola = (-60i64..60).map(|x| [x + 60, x * x]);
    let mut inputs = vec![
        ("three", vec![[0, 0], [40, 0], [0, 40]]),
        ("four", vec![[0, 0], [40, 0], [0, 40], [40, 40]]),
        ("uniform", random(1500, 5, 1 << 22)),
        ("square", grid(2, 2)),
        ("grid", grid(19, 19)),
        ("ribbon", grid(150, 2)),
        ("line and a point", (0..100).map(|i| [4 * i, 8 * i]).chain([[40, 0]]).collect()),
        ("two lines", (0..120).map(|i| [4 * i, 40 * (i % 2)]).collect()),
        ("circle", circle),
        ("shared places", random(500, 9, 12)),
        ("clusters", clusters.collect()),
        ("parabola", parabola.collect()),
    ];
    for (_, points) in &mut inputs {
        points.shuffle(&mut Pcg32::seed_from_u64(99));
    }
    inputs
}
