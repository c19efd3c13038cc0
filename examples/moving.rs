//! Follows points that move: one JSON object per dimension and displacement.
//!
//! `cargo run --release --example moving [POINTS [BACKEND [STEPS]]]`, by default 5,000 points, the
//! backend `cpu`, and 5 steps, of which the medians are printed, in milliseconds. With the backends
//! `gpu` and `auto` the meshes stay on the device. Displacements are normally distributed, and given
//! as shares of the mean spacing of the points.

use gdel::{Backend, DeviceMesh2, DeviceMesh3, Error, Mesh2, Mesh3, Outputs, Triangulator, stats::Stats};
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
    if backend == Backend::Cpu {
        follow::<3, Mesh3>(&triangulator, points, steps)?;
        follow::<2, Mesh2>(&triangulator, points, steps)
    } else {
        follow::<3, DeviceMesh3>(&triangulator, points, steps)?;
        follow::<2, DeviceMesh2>(&triangulator, points, steps)
    }
}

/// The meshes of `D` dimensions.
trait Mesh<const D: usize>: Sized {
    fn triangulate(triangulator: &Triangulator, points: &[[f64; D]]) -> Result<Self, Error>;
    fn update(&mut self, triangulator: &Triangulator, points: &[[f64; D]]) -> Result<(), Error>;
    fn stats(&self) -> &Stats;
    fn is_same(&self, other: &Self) -> Result<bool, Error>;
}

macro_rules! on_host {
    ($D:literal, $mesh:ident, $triangulate:ident) => {
        impl Mesh<$D> for $mesh {
            fn triangulate(triangulator: &Triangulator, points: &[[f64; $D]]) -> Result<Self, Error> {
                triangulator.$triangulate(points)
            }

            fn update(&mut self, triangulator: &Triangulator, points: &[[f64; $D]]) -> Result<(), Error> {
                triangulator.update(self, points)
            }

            fn stats(&self) -> &Stats {
                &self.stats
            }

            fn is_same(&self, other: &Self) -> Result<bool, Error> {
                Ok(self.canonical() == other.canonical() && self.duplicate_of == other.duplicate_of)
            }
        }
    };
}
on_host!(3, Mesh3, delaunay3d);
on_host!(2, Mesh2, delaunay2d);

/// On the device, the arrays are read only to compare them.
macro_rules! on_device {
    ($D:literal, $mesh:ident, $triangulate:ident) => {
        impl Mesh<$D> for $mesh {
            fn triangulate(triangulator: &Triangulator, points: &[[f64; $D]]) -> Result<Self, Error> {
                triangulator.$triangulate(points)
            }

            fn update(&mut self, triangulator: &Triangulator, points: &[[f64; $D]]) -> Result<(), Error> {
                triangulator.update(self, points)
            }

            fn stats(&self) -> &Stats {
                $mesh::stats(self)
            }

            fn is_same(&self, other: &Self) -> Result<bool, Error> {
                let [mesh, other] = [self.read(Outputs::SIMPLICES)?, other.read(Outputs::SIMPLICES)?];
                Ok(mesh.canonical() == other.canonical() && mesh.duplicate_of == other.duplicate_of)
            }
        }
    };
}
on_device!(3, DeviceMesh3, delaunay3d_on_device);
on_device!(2, DeviceMesh2, delaunay2d_on_device);

fn follow<const D: usize, M: Mesh<D>>(triangulator: &Triangulator, points: usize, steps: usize) -> Result<(), Error> {
    let mut random = StdRng::seed_from_u64(1);
    let start: Vec<[f64; D]> = (0..points).map(|_| std::array::from_fn(|_| random.random())).collect();
    let spacing = (points as f64).powf(-1.0 / D as f64);
    for displacement in DISPLACEMENTS {
        let mut at = start.clone();
        let mut mesh = M::triangulate(triangulator, &at)?;
        let (mut updates, mut scratches) = (Vec::new(), Vec::new());
        let mut scratch = M::triangulate(triangulator, &at)?;
        for _ in 0..steps {
            for x in at.as_flattened_mut() {
                *x += displacement * spacing * gaussian(&mut random);
            }
            let began = Instant::now();
            mesh.update(triangulator, &at)?;
            updates.push(milliseconds(began));
            let began = Instant::now();
            scratch = M::triangulate(triangulator, &at)?;
            scratches.push(milliseconds(began));
        }
        // To compare them takes longer than all steps, in which a GPU would get slow.
        let same = mesh.is_same(&scratch)?;
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
