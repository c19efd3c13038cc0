//! Queries of meshes on the device.

use crate::{
    input::Adapter,
    row::{Row, microseconds, repeated, timed, try_timed},
};
use clap::Args;
use gdel::{
    DeviceLocator, Locator, Outputs, Points, Triangulator,
    internals::{
        d3::generate::{Distribution3, generate3d},
        gpu::Storage,
    },
};
use std::{error::Error, num::NonZeroUsize};

/// Time queries of a 3D mesh on the device.
///
/// Points and queries are uniform, unsorted and of single precision; the
/// answers are compared with those of the host.
#[derive(Args)]
pub struct Arguments {
    /// How many points
    #[arg(long, default_value_t = 1_000_000)]
    points: usize,
    /// How many queries
    #[arg(long, default_value_t = 10_000_000)]
    queries: usize,
    /// Timed runs, of which the median counts
    #[arg(long, default_value = "5")]
    runs: NonZeroUsize,
    #[command(flatten)]
    adapter: Adapter,
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let gpu = arguments.adapter.open()?;
    let single = |count, seed| -> Vec<[f32; 3]> {
        generate3d(Distribution3::Uniform, count, seed).iter().map(|p| p.map(|x| x as f32)).collect()
    };
    let (points, queries) = (single(arguments.points, 1), single(arguments.queries, 2));
    let triangulator = Triangulator::from_device(gpu.device().clone(), gpu.queue().clone());
    let mesh = triangulator.device()?.delaunay3d(&points)?;

    let runs = arguments.runs;
    let (create, locator) = repeated(runs, 1.0, || try_timed(|| DeviceLocator::new(&mesh, &points)))?;
    let (arrays, answers) = repeated(runs, 1.0, || try_timed(|| locator.locate_many(&queries)))?;
    let buffer = Storage::with_contents(&gpu, "queries", queries.as_flattened())?;
    let (buffers, _) = repeated(runs, 1.0, || try_timed(|| locator.locate_buffer(buffer.buffer())))?;
    let (circumspheres, _) = repeated(runs, 1.0, || try_timed(|| locator.circumspheres_buffer()))?;
    let read = mesh.read(Outputs::ALL)?;
    let on_host = Locator::new(&read, &points)?;
    let (host, expected) = timed(|| on_host.locate_many(Points::F32(&queries)));
    if !answers.iter().eq(expected?) {
        return Err("the answers are not those of the host".into());
    }
    Row::new()
        .with("adapter", gpu.adapter().name.as_str())
        .with("input", "uniform")
        .with("points", arguments.points)
        .with("queries", arguments.queries)
        .with("precision", "f32")
        .with("host_answers", locator.host_answers())
        .with_times("ms", &arrays)
        .with_times("buffers_ms", &buffers)
        .with_times("create_ms", &create)
        .with_times("circumspheres_ms", &circumspheres)
        .with("host_ms", microseconds(host))
        .print();
    Ok(())
}
