//! Meshes in tiles, in memory, and what they cost beyond their tiles.

use crate::{
    input::{Adapter, Cloud, Source, Space},
    row::{Row, microseconds, try_timed},
};
use clap::Args;
use gdel::{
    Backend, Points, Triangulator,
    internals::{
        Options,
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    tiles::{Core, Message, Plan, Survey, Tile, Tiled},
};
use std::{error::Error, num::NonZeroUsize, sync::Arc};

/// Time the steps of a mesh in tiles, one tile after the other, and its tiles as meshes of their own.
#[derive(Args)]
pub struct Arguments {
    #[command(flatten)]
    source: Source,
    #[command(flatten)]
    adapter: Adapter,
    /// How many tiles
    #[arg(long, default_value = "8")]
    tiles: u32,
    /// Of how many points each tile knows one from the start
    #[arg(long, default_value = "1000")]
    every: u32,
    /// How many threads work on a tile [default: all]
    #[arg(long)]
    threads: Option<NonZeroUsize>,
    /// Triangulate on the GPU
    #[arg(long)]
    gpu: bool,
    /// Take what is final out of the tiles after the second step
    #[arg(long)]
    core: bool,
}

pub fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    match arguments.source.dim {
        2 => in_dimension::<2, 3>(arguments),
        _ => in_dimension::<3, 4>(arguments),
    }
}

fn in_dimension<const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Box<dyn Error>>
where
    Dimension<D>: Space<D> + Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    arguments.source.clouds::<D>().try_for_each(|cloud| {
        measure::<D, N>(arguments, &cloud?)?.print();
        Ok(())
    })
}

fn measure<const D: usize, const N: usize>(arguments: &Arguments, cloud: &Cloud<D>) -> Result<Row, gdel::Error>
where
    Dimension<D>: Space<D> + Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let points = cloud.points();
    let plan = Arc::new(Plan::new(Survey::new(points, 0, arguments.every)?, arguments.tiles));
    let own = plan.split(points, 0);
    let backend = if arguments.gpu { Backend::Gpu } else { Backend::Cpu };
    let triangulator = arguments.adapter.triangulator(backend);
    let triangulator = arguments.threads.map_or(triangulator.clone(), |threads| triangulator.threads(threads));
    let separate = |warm_up: bool| {
        let mut sum = 0.0;
        for (points, _) in own.iter().take(if warm_up { 1 } else { own.len() }) {
            let mut mesh = <Dimension<D> as Space<D>>::Mesh::default();
            sum += try_timed(|| Dimension::<D>::triangulate(&triangulator, Points::F64(points), &mut mesh))?.0;
        }
        Ok::<f64, gdel::Error>(sum)
    };
    separate(true)?;
    let separate = separate(false)?;
    let options = Options { threads: arguments.threads, ..Options::default() };
    let mut tiles = Vec::new();
    for (number, (points, indices)) in (0..).zip(own) {
        tiles.push(Tile::<D, N>::with_options(Arc::clone(&plan), number, points, indices, options.clone())?);
    }
    let on = arguments.gpu.then_some(&triangulator);
    let Steps { times, sent, cores, core } = steps(&mut tiles, on, arguments.core)?;
    let (finish, simplices) = try_timed(|| {
        let mut cores = cores.into_iter();
        let mut simplices = 0;
        for tile in tiles {
            simplices += match cores.next() {
                Some(core) => core.complete(tile)?.part.simplices.len(),
                None => tile.finish()?.simplices.len(),
            };
        }
        Ok::<usize, gdel::Error>(simplices)
    })?;
    let all: f64 = times.iter().sum();
    let row = Row::new()
        .with("input", cloud.name.as_str())
        .with("dimension", D)
        .with("points", points.len())
        .with("tiles", arguments.tiles)
        .with("threads", arguments.threads.map_or(rayon::current_num_threads(), NonZeroUsize::get))
        .with("backend", backend.to_string())
        .with("simplices", simplices)
        .with("sent", sent)
        .with("separate_ms", microseconds(separate))
        .with("steps_ms", times.iter().copied().map(microseconds).collect::<Vec<_>>())
        .with("core_ms", microseconds(core))
        .with("finish_ms", microseconds(finish))
        .with("ratio", microseconds(all / separate));
    Ok(row)
}

/// What the steps of all tiles took.
struct Steps<const D: usize, const N: usize> {
    /// For each step the milliseconds of all tiles, one after the other.
    times: Vec<f64>,
    /// The number of points that were sent, each as often as it was.
    sent: usize,
    cores: Vec<Core<D, N>>,
    /// The milliseconds that it took to take these.
    core: f64,
}

fn steps<const D: usize, const N: usize>(
    tiles: &mut [Tile<D, N>],
    on: Option<&Triangulator>,
    takes_core: bool,
) -> Result<Steps<D, N>, gdel::Error>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
{
    let mut steps = Steps { times: Vec::new(), sent: 0, cores: Vec::new(), core: 0.0 };
    let mut received: Vec<Vec<(u32, Message<D>)>> = vec![Vec::new(); tiles.len()];
    loop {
        let mut outgoing = vec![Vec::new(); tiles.len()];
        let mut sum = 0.0;
        for (from, (tile, received)) in (0..).zip(tiles.iter_mut().zip(&mut received)) {
            let received = std::mem::take(received);
            let (time, messages) = try_timed(|| match on {
                Some(triangulator) => tile.step_on(triangulator, received),
                None => tile.step(received),
            })?;
            sum += time;
            for (to, message) in messages {
                steps.sent += message.points();
                outgoing[to as usize].push((from, message));
            }
        }
        steps.times.push(sum);
        if takes_core && steps.times.len() == 2 {
            let taken = || tiles.iter_mut().map(Tile::take_core).collect::<Result<Vec<_>, _>>();
            (steps.core, steps.cores) = try_timed(taken)?;
        }
        if steps.times.len() > 1 && outgoing.iter().all(Vec::is_empty) {
            return Ok(steps);
        }
        received = outgoing;
    }
}
