//! Updates a mesh on the device while its points move, and compares the times with runs from scratch:
//! one JSON object per dimension and displacement.
//!
//! `cargo run --release --example moving [POINTS [STEPS]]`, by default 5,000 points and 5 steps, of
//! which the medians are printed, in milliseconds. Displacements are normally distributed, and given
//! as shares of the mean spacing of the points.

use gdel::{
    DeviceMesh2, DeviceMesh3, DeviceTriangulator, Editable, Error, Outputs, Points, Triangulator, stats::Stats,
};
use rand::{RngExt, SeedableRng, rngs::StdRng};
use std::{env, f64::consts::TAU, time::Instant};

const DISPLACEMENTS: [f64; 8] = [0.0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1];

fn main() -> Result<(), Error> {
    let mut arguments = env::args().skip(1);
    let points = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(5_000);
    let steps = arguments.next().and_then(|n| n.parse().ok()).unwrap_or(5);
    let triangulator = Triangulator::new();
    follow::<3, DeviceMesh3>(&triangulator, points, steps)?;
    follow::<2, DeviceMesh2>(&triangulator, points, steps)
}

/// The meshes of `D` dimensions.
trait Mesh<const D: usize>: Editable<D> {
    fn triangulate(device: &DeviceTriangulator, points: &[[f64; D]]) -> Result<Self, Error>;
    fn stats(&self) -> &Stats;
    fn is_same(&self, other: &Self) -> Result<bool, Error>;
}

macro_rules! mesh {
    ($D:literal, $mesh:ident, $triangulate:ident) => {
        impl Mesh<$D> for $mesh {
            fn triangulate(device: &DeviceTriangulator, points: &[[f64; $D]]) -> Result<Self, Error> {
                device.$triangulate(points)
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
mesh!(3, DeviceMesh3, delaunay3d);
mesh!(2, DeviceMesh2, delaunay2d);

fn follow<const D: usize, M: Mesh<D>>(triangulator: &Triangulator, points: usize, steps: usize) -> Result<(), Error> {
    let device = triangulator.device()?;
    let mut random = StdRng::seed_from_u64(1);
    let start: Vec<[f64; D]> = (0..points).map(|_| std::array::from_fn(|_| random.random())).collect();
    let spacing = (points as f64).powf(-1.0 / D as f64);
    for displacement in DISPLACEMENTS {
        let mut at = start.clone();
        let mut mesh = M::triangulate(&device, &at)?;
        let (mut updates, mut scratches) = (Vec::new(), Vec::new());
        let mut scratch = M::triangulate(&device, &at)?;
        for _ in 0..steps {
            for x in at.as_flattened_mut() {
                *x += displacement * spacing * gaussian(&mut random);
            }
            let began = Instant::now();
            triangulator.update(&mut mesh, Points::F64(&at))?;
            updates.push(milliseconds(began));
            let began = Instant::now();
            scratch = M::triangulate(&device, &at)?;
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
