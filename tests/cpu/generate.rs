//! Synthetic points: where they lie, and that they stay the same for good.

use gdel::internals::{
    d2::generate::{Distribution2, generate2d},
    d3::generate::{Distribution3, generate3d},
};

/// FNV-1a over the bits of the coordinates.
fn fingerprint<const D: usize>(points: &[[f64; D]]) -> u64 {
    let bytes = points.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

fn squared_norm<const D: usize>(p: [f64; D]) -> f64 {
    p.iter().map(|x| x * x).sum()
}

#[test]
fn points_are_the_same_bit_for_bit_on_every_platform() {
    let found = Distribution3::ALL.map(|d| (d.name(), fingerprint(&generate3d(d, 10_000, 1))));
    let expected = [
        ("uniform", 0x76ef_4af6_27b0_30ee),
        ("gaussian", 0xb9fc_5ae3_4b87_b3c1),
        ("ball", 0x6590_50b7_1874_3a55),
        ("sphere", 0x81b0_e37a_3da6_faa2),
        ("thin-sphere", 0xaceb_e02d_1402_839d),
        ("grid", 0x9952_f624_7645_a41c),
    ];
    assert_eq!(found, expected);
    let found = Distribution2::ALL.map(|d| (d.name(), fingerprint(&generate2d(d, 10_000, 1))));
    let expected = [
        ("uniform", 0xe878_3384_bd30_2a50),
        ("gaussian", 0x8b8e_d835_bea4_4235),
        ("disk", 0xbeac_eaee_ae93_d0fd),
        ("circle", 0x0063_ed82_dea5_e21c),
        ("thin-circle", 0x7bea_4010_7f3a_bdcd),
        ("grid", 0x5455_5015_364c_81c0),
        ("two-lines", 0x77f2_0185_c2cb_4ca2),
        ("clusters", 0x4474_5872_fdb6_33e1),
    ];
    assert_eq!(found, expected);
}

#[test]
fn points_in_3d_lie_where_the_distribution_says() {
    for seed in 0..4 {
        let all = |d, holds: fn([f64; 3]) -> bool| {
            assert!(generate3d(d, 20_000, seed).into_iter().all(holds), "{d:?}");
        };
        all(Distribution3::Uniform, |p| p.iter().all(|x| (0.0..1.0).contains(x)));
        all(Distribution3::Gaussian, |p| p.iter().all(|x| x.abs() < 9.0));
        all(Distribution3::Ball, |p| squared_norm(p) <= 1.0 + f64::EPSILON);
        all(Distribution3::Sphere, |p| (squared_norm(p) - 1.0).abs() <= 4.0 * f64::EPSILON);
        all(Distribution3::ThinSphere, |p| (0.999_999..1.020_101).contains(&squared_norm(p)));
        all(Distribution3::Grid, |p| p.iter().all(|x| x.fract() == 0.0 && (0.0..512.0).contains(x)));
    }
}

#[test]
fn points_in_2d_lie_where_the_distribution_says() {
    let all = |d, holds: fn([f64; 2]) -> bool| {
        assert!(generate2d(d, 10_000, 1).into_iter().all(holds), "{d:?}");
    };
    all(Distribution2::Uniform, |p| p.iter().all(|x| (0.0..1.0).contains(x)));
    all(Distribution2::Gaussian, |p| p.iter().all(|x| x.abs() < 9.0));
    all(Distribution2::Disk, |p| squared_norm(p) <= 1.0 + f64::EPSILON);
    all(Distribution2::Circle, |p| (squared_norm(p) - 1.0).abs() <= 4.0 * f64::EPSILON);
    all(Distribution2::ThinCircle, |p| (0.999_999..1.020_101).contains(&squared_norm(p)));
    all(Distribution2::Grid, |p| p.iter().all(|x| x.fract() == 0.0 && (0.0..512.0).contains(x)));
    all(Distribution2::TwoLines, |p| (0.0..1.0).contains(&p[0]) && (p[1] == 0.0 || p[1] == 1.0));
    all(Distribution2::Clusters, |p| p.iter().all(|x| (0.0..8.0).contains(x) && x.fract() <= 1e-6));
}

#[test]
fn every_axis_has_the_mean_and_variance_of_the_distribution() {
    let moments = |d: Distribution3| -> (f64, f64) {
        match d {
            Distribution3::Uniform => (0.5, 1.0 / 12.0),
            Distribution3::Gaussian => (0.0, 1.0),
            Distribution3::Ball => (0.0, 0.2),
            Distribution3::Sphere => (0.0, 1.0 / 3.0),
            Distribution3::ThinSphere => (0.0, 1.01 / 3.0),
            Distribution3::Grid => (255.5, (512.0 * 512.0 - 1.0) / 12.0),
            _ => panic!("the moments of {d:?} are missing"),
        }
    };
    let n = 100_000;
    for d in Distribution3::ALL {
        let (mean, variance) = moments(d);
        let points = generate3d(d, n, 7);
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
    for d in Distribution2::ALL {
        assert_eq!(generate2d(d, 10, 3), generate2d(d, 1_000, 3)[..10]);
        assert_ne!(generate2d(d, 10, 3), generate2d(d, 10, 4));
        assert!(generate2d(d, 0, 3).is_empty());
    }
    for d in Distribution3::ALL {
        assert_eq!(generate3d(d, 10, 3), generate3d(d, 1_000, 3)[..10]);
        assert_ne!(generate3d(d, 10, 3), generate3d(d, 10, 4));
        assert!(generate3d(d, 0, 3).is_empty());
    }
}
