//! Synthetic 2D points: the distributions of the paper's §5.6, and some that are difficult.
//!
//! The points depend only on the distribution, the number and the seed, bit for bit on every
//! platform; see [`d3::generate`](mod@crate::d3::generate).

use crate::random::{GRID_SIDE, Random, THIN_SPHERE_RADII};

/// The side of the square in which the points of a cluster lie.
const CLUSTER: f64 = 1e-6;

/// The distribution of the points of a synthetic 2D cloud.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Distribution2 {
    /// Uniform in the unit square [0, 1)².
    Uniform,
    /// Gaussian: each coordinate normal with mean 0 and variance 1.
    Gaussian,
    /// Uniform in the unit disk.
    Disk,
    /// On the unit circle, each point as near to it as `f64` allows.
    Circle,
    /// Between two circles of slightly different radius, 1 and 1.01.
    ThinCircle,
    /// Random points of the integer grid 512², duplicates included.
    Grid,
    /// Alternating between two parallel segments of length 1 at distance 1.
    TwoLines,
    /// In 64 squares of side 10⁻⁶, whose corners are the points of an 8×8 integer grid.
    Clusters,
}

impl Distribution2 {
    /// Every distribution.
    pub const ALL: [Distribution2; 8] = [
        Distribution2::Uniform,
        Distribution2::Gaussian,
        Distribution2::Disk,
        Distribution2::Circle,
        Distribution2::ThinCircle,
        Distribution2::Grid,
        Distribution2::TwoLines,
        Distribution2::Clusters,
    ];

    /// Returns the name on the command line, such as `thin-circle`.
    pub fn name(self) -> &'static str {
        match self {
            Distribution2::Uniform => "uniform",
            Distribution2::Gaussian => "gaussian",
            Distribution2::Disk => "disk",
            Distribution2::Circle => "circle",
            Distribution2::ThinCircle => "thin-circle",
            Distribution2::Grid => "grid",
            Distribution2::TwoLines => "two-lines",
            Distribution2::Clusters => "clusters",
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// FNV-1a over the bits of the coordinates.
    fn fingerprint(points: &[[f64; 2]]) -> u64 {
        let bytes = points.as_flattened().iter().flat_map(|x| x.to_le_bytes());
        bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
    }

    #[test]
    fn points_lie_where_the_distribution_says() {
        let norm = |p: [f64; 2]| p[0] * p[0] + p[1] * p[1];
        let all = |d, holds: &dyn Fn([f64; 2]) -> bool| {
            assert!(generate2d(d, 10_000, 1).into_iter().all(holds), "{d:?}");
        };
        all(Distribution2::Uniform, &|p| p.iter().all(|x| (0.0..1.0).contains(x)));
        all(Distribution2::Gaussian, &|p| p.iter().all(|x| x.abs() < 9.0));
        all(Distribution2::Disk, &|p| norm(p) <= 1.0);
        all(Distribution2::Circle, &|p| (norm(p) - 1.0).abs() <= 4.0 * f64::EPSILON);
        all(Distribution2::ThinCircle, &|p| (0.999_999..1.020_101).contains(&norm(p)));
        all(Distribution2::Grid, &|p| p.iter().all(|x| x.fract() == 0.0 && (0.0..512.0).contains(x)));
        all(Distribution2::TwoLines, &|p| (0.0..1.0).contains(&p[0]) && (p[1] == 0.0 || p[1] == 1.0));
        all(Distribution2::Clusters, &|p| p.iter().all(|x| (0.0..8.0).contains(x) && x.fract() <= CLUSTER));
    }

    #[test]
    fn a_shorter_cloud_begins_a_longer_one_and_seeds_differ() {
        for d in Distribution2::ALL {
            assert_eq!(generate2d(d, 10, 3), generate2d(d, 1_000, 3)[..10]);
            assert_ne!(fingerprint(&generate2d(d, 10, 3)), fingerprint(&generate2d(d, 10, 4)));
        }
    }
}
