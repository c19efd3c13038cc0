//! Point clouds in 3D and 2D. The tests of `gdel::generate` pin the random ones.

use gdel::internals::{
    d2::generate::{Distribution2, generate2d},
    d3::generate::{Distribution3, generate3d},
};

/// The points of each cloud, but for the grids.
pub const POINTS: usize = 10_000;

/// The points where each costs much.
pub const FEW: usize = 1500;

pub fn uniform() -> Vec<[f64; 3]> {
    generate3d(Distribution3::Uniform, POINTS, 1)
}

pub fn sphere(points: usize) -> Vec<[f64; 3]> {
    generate3d(Distribution3::Sphere, points, 1)
}

/// Returns all points of a grid: 22³ is about [`POINTS`], 11³ about [`FEW`].
pub fn grid(side: u32) -> Vec<[f64; 3]> {
    (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side.pow(2)].map(f64::from)).collect()
}

/// Returns points in 64 cubes of side 10⁻⁶.
pub fn clusters() -> Vec<[f64; 3]> {
    let centers = generate3d(Distribution3::Uniform, 64, 2);
    let offsets = generate3d(Distribution3::Uniform, POINTS, 3).into_iter();
    let around = |(i, offset): (usize, [f64; 3])| {
        let center = centers[i % centers.len()];
        std::array::from_fn(|axis| center[axis] + 1e-6 * offset[axis])
    };
    offsets.enumerate().map(around).collect()
}

pub fn uniform2() -> Vec<[f64; 2]> {
    generate2d(Distribution2::Uniform, POINTS, 1)
}

pub fn circle2() -> Vec<[f64; 2]> {
    generate2d(Distribution2::Circle, POINTS, 1)
}

/// Returns all points of a grid: 100².
pub fn grid2() -> Vec<[f64; 2]> {
    (0..10_000u32).map(|i| [i % 100, i / 100].map(f64::from)).collect()
}

pub fn clusters2() -> Vec<[f64; 2]> {
    generate2d(Distribution2::Clusters, POINTS, 1)
}

/// Returns points in single precision, as most files have them.
pub fn single(points: &[[f64; 3]]) -> Vec<[f32; 3]> {
    points.iter().map(|p| p.map(|x| x as f32)).collect()
}
