//! Closed surfaces through the points of scans.

use crate::{
    input::{Cloud, Source},
    row::{Row, repeated, try_timed},
};
use clap::Args;
use gdel::{Backend, Surface, SurfaceOptions, Triangulator};
use rayon::ThreadPoolBuilder;
use std::{
    error::Error,
    hash::{DefaultHasher, Hash, Hasher},
    num::NonZeroUsize,
};

/// Time closed surfaces, and the triangulations that they are made of, in 3D.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    source: Source,
    /// How many threads work; by default as many as there are processors
    #[arg(long)]
    threads: Option<usize>,
    /// How often the points are moved onto quadrics; by default noise decides
    #[arg(long)]
    smooth: Option<u32>,
    /// Timed runs
    #[arg(long, default_value = "3")]
    runs: NonZeroUsize,
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    // What shares work does so in the pool in which it is called.
    let pool = ThreadPoolBuilder::new().num_threads(arguments.threads.unwrap_or(0)).build()?;
    for cloud in arguments.source.clouds::<3>() {
        let cloud = cloud?;
        pool.install(|| measure(arguments, &cloud))?.print();
    }
    Ok(())
}

fn measure(arguments: &Arguments, cloud: &Cloud<3>) -> Result<Row, gdel::Error> {
    let points = cloud.points();
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    let (triangulate, mesh) = repeated(arguments.runs, 0.0, || try_timed(|| triangulator.delaunay3d(points)))?;
    let mut options = SurfaceOptions::default();
    options.smooth = arguments.smooth;
    let (times, surface) = repeated(arguments.runs, 0.0, || try_timed(|| Surface::new(&mesh, points, &options)))?;
    // One number that tells whether two programs found the same surface.
    let mut hash = DefaultHasher::new();
    let mut solid = surface.solid().to_vec();
    solid.iter_mut().for_each(|simplex| simplex.sort_unstable());
    solid.sort_unstable();
    (solid, surface.facets(), surface.sources()).hash(&mut hash);
    let row = Row::new()
        .with("input", cloud.name.as_str())
        .with("points", points.len())
        .with("precision", cloud.precision())
        .with("threads", rayon::current_num_threads())
        .with("tetrahedra", mesh.tetrahedra.len())
        .with_times("triangulate_ms", &triangulate)
        .with_times("surface_ms", &times)
        .with("triangles", surface.facets().len())
        .with("genus", surface.genus())
        .with("noise", surface.noise())
        .with("hash", format!("{:016x}", hash.finish()));
    Ok(row)
}
