//! Synthetic 3D points: the distributions of the paper's §5.1.
//!
//! The points depend only on the distribution, the number and the seed, bit for bit on every
//! platform: the random numbers are integers of a fixed generator, and everything after them is
//! correctly rounded arithmetic or `libm`'s portable code, never the platform's mathematics
//! library.

use crate::random::{GRID_SIDE, Random, THIN_SPHERE_RADII, distributions};

distributions! {
    /// The distribution of the points of a synthetic 3D cloud, in the order of the paper's figures.
    pub enum Distribution3 {
        /// Uniform in the unit cube [0, 1)³.
        Uniform = "uniform",
        /// Gaussian: each coordinate normal with mean 0 and variance 1.
        Gaussian = "gaussian",
        /// Uniform in the unit ball.
        Ball = "ball",
        /// On the unit sphere, each point as near to it as `f64` allows.
        Sphere = "sphere",
        /// Between two spheres of slightly different radius, 1 and 1.01.
        ThinSphere = "thin-sphere",
        /// Random points of the integer grid 512³, duplicates included.
        Grid = "grid",
    }
}

/// Returns `n` random points. The points of a shorter cloud of the same distribution and seed are
/// the first points of a longer one.
pub fn generate3d(distribution: Distribution3, n: usize, seed: u64) -> Vec<[f64; 3]> {
    let mut random = Random::new(seed);
    let point = || match distribution {
        Distribution3::Uniform => random.in_cube(),
        Distribution3::Gaussian => random.gaussian(),
        Distribution3::Ball => random.in_ball(),
        Distribution3::Sphere => random.on_sphere(),
        Distribution3::ThinSphere => random.in_shell(THIN_SPHERE_RADII),
        Distribution3::Grid => random.on_grid(GRID_SIDE),
    };
    std::iter::repeat_with(point).take(n).collect()
}
