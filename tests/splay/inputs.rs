//! Point clouds of many kinds, of distinct points only.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub type Cloud = Vec<[f64; 3]>;

pub fn random(seed: u64) -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(seed)
}

pub fn distinct(mut points: Cloud) -> Cloud {
    let mut seen = std::collections::HashSet::new();
    points.retain(|p| seen.insert(p.map(|x| (x + 0.0).to_bits())));
    points
}

fn cloud(n: usize, seed: u64, mut point: impl FnMut(&mut Pcg64Mcg) -> [f64; 3]) -> Cloud {
    let mut rng = random(seed);
    distinct((0..n).map(|_| point(&mut rng)).collect())
}

pub fn uniform(n: usize, seed: u64) -> Cloud {
    cloud(n, seed, rand::RngExt::random)
}

fn normal(rng: &mut Pcg64Mcg) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

pub fn gaussian(n: usize, seed: u64) -> Cloud {
    cloud(n, seed, |rng| [normal(rng), normal(rng), normal(rng)])
}

fn direction(rng: &mut Pcg64Mcg) -> [f64; 3] {
    let p = [normal(rng), normal(rng), normal(rng)];
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    p.map(|x| x / length)
}

pub fn ball(n: usize, seed: u64) -> Cloud {
    cloud(n, seed, |rng| {
        let r = rng.random::<f64>().cbrt();
        direction(rng).map(|x| x * r)
    })
}

pub fn sphere(n: usize, seed: u64) -> Cloud {
    cloud(n, seed, direction)
}

pub fn thin_sphere(n: usize, seed: u64) -> Cloud {
    cloud(n, seed, |rng| {
        let r = 1.0 + 0.01 * rng.random::<f64>();
        direction(rng).map(|x| x * r)
    })
}

pub fn grid(side: usize) -> Cloud {
    (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side.pow(2)].map(|x| x as f64)).collect()
}

pub fn grid_sample(n: usize, side: u32, seed: u64) -> Cloud {
    cloud(n, seed, |rng| std::array::from_fn(|_| f64::from(rng.random_range(0..side))))
}

pub fn skew_lines(n: usize, seed: u64) -> Cloud {
    cloud(n, seed, |rng| {
        let t = rng.random::<f64>();
        if rng.random() { [t, 0.0, 0.0] } else { [0.0, t, 1.0] }
    })
}

pub fn clusters(n: usize, seed: u64) -> Cloud {
    let centers = uniform(8, seed ^ 1);
    cloud(n, seed, |rng| {
        let center = centers[rng.random_range(0..centers.len())];
        center.map(|x| x + 1e-4 * normal(rng))
    })
}

/// Points on the surface of a cube, many of them coplanar and collinear.
pub fn prism(n: usize, seed: u64) -> Cloud {
    cloud(n, seed, |rng| {
        let mut p: [f64; 3] = std::array::from_fn(|_| f64::from(rng.random_range(0..=32u32)) / 32.0);
        let axis = rng.random_range(0..3);
        p[axis] = p[axis].round();
        p
    })
}
