//! Random degenerate point clouds, and how many of them a test takes.

use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use std::{env, ops::Range};

/// Returns the seeds of a test's clouds: `default` of them, or as many as `GDEL_DEGENERATE` says,
/// from `GDEL_SEED` on.
pub fn cases(default: u64) -> Range<u64> {
    let number = |name| env::var(name).ok().map(|value| value.parse().expect("a number"));
    let first: u64 = number("GDEL_SEED").unwrap_or(0);
    first..first + number("GDEL_DEGENERATE").unwrap_or(default)
}

/// Creates fewer than `most` points of a random kind that is degenerate: with ties, duplicates, and
/// less than `D` dimensions.
pub fn points<const D: usize>(random: &mut Pcg64Mcg, most: usize) -> Vec<[f64; D]> {
    let count = random.random_range(0..most);
    let side = random.random_range(1..7);
    let scale = 2f64.powi(random.random_range(-40..40));
    let flat = random.random_range(0..=D);
    let kind = random.random_range(0..5);
    let point = |random: &mut Pcg64Mcg| {
        let mut p: [f64; D] = std::array::from_fn(|_| f64::from(random.random_range(0..side)));
        match kind {
            // A grid, of fewer dimensions where `flat` says so.
            0 => p.iter_mut().skip(flat).for_each(|x| *x = 1.0),
            // Points on a line through no corner.
            1 => p = std::array::from_fn(|axis| p[0] * (axis + 1) as f64 + 0.5),
            // Signs and order of 3, 4 and 12 from the origin: all on a sphere.
            2 => {
                let numbers = [3.0, 4.0, 12.0];
                let turn = random.random_range(0..D);
                p = std::array::from_fn(|axis| numbers[(axis + turn) % D]);
                p.iter_mut().for_each(|x| *x *= if random.random() { 1.0 } else { -1.0 });
            }
            // Nearly a grid.
            3 => p.iter_mut().for_each(|x| *x += f64::from(random.random_range(-1..2)) * f64::EPSILON),
            // Of all sizes.
            _ => p.iter_mut().for_each(|x| *x *= 2f64.powi(random.random_range(-300..300))),
        }
        p.map(|x| x * scale)
    };
    (0..count).map(|_| point(random)).collect()
}
