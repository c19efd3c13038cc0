//! Synthetic 2D points: the distributions of the paper's §5.6, and some that are difficult.
//!
//! The points depend only on the distribution, the number and the seed, bit for bit on every
//! platform; see [`d3::generate`](mod@crate::d3::generate).

use crate::random::{GRID_SIDE, Random, THIN_SPHERE_RADII, distributions};

/// The side of the square in which the points of a cluster lie.
const CLUSTER: f64 = 1e-6;

distributions! {
    /// The distribution of the points of a synthetic 2D cloud.
    pub enum Distribution2 {
        /// Uniform in the unit square [0, 1)².
        Uniform = "uniform",
        /// Gaussian: each coordinate normal with mean 0 and variance 1.
        Gaussian = "gaussian",
        /// Uniform in the unit disk.
        Disk = "disk",
        /// On the unit circle, each point as near to it as `f64` allows.
        Circle = "circle",
        /// Between two circles of slightly different radius, 1 and 1.01.
        ThinCircle = "thin-circle",
        /// Random points of the integer grid 512², duplicates included.
        Grid = "grid",
        /// Alternating between two parallel segments of length 1 at distance 1.
        TwoLines = "two-lines",
        /// In 64 squares of side 10⁻⁶, whose corners are the points of an 8×8 integer grid.
        Clusters = "clusters",
    }
}

/// Returns `n` random points. The points of a shorter cloud of the same distribution and seed are
/// the first points of a longer one.
pub fn generate2d(distribution: Distribution2, n: usize, seed: u64) -> Vec<[f64; 2]> {
    let mut random = Random::new(seed);
    let point = |i: usize| match distribution {
        Distribution2::Uniform => random.in_cube(),
        Distribution2::Gaussian => random.gaussian(),
        Distribution2::Disk => random.in_ball(),
        Distribution2::Circle => random.on_sphere(),
        Distribution2::ThinCircle => {
            let direction: [f64; 2] = random.on_sphere();
            let [inner, outer] = THIN_SPHERE_RADII.map(|r| r * r);
            // Uniform in area.
            let radius = (inner + random.unit() * (outer - inner)).sqrt();
            direction.map(|x| x * radius)
        }
        Distribution2::Grid => random.on_grid(GRID_SIDE),
        Distribution2::TwoLines => [random.unit(), (i % 2) as f64],
        Distribution2::Clusters => {
            let [x, y] = random.on_grid(8);
            let [dx, dy] = random.in_cube();
            [x + CLUSTER * dx, y + CLUSTER * dy]
        }
    };
    (0..n).map(point).collect()
}
