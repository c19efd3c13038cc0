//! Synthetic 3D points: the distributions of the paper's §5.1.
//!
//! The points depend only on the distribution, the number and the seed, bit for bit on every
//! platform: the random numbers are integers of a fixed generator, and everything after them is
//! correctly rounded arithmetic or `libm`'s portable code, never the platform's mathematics
//! library.

use crate::random::{GRID_SIDE, Random, THIN_SPHERE_RADII};

/// The distribution of the points of a synthetic 3D cloud.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[non_exhaustive]
pub enum Distribution {
    /// Uniform in the unit cube [0, 1)³.
    Uniform,
    /// Gaussian: each coordinate normal with mean 0 and variance 1.
    Gaussian,
    /// Uniform in the unit ball.
    Ball,
    /// On the unit sphere, each point as near to it as `f64` allows
    Sphere,
    /// Between two spheres of slightly different radius, 1 and 1.01
    ThinSphere,
    /// Random points of the integer grid 512³, duplicates included
    Grid,
}

impl Distribution {
    /// Every distribution, in the order of the paper's figures.
    pub const ALL: [Distribution; 6] = [
        Distribution::Uniform,
        Distribution::Gaussian,
        Distribution::Ball,
        Distribution::Sphere,
        Distribution::ThinSphere,
        Distribution::Grid,
    ];

    /// Returns the name on the command line, such as `thin-sphere`.
    pub fn name(self) -> &'static str {
        match self {
            Distribution::Uniform => "uniform",
            Distribution::Gaussian => "gaussian",
            Distribution::Ball => "ball",
            Distribution::Sphere => "sphere",
            Distribution::ThinSphere => "thin-sphere",
            Distribution::Grid => "grid",
        }
    }
}

/// Returns `n` random points. The points of a shorter cloud of the same distribution and seed are
/// the first points of a longer one.
pub fn generate(distribution: Distribution, n: usize, seed: u64) -> Vec<[f64; 3]> {
    let mut random = Random::new(seed);
    let point = || match distribution {
        Distribution::Uniform => random.in_cube(),
        Distribution::Gaussian => random.gaussian(),
        Distribution::Ball => random.in_ball(),
        Distribution::Sphere => random.on_sphere(),
        Distribution::ThinSphere => random.in_shell(THIN_SPHERE_RADII),
        Distribution::Grid => random.on_grid(GRID_SIDE),
    };
    std::iter::repeat_with(point).take(n).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::squared_norm;

    /// FNV-1a over the bits of the coordinates.
    fn fingerprint(points: &[[f64; 3]]) -> u64 {
        points
            .as_flattened()
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
    }

    #[test]
    fn points_are_the_same_bit_for_bit_on_every_platform() {
        let found = Distribution::ALL.map(|d| (d.name(), fingerprint(&generate(d, 10_000, 1))));
        let expected = [
            ("uniform", 0x76ef_4af6_27b0_30ee),
            ("gaussian", 0xb9fc_5ae3_4b87_b3c1),
            ("ball", 0x6590_50b7_1874_3a55),
            ("sphere", 0x81b0_e37a_3da6_faa2),
            ("thin-sphere", 0xaceb_e02d_1402_839d),
            ("grid", 0x9952_f624_7645_a41c),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn points_lie_where_the_distribution_says() {
        for seed in 0..4 {
            let all =
                |d, holds: fn([f64; 3]) -> bool| assert!(generate(d, 20_000, seed).into_iter().all(holds), "{d:?}");
            all(Distribution::Uniform, |p| p.iter().all(|x| (0.0..1.0).contains(x)));
            all(Distribution::Gaussian, |p| p.iter().all(|x| x.abs() < 9.0));
            all(Distribution::Ball, |p| squared_norm(p) <= 1.0);
            all(Distribution::Sphere, |p| (squared_norm(p) - 1.0).abs() <= 4.0 * f64::EPSILON);
            all(Distribution::ThinSphere, |p| (0.999_999..1.020_101).contains(&squared_norm(p)));
            all(Distribution::Grid, |p| p.iter().all(|x| x.fract() == 0.0 && (0.0..512.0).contains(x)));
        }
    }

    #[test]
    fn every_axis_has_the_mean_and_variance_of_the_distribution() {
        let moments = |d: Distribution| -> (f64, f64) {
            match d {
                Distribution::Uniform => (0.5, 1.0 / 12.0),
                Distribution::Gaussian => (0.0, 1.0),
                Distribution::Ball => (0.0, 0.2),
                Distribution::Sphere => (0.0, 1.0 / 3.0),
                Distribution::ThinSphere => (0.0, 1.01 / 3.0),
                Distribution::Grid => (255.5, (512.0 * 512.0 - 1.0) / 12.0),
            }
        };
        let n = 100_000;
        for d in Distribution::ALL {
            let (mean, variance) = moments(d);
            let points = generate(d, n, 7);
            for axis in 0..3 {
                let found = points.iter().map(|p| p[axis]).sum::<f64>() / n as f64;
                let spread = points.iter().map(|p| (p[axis] - found).powi(2)).sum::<f64>() / n as f64;
                assert!((found - mean).abs() < 0.02 * variance.sqrt(), "{d:?}: mean {found}");
                assert!((spread / variance - 1.0).abs() < 0.02, "{d:?}: variance {spread}");
            }
        }
    }

    #[test]
    fn a_shorter_cloud_begins_a_longer_one_and_seeds_differ() {
        for d in Distribution::ALL {
            assert_eq!(generate(d, 10, 3), generate(d, 1_000, 3)[..10]);
            assert_ne!(generate(d, 10, 3), generate(d, 10, 4));
            assert!(generate(d, 0, 3).is_empty());
        }
    }

    #[cfg(feature = "cli")]
    #[test]
    fn the_command_line_knows_every_distribution_by_its_name() {
        use clap::ValueEnum;
        assert_eq!(Distribution::value_variants(), Distribution::ALL);
        for d in Distribution::ALL {
            assert_eq!(Distribution::from_str(d.name(), false), Ok(d));
        }
    }
}
