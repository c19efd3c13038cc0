//! What is derived from a mesh in host memory.

use crate::row::{Row, microseconds, milliseconds};
use clap::Args;
use gdel::{
    AlphaShape, Backend, Clip, Interpolation, Interpolator, Locator, SpanningTree, Triangulator, Voronoi,
    internals::d3::generate::{Distribution3, generate3d},
};
use rayon::ThreadPoolBuilder;
use std::{error::Error, time::Instant};

/// Time what is derived from a mesh of uniform points: a row for each task.
///
/// `benches/peers.py answers` compares them with other programs.
#[derive(Args)]
pub struct Arguments {
    /// How many points
    #[arg(long, default_value_t = 1_000_000)]
    points: usize,
    /// How many queries
    #[arg(long, default_value_t = 1_000_000)]
    queries: usize,
    /// How many threads work; the processor's time is that of one
    #[arg(long, default_value_t = 1)]
    threads: usize,
}

/// The points of which Voronoi cells and natural neighbours are made, at most.
const FEW_POINTS: usize = 100_000;
const FEW_QUERIES: usize = 10_000;

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let points = generate3d(Distribution3::Uniform, arguments.points, 1);
    let queries = generate3d(Distribution3::Uniform, arguments.queries, 2);
    // What shares work does so in the pool in which it is called: with one thread, all of it is in this one.
    let pool = ThreadPoolBuilder::new().num_threads(arguments.threads).build()?;
    Ok(pool.install(|| measure(arguments, &points, &queries))?)
}

fn measure(arguments: &Arguments, points: &[[f64; 3]], queries: &[[f64; 3]]) -> Result<(), gdel::Error> {
    let clock = Clock { arguments };
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    let (row, mesh) = clock.time("triangulate", || triangulator.delaunay3d(points))?;
    row.print();
    let (row, locator) = clock.time("locator", || Locator::new(&mesh, points))?;
    row.print();
    let (row, located) = clock.time("locate", || locator.locate_many(queries))?;
    row.with("inside", located.iter().filter(|location| location.simplex().is_some()).count()).print();

    let values: Vec<f64> = points.iter().map(|p| p[0] * p[1] + p[2]).collect();
    let interpolator = Interpolator::new(&locator, &values)?;
    let few = &queries[..queries.len().min(FEW_QUERIES)];
    for (name, method, queries) in [
        ("linear", Interpolation::Linear, queries),
        ("laplace", Interpolation::Laplace, few),
        ("sibson", Interpolation::Sibson, few),
    ] {
        let (row, found) = clock.time(name, || interpolator.interpolate_many(method, queries))?;
        row.with("count", found.values.len()).print();
    }
    // The first query lists the neighbours of the vertices.
    clock.time("vertex neighbors", || locator.nearest(queries[0]))?.0.print();
    let (row, nearest) = clock.time("nearest", || locator.nearest_many(queries))?;
    let pairs = (0..).zip(&nearest).filter_map(|(query, vertex)| Some((query, (*vertex)?)));
    row.with("checksum", format!("{:016x}", checksum(pairs))).print();

    let (row, shape) = clock.time("alpha", || AlphaShape::new(&mesh, points))?;
    row.print();
    let (row, edges) = clock.time("alpha, edges", || Ok::<_, gdel::Error>(shape.edges().len()))?;
    row.with("count", edges).print();
    let (row, tree) = clock.time("tree", || SpanningTree::new(&mesh, points))?;
    row.with("count", tree.edges.len()).print();

    let few = &points[..points.len().min(FEW_POINTS)];
    let (row, mesh) = clock.time("triangulate few", || triangulator.delaunay3d(few))?;
    row.print();
    let (row, cells) = clock.time("voronoi", || {
        let voronoi = Voronoi::new(&mesh, few, Clip::Box([[0.0; 3], [1.0; 3]]))?;
        Ok::<_, gdel::Error>(voronoi.map_cells(|_, cell| cell.neighbors()))
    })?;
    let pairs = (0..).zip(&cells).flat_map(|(i, neighbors)| neighbors.iter().map(move |&j| (i, j)));
    row.with("checksum", format!("{:016x}", checksum(pairs))).print();
    Ok(())
}

struct Clock<'a> {
    arguments: &'a Arguments,
}

impl Clock<'_> {
    /// Returns a row with the time of some work, and its result.
    fn time<R, E>(&self, name: &str, work: impl FnOnce() -> Result<R, E>) -> Result<(Row, R), E> {
        let (clock, processor) = (Instant::now(), cpu_seconds());
        let result = work()?;
        let (time, processor) = (milliseconds(clock.elapsed()), cpu_seconds() - processor);
        let row = Row::new()
            .with("name", name)
            .with("input", "uniform")
            .with("points", self.arguments.points)
            .with("queries", self.arguments.queries)
            .with("threads", self.arguments.threads)
            .with("ms", microseconds(time))
            .with("cpu_seconds", processor);
        Ok((row, result))
    }
}

/// Returns the time that this thread has run, where Linux says it: on a busy machine it says more than the clock.
fn cpu_seconds() -> f64 {
    let schedstat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    schedstat.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).map_or(f64::NAN, |ns| ns * 1e-9)
}

/// Returns a sum that is the same for the same pairs in any order, as the programs in `benches/peers/` do.
fn checksum(pairs: impl Iterator<Item = (u32, u32)>) -> u64 {
    pairs.fold(0, |sum, (i, j)| {
        let pair = u64::from(i) << 32 | u64::from(j);
        let mixed = (pair ^ pair >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        sum.wrapping_add(mixed ^ mixed >> 32)
    })
}
