//! Whole triangulations.

use crate::{
    input::{Adapter, Cloud, Source, Space},
    row::{Row, median, microseconds, milliseconds, repeated, try_timed},
};
use clap::{Args, ValueEnum};
use gdel::{
    Backend, Triangulator,
    internals::dimension::Dimension,
    stats::{Phase, Stats},
};
use serde_json::{Map, Value, json};
use std::{error::Error, num::NonZeroUsize};

/// Time triangulations, from points in host memory to the mesh.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    adapter: Adapter,
    /// What computes
    #[arg(long, value_enum, default_value_t = Engine::Gpu)]
    backend: Engine,
    /// Where the mesh goes
    #[arg(long, value_enum, value_delimiter = ',', default_value = "fresh")]
    result: Vec<Destination>,
    /// How many threads the CPU backend uses [default: all]; for the GPU backend, see RAYON_NUM_THREADS
    #[arg(long, value_delimiter = ',')]
    threads: Vec<NonZeroUsize>,
    /// Timed runs, of which the median counts
    #[arg(long, default_value = "9")]
    runs: NonZeroUsize,
    /// Seconds of runs before these
    #[arg(long, default_value_t = 1.0)]
    warm_up: f64,
}

#[derive(Clone, Copy, ValueEnum)]
enum Engine {
    Cpu,
    Gpu,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Destination {
    /// Memory of its own
    Fresh,
    /// The memory of the mesh before
    Reused,
    /// The device
    Resident,
}

impl Destination {
    fn name(self) -> &'static str {
        match self {
            Destination::Fresh => "fresh",
            Destination::Reused => "reused",
            Destination::Resident => "resident",
        }
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    match arguments.source.dim {
        2 => in_dimension::<2>(arguments),
        _ => in_dimension::<3>(arguments),
    }
}

fn in_dimension<const D: usize>(arguments: &Arguments) -> Result<(), Box<dyn Error>>
where
    Dimension<D>: Space<D>,
{
    let backend = match arguments.backend {
        Engine::Cpu => Backend::Cpu,
        Engine::Gpu if arguments.threads.is_empty() => Backend::Gpu,
        Engine::Gpu => return Err("--threads is for the CPU backend; set RAYON_NUM_THREADS for the GPU backend".into()),
    };
    // One device for all rows.
    let triangulator = arguments.adapter.triangulator(backend);
    for cloud in arguments.source.clouds::<D>() {
        let cloud = cloud?;
        for &destination in &arguments.result {
            if arguments.threads.is_empty() {
                let row = measure(arguments, &triangulator, &cloud, destination)?;
                row.with("threads", rayon::current_num_threads()).print();
            }
            for &threads in &arguments.threads {
                let triangulator = triangulator.clone().threads(threads);
                measure(arguments, &triangulator, &cloud, destination)?.with("threads", threads.get()).print();
            }
        }
    }
    Ok(())
}

/// Returns the row of one input.
fn measure<const D: usize>(
    arguments: &Arguments,
    triangulator: &Triangulator,
    cloud: &Cloud<D>,
    destination: Destination,
) -> Result<Row, gdel::Error>
where
    Dimension<D>: Space<D>,
{
    let points = cloud.points();
    let mut kept = <Dimension<D> as Space<D>>::Mesh::default();
    let mut all = Vec::new();
    let vertices = |duplicate_of: &[u32]| duplicate_of.iter().filter(|&&first| first == gdel::NONE).count();
    let (times, (simplices, vertices)) = repeated(arguments.runs, arguments.warm_up, || {
        if destination == Destination::Resident {
            let (time, mesh) = try_timed(|| Dimension::<D>::triangulate_resident(triangulator, points))?;
            all.push(mesh.stats().clone());
            return Ok((time, (mesh.simplex_count(), vertices(mesh.duplicate_of()))));
        }
        if destination == Destination::Fresh {
            kept = Default::default();
        }
        let (time, ()) = try_timed(|| Dimension::<D>::triangulate(triangulator, points, &mut kept))?;
        let (simplices, duplicate_of, stats) = Dimension::<D>::summary(&kept);
        all.push(stats.clone());
        Ok::<_, gdel::Error>((time, (simplices, vertices(duplicate_of))))
    })?;
    let stats = &all[all.len() - arguments.runs.get()..];
    let before = |stats: &Stats| milliseconds(stats.time_of(Phase::Lattice) + stats.time_of(Phase::Phase1));
    let after: Vec<f64> = times.iter().zip(stats).map(|(time, stats)| time - before(stats)).collect();
    let row = Row::new()
        .with("input", cloud.name.as_str())
        .with("dimension", D)
        .with("points", points.len())
        .with("precision", cloud.precision())
        .with("result", destination.name())
        .with("simplices", simplices)
        .with("vertices", vertices)
        .with_times("ms", &times);
    let row = with_stats(row, stats);
    // What follows Phase 1, for the GPU.
    Ok(if stats[0].gpu.is_some() { row.with("after_ms", microseconds(median(&after))) } else { row })
}

/// Adds the medians of the phases, and the counts of the last run.
fn with_stats(row: Row, all: &[Stats]) -> Row {
    let Some(last) = all.last() else { return row };
    let phases: Map<String, Value> = last
        .phases
        .iter()
        .map(|&(phase, _)| {
            let times: Vec<f64> = all.iter().map(|stats| milliseconds(stats.time_of(phase))).collect();
            (phase.name().replace(' ', "_"), json!(microseconds(median(&times))))
        })
        .collect();
    let row = row
        .with("backend", last.backend.to_string())
        .with("fallback", last.fallback.as_ref().map(ToString::to_string))
        .with("phases_ms", phases);
    let row = match &last.gpu {
        Some(gpu) => row.with("adapter", gpu.adapter.as_str()).with(
            "gpu",
            json!({
                "rounds": gpu.rounds.len(), "flip_iterations": gpu.flip_iterations,
                "flips": gpu.flips_22 + gpu.flips_23 + gpu.flips_32, "exact_tests": gpu.exact_tests,
                "failed_vertices": gpu.failed_vertices, "dispatches": gpu.dispatches, "submits": gpu.submits,
                "readbacks": gpu.readbacks, "stalls": gpu.stalls, "bytes": gpu.bytes,
            }),
        ),
        None => row,
    };
    match &last.splay {
        Some(splay) => row.with(
            "splay",
            json!({ "built": splay.built, "pulled": splay.pulled, "rounds": splay.rounds, "gathers": splay.gathers }),
        ),
        None => row,
    }
}
