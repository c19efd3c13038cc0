//! Follows points that move: one JSON object per dimension and displacement.
//!
//! `cargo run --release --example moving [POINTS [BACKEND [STEPS]]]`, by default 5,000 points, the
//! backend `cpu`, and 5 steps, of which the medians are printed, in milliseconds. Displacements are
//! normally distributed, and given as shares of the mean spacing of the points.

use gdel::{Backend, Error, Mesh2, Mesh3, Moving, Triangulator};
use rand::{RngExt, SeedableRng, rngs::StdRng};
use std::{env, f64::consts::TAU, time::Instant};

const DISPLACEMENTS: [f64; 8] = [0.0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1];

fn main() -> Result<(), Error> {
    let mut arguments = env::args().skip(1);
    let points = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(5_000);
    let backend = match arguments.next().as_deref() {
        Some("gpu") => Backend::Gpu,
        Some("auto") => Backend::Auto,
        _ => Backend::Cpu,
    };
    let steps = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(5);
    let triangulator = Triangulator::new().backend(backend);
    follow::<3, Mesh3>(&triangulator, points, steps)?;
    follow::<2, Mesh2>(&triangulator, points, steps)
}

/// The meshes of `D` dimensions.
trait Mesh<const D: usize>: Moving {
    fn triangulate(triangulator: &Triangulator, points: &[[f64; D]]) -> Result<Self, Error>;
    fn update(&mut self, triangulator: &Triangulator, points: &[[f64; D]]) -> Result<(), Error>;
    fn is_same(&self, other: &Self) -> bool;
}

impl Mesh<3> for Mesh3 {
    fn triangulate(triangulator: &Triangulator, points: &[[f64; 3]]) -> Result<Self, Error> {
        triangulator.delaunay3d(points)
    }

    fn update(&mut self, triangulator: &Triangulator, points: &[[f64; 3]]) -> Result<(), Error> {
        triangulator.update(self, points)
    }

    fn is_same(&self, other: &Self) -> bool {
        self.canonical() == other.canonical() && self.duplicate_of == other.duplicate_of
    }
}

impl Mesh<2> for Mesh2 {
    fn triangulate(triangulator: &Triangulator, points: &[[f64; 2]]) -> Result<Self, Error> {
        triangulator.delaunay2d(points)
    }

    fn update(&mut self, triangulator: &Triangulator, points: &[[f64; 2]]) -> Result<(), Error> {
        triangulator.update(self, points)
    }

    fn is_same(&self, other: &Self) -> bool {
        self.canonical() == other.canonical() && self.duplicate_of == other.duplicate_of
    }
}

fn follow<const D: usize, M: Mesh<D>>(triangulator: &Triangulator, points: usize, steps: usize) -> Result<(), Error> {
    let mut random = StdRng::seed_from_u64(1);
    let start: Vec<[f64; D]> = (0..points).map(|_| std::array::from_fn(|_| random.random())).collect();
    let spacing = (points as f64).powf(-1.0 / D as f64);
    for displacement in DISPLACEMENTS {
        let mut at = start.clone();
        let mut mesh = M::triangulate(triangulator, &at)?;
        let (mut updates, mut scratches) = (Vec::new(), Vec::new());
        let mut same = true;
        for _ in 0..steps {
            for x in at.as_flattened_mut() {
                *x += displacement * spacing * gaussian(&mut random);
            }
            let began = Instant::now();
            mesh.update(triangulator, &at)?;
            updates.push(milliseconds(began));
            let began = Instant::now();
            let scratch = M::triangulate(triangulator, &at)?;
            scratches.push(milliseconds(began));
            same &= mesh.is_same(&scratch);
        }
        let update = mesh.stats().update.unwrap_or_default();
        println!(
            "{{\"dimension\":{D},\"points\":{points},\"displacement\":{displacement},\"update\":{:.3},\"scratch\":{:.3},\
             \"inverted\":{},\"notLocallyDelaunay\":{},\"flips\":{},\"stars\":{},\"restarted\":{},\"same\":{same}}}",
            median(updates),
            median(scratches),
            update.inverted,
            update.not_locally_delaunay,
            update.flips,
            update.stars,
            update.restarted.map_or_else(|| "null".to_owned(), |why| format!("{:?}", why.name())),
        );
    }
    Ok(())
}

fn milliseconds(began: Instant) -> f64 {
    1e3 * began.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or_default()
}

/// Returns a normally distributed number.
fn gaussian(random: &mut StdRng) -> f64 {
    let (u, v) = (1.0 - random.random::<f64>(), random.random::<f64>());
    (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
}
