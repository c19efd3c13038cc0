//! Points that move, in steps that are hard to follow.
#![allow(dead_code)]

use rand_pcg::{
    Pcg64Mcg,
    rand_core::{Rng, SeedableRng},
};
use std::f64::consts::TAU;

/// The displacements, as a share of the mean spacing, from none to more than any mesh can follow.
pub const DISPLACEMENTS: [f64; 9] = [0.0, 1e-12, 1e-6, 1e-3, 0.01, 0.05, 0.2, 1.0, 10.0];

/// The steps of points that move: their coordinates at each.
pub type Steps<const D: usize> = Vec<Vec<[f64; D]>>;

/// Returns points before and after a displacement.
pub fn displaced<const D: usize>(n: usize, share: f64) -> Steps<D> {
    let points = uniform::<D>(n, 1);
    vec![points.clone(), jitter(&points, share, 2)]
}

/// Returns so many displacements, one after the other.
pub fn drifting<const D: usize>(n: usize, share: f64, steps: u64) -> Steps<D> {
    let mut points = uniform::<D>(n, 3);
    let step = |i| {
        points = jitter(&points, share, i);
        points.clone()
    };
    (0..=steps).map(step).collect()
}

/// Returns a grid that rotates, by small angles first.
pub fn rotating_grid<const D: usize>() -> Steps<D> {
    let grid = grid::<D>(if D == 3 { 9 } else { 30 });
    [0.0, 1e-9, 1e-3, 0.01, 0.02, 0.5].map(|angle| rotated(&grid, angle)).into()
}

/// Returns a grid that leaves its place, and comes back.
pub fn trembling_grid<const D: usize>() -> Steps<D> {
    let grid = grid::<D>(if D == 3 { 9 } else { 30 });
    [0.0, 1e-12, 1e-6, 1e-3, 0.0, 1.0, 0.0].map(|share| jitter(&grid, share, 1)).into()
}

/// Returns a sphere that grows and shrinks.
pub fn breathing_sphere<const D: usize>() -> Steps<D> {
    let sphere = sphere::<D>(400, 1);
    [1.0, 1.01, 0.99, 0.5, 3.0].map(|by| scaled(&sphere, by)).into()
}

/// Returns a sphere whose points leave it.
pub fn dissolving_sphere<const D: usize>() -> Steps<D> {
    let mut sphere = sphere::<D>(400, 1);
    let step = |i| {
        sphere = jitter(&sphere, 0.02, i);
        sphere.clone()
    };
    (0..10).map(step).collect()
}

/// Returns two clusters that pass through each other.
pub fn passing_clusters<const D: usize>() -> Steps<D> {
    (0..30).map(|i| two_clusters(200, f64::from(i - 15) * 0.13)).collect()
}

/// Returns points that swap places.
pub fn swapping<const D: usize>() -> Steps<D> {
    let points = uniform::<D>(500, 4);
    let swapped = |pairs: &[[usize; 2]]| {
        let mut points = points.clone();
        pairs.iter().for_each(|&[i, j]| points.swap(i, j));
        points
    };
    let all: Vec<_> = (0..250).map(|i| [i, 499 - i]).collect();
    vec![swapped(&[]), swapped(&[[3, 4]]), swapped(&[]), swapped(&[[0, 1], [7, 9]]), swapped(&all)]
}

/// Returns points of which one jumps across the hull.
pub fn jumping<const D: usize>() -> Steps<D> {
    let points = uniform::<D>(300, 5);
    let with = |i: usize, x: f64| {
        let mut points = points.clone();
        points[i] = [x; D];
        points
    };
    vec![with(0, 0.5), with(0, 1.5), with(0, 0.4), with(0, -20.0), with(1, 9.0), with(0, 0.999)]
}

/// Returns points of which three become equal to others, stay so, and part again.
pub fn meeting<const D: usize>() -> Steps<D> {
    let mut points = uniform::<D>(300, 6);
    let mut met = points.clone();
    // From nearby, as points do that move in small steps.
    for (i, other, distance) in [(7, 30, 0.01), (100, 30, 0.02), (200, 2, 0.03)] {
        met[i] = met[other];
        points[i] = met[other];
        points[i][0] += distance;
    }
    vec![points.clone(), met.clone(), met, points]
}

/// Returns points that become coplanar, or collinear in 2D, leave that, and become equal.
pub fn flattening<const D: usize>() -> Steps<D> {
    let points = uniform::<D>(200, 7);
    let flat = |&(mut p): &[f64; D]| {
        p[D - 1] = 0.25;
        p
    };
    let flat = points.iter().map(flat).collect();
    vec![points.clone(), flat, points, vec![[1.0; D]; 200]]
}

/// Returns points with 30 % duplicates, of which 30 part and come back, and then all part.
pub fn parting<const D: usize>() -> Steps<D> {
    let points = with_duplicates::<D>(1000, 700, 8);
    let mut some = points.clone();
    for (i, p) in some.iter_mut().enumerate().skip(700).step_by(10) {
        p[0] += 1e-4 * i as f64;
    }
    vec![points.clone(), some, points.clone(), jitter(&points, 0.01, 1)]
}

/// Returns duplicates of which the first leaves.
pub fn leaving<const D: usize>() -> Steps<D> {
    let mut points = uniform::<D>(300, 9);
    (points[50], points[60], points[70]) = (points[5], points[5], points[5]);
    let mut left = points.clone();
    left[5] = [0.5; D];
    vec![points, left]
}

/// Returns a duplicate that moves onto another point.
pub fn changing_sides<const D: usize>() -> Steps<D> {
    let mut points = uniform::<D>(300, 10);
    points[50] = points[5];
    let mut moved = points.clone();
    moved[50] = points[200];
    vec![points, moved]
}

/// Returns points whose scale and place change by many orders of magnitude.
pub fn far_and_back<const D: usize>() -> Steps<D> {
    let points = uniform::<D>(300, 11);
    let at = |by: f64, far: f64| scaled(&points, by).into_iter().map(move |p| p.map(|x| x + far)).collect();
    vec![at(1.0, 0.0), at(1e-300, 0.0), at(1e300, 0.0), at(1.0, 1e9), at(1.0, 0.0)]
}

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
