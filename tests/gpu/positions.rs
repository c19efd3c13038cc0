//! Where the vertices of cases for the predicates lie, in any dimension `D`, and `N` of them.

use gdel::internals::input::lattice::Width;
use rand::{Rng, RngExt, seq::SliceRandom};
use std::array::from_fn;

/// The largest coordinate.
pub fn largest(width: Width) -> i64 {
    (1 << width.bits()) - 1
}

/// Anywhere on the lattice.
pub fn uniform<const D: usize, const N: usize>(max: i64, rng: &mut impl Rng) -> [[i64; D]; N] {
    from_fn(|_| from_fn(|_| rng.random_range(0..=max)))
}

/// All coordinates are 0 or the largest.
pub fn corners<const D: usize, const N: usize>(max: i64, rng: &mut impl Rng) -> [[i64; D]; N] {
    from_fn(|_| from_fn(|_| if rng.random() { max } else { 0 }))
}

/// Points of a small grid: at the lattice's ends or in its middle, with steps of one or large ones.
pub fn grid<const D: usize, const N: usize>(max: i64, rng: &mut impl Rng) -> [[i64; D]; N] {
    let side = rng.random_range(1..=4);
    let step = if rng.random() { 1 } else { rng.random_range(1..=max / side) };
    let origin: [i64; D] = from_fn(|_| match rng.random_range(0..3) {
        0 => 0,
        1 => max - step * side,
        _ => rng.random_range(0..=max - step * side),
    });
    from_fn(|_| origin.map(|x| x + step * rng.random_range(0..=side)))
}

/// A direction for a line through the middle of the lattice, often along some of its axes.
pub fn direction<const D: usize>(max: i64, rng: &mut impl Rng) -> [i64; D] {
    from_fn(|_| rng.random_range(-max / 32..max / 32) * i64::from(rng.random_bool(0.7)))
}

/// Points around the middle whose coordinates are those of vectors of one length, permuted and
/// mirrored; one of them may be off by one. The vectors are scaled by up to `most`.
pub fn cospherical<const D: usize, const N: usize>(
    vectors: &[[i64; D]],
    most: i64,
    max: i64,
    rng: &mut impl Rng,
) -> [[i64; D]; N] {
    let scale = rng.random_range(1..=most);
    let off = rng.random_range(0..N);
    from_fn(|i| {
        let mut p = vectors[rng.random_range(0..vectors.len())];
        p.shuffle(rng);
        let nudge = if i == off { rng.random_range(-1..=1) } else { 0 };
        from_fn(|axis| {
            let sign = if rng.random() { 1 } else { -1 };
            max / 2 + sign * scale * p[axis] + nudge * i64::from(axis == 1)
        })
    })
}

/// As near to each other as a millionth of the range.
pub fn clustered<const D: usize, const N: usize>(max: i64, rng: &mut impl Rng) -> [[i64; D]; N] {
    let near: [i64; D] = from_fn(|_| rng.random_range(0..=max - max / 1_000_000));
    from_fn(|_| near.map(|x| x + rng.random_range(0..max / 1_000_000)))
}

/// Indices in no order, and large ones too.
pub fn indices(rng: &mut impl Rng) -> Vec<u32> {
    let base = if rng.random() { 0 } else { u32::MAX - 16 };
    let mut indices: Vec<u32> = (base..base + 16).collect();
    indices.shuffle(rng);
    indices
}
