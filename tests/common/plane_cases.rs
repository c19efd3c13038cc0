//! Four vertices of the plane each, for the predicates: generic, nearly degenerate and degenerate.

use gdel::{gpu::plane::twin::predicates::Vertex, lattice::Width};
use rand::{Rng, RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

/// The arguments of an in-circle test; the first three are those of an orientation.
pub type Case = [Vertex; 4];

/// How the points of a case lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Anywhere on the lattice.
    Uniform,
    /// All coordinates are 0 or the largest.
    Corners,
    /// A few lattice steps apart: all kinds of degeneracy, also points that coincide.
    SmallGrid,
    /// On a line, exactly or off by one.
    Collinear,
    /// On a circle through lattice points, exactly or off by one.
    Cocircular,
    /// As near to each other as a millionth of the range.
    Clustered,
}

/// All families.
pub const FAMILIES: &[Family] =
    &[Family::Uniform, Family::Corners, Family::SmallGrid, Family::Collinear, Family::Cocircular, Family::Clustered];

impl Family {
    /// Asserts that the numbers of zeros and of signs that the filter decided, for orientation and in-circle, are about
    /// what the family promises, so that a generator that misses its aim is noticed.
    pub fn check_that_it_is_what_it_says(self, zeros: [usize; 2], decided: [usize; 2], cases: usize) {
        let share = |part: usize| part as f64 / cases as f64;
        match self {
            Family::Uniform => assert!(share(decided[0]) > 0.99 && share(decided[1]) > 0.99),
            Family::Clustered => assert!(zeros == [0, 0]),
            Family::Corners | Family::SmallGrid => assert!(share(zeros[0]) > 0.05 && share(zeros[1]) > 0.05),
            Family::Collinear => assert!((0.3..0.9).contains(&share(zeros[0]))),
            Family::Cocircular => assert!((0.3..0.9).contains(&share(zeros[1]))),
        }
    }
}

/// `count` cases of a family, the same in every run.
pub fn cases(family: Family, width: Width, count: usize) -> Vec<Case> {
    let mut rng = Pcg64Mcg::seed_from_u64(family as u64);
    (0..count)
        .map(|_| {
            let positions = positions(family, width, &mut rng);
            // Indices in no order, and large ones too.
            let base = if rng.random() { 0 } else { u32::MAX - 16 };
            let mut indices: Vec<u32> = (base..base + 16).collect();
            indices.shuffle(&mut rng);
            std::array::from_fn(|i| Vertex { position: positions[i], index: indices[i] })
        })
        .collect()
}

fn positions(family: Family, width: Width, rng: &mut impl Rng) -> [[i64; 2]; 4] {
    let max = (1i64 << width.bits()) - 1;
    match family {
        Family::Uniform => std::array::from_fn(|_| std::array::from_fn(|_| rng.random_range(0..=max))),
        Family::Corners => std::array::from_fn(|_| std::array::from_fn(|_| if rng.random() { max } else { 0 })),
        Family::SmallGrid => grid(max, rng),
        Family::Collinear => {
            let u: [i64; 2] =
                std::array::from_fn(|_| rng.random_range(-max / 32..max / 32) * i64::from(rng.random_bool(0.7)));
            let off = rng.random_range(0..4);
            std::array::from_fn(|i| {
                let s = rng.random_range(-8..=8);
                let nudge = i64::from(i == off && rng.random::<bool>());
                std::array::from_fn(|axis| max / 2 + s * u[axis] + nudge * i64::from(axis == 0))
            })
        }
        Family::Cocircular => cocircular(max, rng),
        Family::Clustered => {
            let near: [i64; 2] = std::array::from_fn(|_| rng.random_range(0..=max - max / 1_000_000));
            std::array::from_fn(|_| near.map(|x| x + rng.random_range(0..max / 1_000_000)))
        }
    }
}

/// Points of a small grid: at the lattice's ends or in its middle, with steps of one or large ones.
fn grid(max: i64, rng: &mut impl Rng) -> [[i64; 2]; 4] {
    let side = rng.random_range(1..=4);
    let step = if rng.random() { 1 } else { rng.random_range(1..=max / side) };
    let origin: [i64; 2] = std::array::from_fn(|_| match rng.random_range(0..3) {
        0 => 0,
        1 => max - step * side,
        _ => rng.random_range(0..=max - step * side),
    });
    std::array::from_fn(|_| origin.map(|x| x + step * rng.random_range(0..=side)))
}

/// Points whose coordinates are those of integer vectors of length 65, permuted and mirrored.
fn cocircular(max: i64, rng: &mut impl Rng) -> [[i64; 2]; 4] {
    let scale = rng.random_range(1..=max / 140);
    let off = rng.random_range(0..4);
    std::array::from_fn(|i| {
        let mut p = [[0, 65], [16, 63], [25, 60], [33, 56], [39, 52]][rng.random_range(0..5)];
        p.shuffle(rng);
        let nudge = if i == off { rng.random_range(-1..=1) } else { 0 };
        std::array::from_fn(|axis| {
            let sign = if rng.random() { 1 } else { -1 };
            max / 2 + sign * scale * p[axis] + nudge * i64::from(axis == 1)
        })
    })
}
