//! Points that move, in steps that are hard to follow.
#![allow(dead_code)]

use rand_pcg::{
    Pcg64Mcg,
    rand_core::{Rng, SeedableRng},
};
use std::f64::consts::TAU;

/// The displacements, as a share of the mean spacing, from none to more than any mesh can follow.
pub const DISPLACEMENTS: [f64; 9] = [0.0, 1e-12, 1e-6, 1e-3, 0.01, 0.05, 0.2, 1.0, 10.0];

/// Returns `n` points in the unit cube or square.
pub fn uniform<const D: usize>(n: usize, seed: u64) -> Vec<[f64; D]> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    (0..n).map(|_| std::array::from_fn(|_| unit(&mut random))).collect()
}

/// Returns a grid of `side` points along each axis.
pub fn grid<const D: usize>(side: usize) -> Vec<[f64; D]> {
    let at = |i: usize| std::array::from_fn(|axis| (i / side.pow(axis as u32) % side) as f64);
    (0..side.pow(D as u32)).map(at).collect()
}

/// Returns `n` points on a circle or sphere around the origin.
pub fn sphere<const D: usize>(n: usize, seed: u64) -> Vec<[f64; D]> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    (0..n)
        .map(|_| {
            let p: [f64; D] = std::array::from_fn(|_| gaussian(&mut random));
            let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            p.map(|x| x / length)
        })
        .collect()
}

/// Displaces all points by normally distributed amounts, `share` of the mean spacing of as many
/// points in a unit cube or square.
pub fn jitter<const D: usize>(points: &[[f64; D]], share: f64, seed: u64) -> Vec<[f64; D]> {
    let sigma = share * (points.len() as f64).powf(-1.0 / D as f64);
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    points.iter().map(|p| p.map(|x| x + sigma * gaussian(&mut random))).collect()
}

/// Rotates points about the origin in the plane of the first two axes.
pub fn rotated<const D: usize>(points: &[[f64; D]], angle: f64) -> Vec<[f64; D]> {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let rotate = |mut p: [f64; D]| {
        [p[0], p[1]] = [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]];
        p
    };
    points.iter().map(|&p| rotate(p)).collect()
}

/// Scales points about the origin.
pub fn scaled<const D: usize>(points: &[[f64; D]], by: f64) -> Vec<[f64; D]> {
    points.iter().map(|p| p.map(|x| by * x)).collect()
}

/// Returns two clusters of `n` points each, the first at this place of the first axis and the second
/// opposite.
pub fn two_clusters<const D: usize>(n: usize, at: f64) -> Vec<[f64; D]> {
    let cluster = |seed: u64, at: f64| {
        uniform::<D>(n, seed).into_iter().map(move |mut p| {
            p[0] += at;
            p
        })
    };
    cluster(1, at).chain(cluster(2, -at)).collect()
}

/// Returns `distinct` points in the unit cube or square, and as many again as make up `n` at the
/// places of some of them.
pub fn with_duplicates<const D: usize>(n: usize, distinct: usize, seed: u64) -> Vec<[f64; D]> {
    let points = uniform::<D>(distinct, seed);
    (0..n).map(|i| points[(i * 7919) % distinct]).collect()
}

fn unit(random: &mut Pcg64Mcg) -> f64 {
    (random.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON)
}

fn gaussian(random: &mut Pcg64Mcg) -> f64 {
    let (u, v) = (1.0 - unit(random), unit(random));
    (-2.0 * libm::log(u)).sqrt() * libm::cos(TAU * v)
}
