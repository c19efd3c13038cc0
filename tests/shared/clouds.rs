//! Point clouds that make other codes crash or return wrong meshes.
#![allow(dead_code)]

use gdel::internals::d3::generate::{Distribution3, generate3d};
use std::f64::consts::TAU;

/// Returns the integer grid with `side` points along each axis, x first.
pub fn grid(side: u32) -> Vec<[f64; 3]> {
    (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side / side].map(f64::from)).collect()
}

/// Returns the same points under other indices.
pub fn shuffled(points: &[[f64; 3]], seed: u64) -> Vec<[f64; 3]> {
    let keys = generate3d(Distribution3::Uniform, points.len(), seed);
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| keys[i][0].total_cmp(&keys[j][0]));
    order.into_iter().map(|i| points[i]).collect()
}

/// Returns `n` random points of a 64³ grid, many of them several times.
pub fn grid_64_with_duplicates(n: usize) -> Vec<[f64; 3]> {
    generate3d(Distribution3::Grid, n, 1).iter().map(|p| p.map(|x| x % 64.0)).collect()
}

/// Returns `n` points on each of two skew lines: every segment of one line makes a tetrahedron with
/// every segment of the other.
pub fn two_skew_lines(n: u32) -> Vec<[f64; 3]> {
    let middle = f64::from(n) / 2.0;
    (0..n).flat_map(|i| [[f64::from(i), 0.0, 0.0], [middle, f64::from(i) - middle - 0.5, 40.0]]).collect()
}

/// Returns a raster of `side` × `side` heights, as terrain is most often stored, in steps of
/// `step`; with 0, heights are as fine as `f64` has them.
pub fn raster(side: u32, step: f64) -> Vec<[f64; 3]> {
    let noise = generate3d(Distribution3::Uniform, (side * side) as usize, 1);
    let height = |i: u32| {
        let [x, y] = [i % side, i / side].map(f64::from);
        let z = 9.0 * libm::sin(0.11 * x) * libm::cos(0.07 * y) + 4.0 * noise[i as usize][0];
        [x, y, if step > 0.0 { libm::rint(z / step) * step } else { z }]
    };
    (0..side * side).map(height).collect()
}

/// Returns a raster like [`raster`], of smooth and steep terrain.
pub fn terrain(side: u32, phase: f64, step: f64) -> Vec<[f64; 3]> {
    let height = |i: u32| {
        let [x, y] = [i % side, i / side].map(f64::from);
        let z = 40.0 * libm::sin(0.05 * x + phase) * libm::cos(0.04 * y) + 0.1 * x;
        [x, y, if step > 0.0 { libm::rint(z / step) * step } else { z }]
    };
    (0..side * side).map(height).collect()
}

/// Returns `n` points of the moment curve (t, t², t³), every two of which are neighbours.
pub fn moment_curve(n: u32) -> Vec<[f64; 3]> {
    (0..n).map(|i| f64::from(i) / f64::from(n)).map(|t| [t, t * t, t * t * t]).collect()
}

/// Returns `n` points on a cylinder, in rings of 25.
pub fn cylinder(n: u32) -> Vec<[f64; 3]> {
    let at = |i: u32| {
        let angle = TAU * f64::from(i % 25) / 25.0;
        [libm::cos(angle), libm::sin(angle), f64::from(i / 25) / 8.0]
    };
    (0..n).map(at).collect()
}

/// Returns `n` points on a circle, and as many on its axis.
pub fn circle_and_its_axis(n: u32) -> Vec<[f64; 3]> {
    let circle = (0..n).map(|i| {
        let angle = TAU * f64::from(i) / f64::from(n);
        [libm::cos(angle), libm::sin(angle), 0.0]
    });
    let axis = (0..n).map(|i| [0.0, 0.0, (f64::from(i) - f64::from(n - 1) / 2.0) * 4.0 / f64::from(n)]);
    circle.chain(axis).collect()
}

/// Returns all 36 integer points at distance 65 from the origin, exactly cocircular, and 100 points
/// of their axis.
pub fn circle_of_integers_and_its_axis() -> Vec<[f64; 3]> {
    let circle =
        (-65..=65).flat_map(|x| (-65..=65).map(move |y| [x, y, 0])).filter(|[x, y, _]| x * x + y * y == 65 * 65);
    circle.chain((-50..50).map(|z| [0, 0, z])).map(|p| p.map(f64::from)).collect()
}

/// Returns `n` points around 40 places, about 1e-9 apart.
pub fn clusters_at_1e_9_spacing(n: usize) -> Vec<[f64; 3]> {
    let centers = generate3d(Distribution3::Uniform, 40, 1);
    let within = generate3d(Distribution3::Gaussian, n, 2);
    let near =
        |(i, p): (usize, &[f64; 3])| std::array::from_fn(|axis| centers[i % centers.len()][axis] + 1e-9 * p[axis]);
    within.iter().enumerate().map(near).collect()
}

/// Returns grids of spacing 2⁻³⁰, so exactly cospherical, at corners of the unit cube.
pub fn grids_at_1e_9_spacing(side: u32) -> Vec<[f64; 3]> {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 1.0]];
    let near = |p: [f64; 3]| corners.map(|c| [0, 1, 2].map(|i| c[i] + p[i] / (1u64 << 30) as f64));
    grid(side).into_iter().flat_map(near).collect()
}

/// Returns `n` points like the eastings, northings and heights of an airborne scan, in whole
/// millimetres.
pub fn survey(n: usize) -> Vec<[f64; 3]> {
    let millimetres = |x: f64| libm::rint(x * 1000.0) / 1000.0;
    let at = |[x, y, z]: [f64; 3]| [1e7 + 400.0 * x, 1e7 + 400.0 * y, 300.0 + 5.0 * z].map(millimetres);
    generate3d(Distribution3::Uniform, n, 3).into_iter().map(at).collect()
}

/// Returns `n` points of a plane at 1e7, and one post.
pub fn flat_ground(n: usize) -> Vec<[f64; 3]> {
    let mut points: Vec<_> = survey(n).iter().map(|&[x, y, _]| [x, y, 300.0]).collect();
    points.push([1e7 + 200.0, 1e7 + 200.0, 301.5]);
    points
}

/// Returns `10 n` points, of which `3 n` are duplicates.
pub fn thirty_percent_duplicates(n: usize) -> Vec<[f64; 3]> {
    let distinct = generate3d(Distribution3::Uniform, 7 * n, 1);
    let points: Vec<_> = distinct.iter().chain(&distinct[..3 * n]).copied().collect();
    shuffled(&points, 1)
}
