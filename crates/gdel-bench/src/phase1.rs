//! Phase 1 alone, with the time of each of its stages on the device.

use crate::{
    input::{Adapter, Source, Space},
    row::{Row, microseconds, milliseconds, repeated},
};
use clap::{Args, ValueEnum};
use gdel::internals::{
    Options,
    dimension::Dimension,
    gpu::{
        Gpu, Profiler,
        host::Here,
        layout::Pick,
        phase1::{Finish, MemorySettings, Phase1, Phase1Output, Settings},
    },
    input::lattice::Lattice,
};
use pollster::block_on;
use serde_json::{Map, Value, json};
use std::{error::Error, num::NonZeroUsize};

/// Time Phase 1 on the GPU, and each of its stages.
///
/// The stages are those of one more run, which is slower since each is timed.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    adapter: Adapter,
    /// Timed runs, of which the median counts
    #[arg(long, default_value = "9")]
    runs: NonZeroUsize,
    /// Which of its points a simplex inserts (§5.4 of the paper)
    #[arg(long, value_enum, default_value_t = Picked::Adaptive)]
    pick: Picked,
    /// Insert all points before flipping (§5.3)
    #[arg(long)]
    insert_all: bool,
    /// Do not order the points along the Hilbert curve (§4.3)
    #[arg(long)]
    unsorted: bool,
    /// Have large arrays in parts of so many mebibytes
    #[arg(long)]
    part: Option<u64>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Picked {
    Adaptive,
    Circumcenter,
    Centroid,
    Random,
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    match arguments.source.dim {
        2 => in_dimension::<2>(arguments),
        _ => in_dimension::<3>(arguments),
    }
}

fn in_dimension<const D: usize>(arguments: &Arguments) -> Result<(), Box<dyn Error>>
where
    Dimension<D>: Space<D> + Finish<D>,
{
    let gpu = arguments.adapter.open()?;
    let default = Settings::default();
    let settings = Settings {
        pick: match arguments.pick {
            Picked::Adaptive => Pick::Adaptive,
            Picked::Circumcenter => Pick::Circumcenter,
            Picked::Centroid => Pick::Centroid,
            Picked::Random => Pick::Random,
        },
        insert_all: arguments.insert_all,
        sort: !arguments.unsorted,
        memory: MemorySettings { part_bytes: arguments.part.map(|part| part << 20), ..default.memory },
        ..default
    };
    for cloud in arguments.source.clouds::<D>() {
        let cloud = cloud?;
        let points = cloud.points();
        let lattice = Lattice::fit(points);
        let options = Options::default();
        let mut host = Here::new(points, &options, Default::default());
        let mut phase1 = block_on(Phase1::in_parts(&gpu, lattice.width(), settings.parts(&gpu, points.len())))?;
        block_on(phase1.finish_compiling(&gpu))?;
        let (times, output) = repeated(arguments.runs, 1.0, || {
            let output = block_on(phase1.run(&gpu, &mut host, &settings, None))?;
            Ok::<_, gdel::Error>((milliseconds(output.stats.time), output))
        })?;
        let mut stages = Map::new();
        if let Some(mut profiler) = Profiler::new(&gpu)? {
            block_on(phase1.run(&gpu, &mut host, &settings, Some(&mut profiler)))?;
            let last = gpu.queue().submit([]);
            for &(name, time) in block_on(profiler.milliseconds(&gpu, &last))? {
                stages.insert(name.to_owned(), json!(microseconds(time)));
            }
        }
        let row = row(&gpu, &output)
            .with("input", cloud.name.as_str())
            .with("dimension", D)
            .with("points", points.len())
            .with("precision", cloud.precision())
            .with("width", format!("{:?}", lattice.width()))
            .with("stages_ms", stages);
        row.with_times("ms", &times).print();
    }
    Ok(())
}

/// Returns what the last run did.
fn row<const D: usize>(gpu: &Gpu, output: &Phase1Output<D>) -> Row
where
    Dimension<D>: Finish<D>,
{
    let (stats, counters) = (&output.stats, &output.stats.counters);
    let rounds: Vec<Value> = stats
        .rounds
        .iter()
        .map(|round| {
            json!({
                "inserted": round.inserted, "active": round.active, "flips": round.flips,
                "iterations": round.iterations, "ms": microseconds(milliseconds(round.time)),
            })
        })
        .collect();
    let counts = json!({
        "flip_iterations": counters.iterations, "visits": counters.visits, "flips": counters.flips(),
        "exact_tests": counters.exact, "failed_vertices": counters.failed, "merged": output.merged.len(),
        "readbacks": stats.readbacks, "stalls": stats.stalls, "dispatches": stats.dispatches, "bytes": stats.bytes,
    });
    Row::new().with("adapter", gpu.adapter().name.as_str()).with("gpu", counts).with("rounds", rounds)
}
