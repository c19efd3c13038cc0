//! Meshes on the device that follow their points.

use crate::{
    input::{Adapter, Space},
    row::{Row, try_timed},
};
use clap::Args;
use gdel::{Backend, DeviceMesh, Editable, Points, internals::dimension::Dimension};
use rand::{RngExt, SeedableRng, rngs::StdRng};
use std::{array, error::Error, f64::consts::TAU};

/// The steps before those that are timed.
const WARM_UP: usize = 2;

/// Time updates of meshes on the device, and the same from scratch.
///
/// All of uniform points in double precision move each time by normally distributed distances.
#[derive(Args)]
pub struct Arguments {
    /// How many points
    #[arg(long, value_delimiter = ',', default_value = "100000,1000000")]
    points: Vec<usize>,
    /// Displacements, as shares of the mean spacing of the points
    #[arg(long, value_delimiter = ',', default_value = "0.002,0.01")]
    share: Vec<f64>,
    /// The dimension of the points
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u8).range(2..=3))]
    dim: u8,
    /// Timed steps
    #[arg(long, default_value_t = 15)]
    runs: usize,
    #[command(flatten)]
    adapter: Adapter,
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    for &points in &arguments.points {
        for &share in &arguments.share {
            let row = match arguments.dim {
                2 => follow::<2>(arguments, points, share),
                _ => follow::<3>(arguments, points, share),
            }?;
            row.print();
        }
    }
    Ok(())
}

fn follow<const D: usize>(arguments: &Arguments, points: usize, share: f64) -> Result<Row, gdel::Error>
where
    Dimension<D>: Space<D>,
    DeviceMesh<D>: Editable<D>,
{
    let mut random = StdRng::seed_from_u64(1);
    let mut at: Vec<[f64; D]> = (0..points).map(|_| array::from_fn(|_| random.random())).collect();
    let displacement = share * (points as f64).powf(-1.0 / D as f64);
    let triangulator = arguments.adapter.triangulator(Backend::Gpu);
    let scratch = |at: &[[f64; D]]| Dimension::<D>::triangulate_resident(&triangulator, Points::F64(at));
    let mut mesh = scratch(&at)?;
    let mut displace = |at: &mut Vec<[f64; D]>| {
        for x in at.as_flattened_mut() {
            *x += displacement * gaussian(&mut random);
        }
    };
    let mut restarts = Vec::new();
    // Runs from scratch have the same pause before them as updates.
    let (mut updates, mut scratches) = (Vec::new(), Vec::new());
    for _ in 0..WARM_UP + arguments.runs {
        displace(&mut at);
        let (time, ()) = try_timed(|| triangulator.update(&mut mesh, Points::F64(&at)))?;
        updates.push(time);
        restarts.push(mesh.stats().update.is_some_and(|update| update.restarted.is_some()));
    }
    for _ in 0..WARM_UP + arguments.runs {
        displace(&mut at);
        let (time, _) = try_timed(|| scratch(&at))?;
        scratches.push(time);
    }
    let adapter = mesh.stats().gpu.as_ref().map(|gpu| gpu.adapter.clone());
    let row = Row::new()
        .with("input", "uniform")
        .with("dimension", D)
        .with("points", points)
        .with("precision", "f64")
        .with("share", share)
        .with("adapter", adapter)
        .with("restarted", restarts[WARM_UP..].iter().filter(|&&restarted| restarted).count())
        .with_times("ms", &updates[WARM_UP..])
        .with_times("scratch_ms", &scratches[WARM_UP..]);
    Ok(row)
}

/// Returns a normally distributed number.
fn gaussian(random: &mut StdRng) -> f64 {
    let (u, v) = (1.0 - random.random::<f64>(), random.random::<f64>());
    (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
}
