//! `gdel triangulate --tiles`: points that are larger than memory, to a mesh in a folder.
//!
//! `survey → split → steps → pieces → links`, of which each leaves files behind: a run that was ended goes on where it was.

mod folder;
mod pieces;
mod split;
mod steps;
mod verify;

pub(crate) use verify::prove;

use crate::{
    backend::BackendName,
    dimension::Triangulation,
    failure::{Failure, conclude},
    progress::Progress,
    report::{StatsForm, print},
};
use clap::{Args, ValueEnum};
use folder::Folder;
use gdel::{
    Triangulator,
    internals::{
        Options,
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
    },
    stats::Stats,
    tiles::{Plan, Provable},
    verify::Report as Proof,
};
use gdel_io::{PointFormat, files::Input};
use serde::{Deserialize, Serialize};
use std::{
    collections::BTreeMap,
    fmt,
    num::NonZeroUsize,
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicU32, Ordering},
    },
    thread,
    time::{Instant, UNIX_EPOCH},
};

/// Options for a mesh in tiles.
#[derive(Args)]
pub(crate) struct Tiling {
    /// Write a folder with a mesh in tiles: for points and a mesh that are larger than memory. What is unfinished goes on
    /// when the same command is run again
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["outputs", "sphere", "rescale", "weights", "radii"])]
    #[arg(conflicts_with_all = ["edges", "fill", "split", "repeat"])]
    pub(crate) tiles: Option<PathBuf>,
    /// Use about so much memory: a number of bytes, or as in 8GB or 500MB
    #[arg(long, value_name = "SIZE", value_parser = parse_size, default_value = "4GB", requires = "tiles")]
    memory: u64,
    /// The format of the files of tiles
    #[arg(long, value_enum, default_value_t = TileFormat::Npz, requires = "tiles")]
    tile_format: TileFormat,
}

/// The format of the files of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
pub(crate) enum TileFormat {
    /// NumPy arrays with neighbours
    Npz,
    /// VTK's unstructured grids, with a .pvtu that names all of them
    Vtu,
}

impl TileFormat {
    /// Returns the name of the file of a tile.
    fn file(self, tile: u32) -> String {
        match self {
            TileFormat::Npz => format!("tile-{tile:05}.npz"),
            TileFormat::Vtu => format!("tile-{tile:05}.vtu"),
        }
    }
}

/// Parses a number of bytes.
fn parse_size(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == ' ');
    let unit = match text[digits.len()..].trim().to_ascii_uppercase().as_str() {
        "" | "B" => 1.0,
        "KB" | "K" => 1e3,
        "MB" | "M" => 1e6,
        "GB" | "G" => 1e9,
        "TB" | "T" => 1e12,
        _ => return Err("a number of bytes is needed, as in 8GB or 500MB".into()),
    };
    let number = digits.parse::<f64>().ok().filter(|&number| number > 0.0 && number.is_finite());
    number.map(|number| (number * unit) as u64).ok_or_else(|| "a positive number of bytes is needed".into())
}

/// What a run is of: another run of the same goes on with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Order {
    /// Each file with its size and the nanoseconds at which it was changed.
    inputs: Vec<(PathBuf, u64, u128)>,
    dim: usize,
    format: TileFormat,
    memory: u64,
}

/// How far a run has come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct State {
    order: Order,
    tiles: u32,
    /// How many tiles are in memory at a time.
    workers: u32,
    points: u64,
    /// The number of steps that all tiles have taken.
    steps: u32,
    /// Whether no tile has sent anything in the last one.
    is_quiet: bool,
    /// Points that were sent, each as often as it was.
    sent: u64,
}

/// So many threads work on one tile: much of the work on a tile is done by one.
const THREADS: usize = 4;

const STATE: &str = "state.json";
const PLAN: &str = "plan";

/// A run, which keeps its files in a folder.
struct Run<const D: usize> {
    folder: Folder,
    state: State,
    plan: Arc<Plan<D>>,
    options: Options,
    devices: Devices,
}

/// The GPUs that triangulate tiles; none if the CPU does.
#[derive(Default)]
pub(crate) struct Devices {
    triangulators: Vec<Triangulator>,
    fallbacks: Mutex<Fallbacks>,
}

/// The tiles that the CPU triangulated although there are GPUs.
#[derive(Default, Serialize)]
struct Fallbacks {
    /// How many there are.
    #[serde(rename = "fallbacks")]
    count: u32,
    /// Why the CPU triangulated the last one.
    #[serde(rename = "fallback", skip_serializing_if = "Option::is_none")]
    why: Option<String>,
}

impl Devices {
    /// Returns what triangulates a tile, if that is not the CPU.
    fn of(&self, tile: u32) -> Option<&Triangulator> {
        let count = self.triangulators.len().max(1);
        self.triangulators.get(tile as usize % count)
    }

    /// Notes how a tile was triangulated.
    fn note(&self, stats: &Stats) {
        if let Some(why) = &stats.fallback {
            let mut fallbacks = self.fallbacks.lock().unwrap_or_else(PoisonError::into_inner);
            *fallbacks = Fallbacks { count: fallbacks.count + 1, why: Some(why.to_string()) };
        }
    }
}

/// Returns the GPUs that triangulate tiles.
pub(crate) fn devices(backend: BackendName) -> Devices {
    let triangulators = match backend {
        BackendName::Cpu => Vec::new(),
        BackendName::Auto => Triangulator::of_each_gpu(),
        BackendName::Gpu => match Triangulator::of_each_gpu() {
            // The software that the system recommends, or the error that there is none.
            none if none.is_empty() => vec![Triangulator::new()],
            all => all,
        },
    };
    let triangulators = triangulators.into_iter().map(|one| one.backend(backend.into())).collect();
    Devices { triangulators, ..Devices::default() }
}

impl<const D: usize> Run<D> {
    /// Notes how far the run has come.
    fn save(&self) -> Result<(), Failure> {
        self.folder.write_json(&self.folder.work(STATE), &self.state)
    }
}

/// Calls `work` for each tile, for several at a time. Returns the first error after what has begun has ended.
fn for_each_tile(
    tiles: u32,
    workers: u32,
    show: &(dyn Fn(f64) + Sync),
    work: impl Fn(u32) -> Result<(), Failure> + Sync,
) -> Result<(), Failure> {
    let (next, done) = (AtomicU32::new(0), AtomicU32::new(0));
    let failure = Mutex::new(None);
    let work_on = || {
        loop {
            let tile = next.fetch_add(1, Ordering::Relaxed);
            if tile >= tiles {
                return;
            }
            if let Err(error) = work(tile) {
                failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                next.store(tiles, Ordering::Relaxed);
                return;
            }
            show(f64::from(done.fetch_add(1, Ordering::Relaxed) + 1) / f64::from(tiles));
        }
    };
    thread::scope(|scope| {
        (1..workers).for_each(|_| drop(scope.spawn(work_on)));
        work_on();
    });
    failure.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// Returns how many tiles so many threads work on at a time.
fn workers(threads: Option<NonZeroUsize>) -> u32 {
    threads.map_or(1, |threads| threads.get().div_ceil(THREADS)) as u32
}

/// The arguments of a run.
pub(crate) struct Request<'a> {
    pub(crate) inputs: Vec<&'a Path>,
    pub(crate) format: Option<PointFormat>,
    pub(crate) tiling: &'a Tiling,
    pub(crate) force: bool,
    pub(crate) options: Options,
    pub(crate) devices: Devices,
    pub(crate) verify: bool,
    pub(crate) stats: Option<StatsForm>,
}

/// Triangulates points into the folder of `request`.
pub(crate) fn run<M: Triangulation<D, N>, const D: usize, const N: usize>(
    path: &Path,
    request: Request<'_>,
) -> Result<(), Failure>
where
    Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
{
    let inputs: Vec<Input> =
        request.inputs.iter().map(|path| Input::new(path, request.format)).collect::<Result<_, _>>()?;
    let order = Order {
        inputs: inputs.iter().map(stamp).collect::<Result<_, _>>()?,
        dim: D,
        format: request.tiling.tile_format,
        memory: request.tiling.memory,
    };
    let mut clock = Clock::default();
    let folder = Folder::create(path, request.force)?;
    let state = folder.read_json::<State>(&folder.work(STATE))?.filter(|state| state.order == order);
    let resumed = state.is_some();
    // Threads that are left work on other tiles.
    let all = request.options.threads.or_else(|| thread::available_parallelism().ok());
    let threads = all.and_then(|all| NonZeroUsize::new(all.get().min(THREADS)));
    let options = Options { threads, ..request.options };
    let devices = request.devices;
    let mut run = match state {
        Some(state) => {
            let plan = Plan::from_bytes(&folder.read(PLAN)?).map_err(|error| folder.damaged(PLAN, error))?;
            Run { folder, state, plan: Arc::new(plan), options, devices }
        }
        None => {
            folder.clear()?;
            let (survey, points) = clock.time("survey", |show| split::survey::<D>(&inputs, &order, show))?;
            let workers = workers(all).max(devices.triangulators.len() as u32);
            let tiles = split::tiles(points, order.memory / u64::from(workers));
            let plan = Arc::new(Plan::new(survey, tiles));
            folder.write(PLAN, &plan.to_bytes())?;
            let state = State { order, tiles, workers: workers.min(tiles), points, steps: 0, is_quiet: false, sent: 0 };
            let run = Run { folder, state, plan, options, devices };
            clock.time("split", |show| split::split::<D, N>(&run, &inputs, show))?;
            run.save()?;
            run
        }
    };
    clock.time("steps", |show| steps::take::<D, N>(&mut run, show))?;
    clock.time("pieces", |show| pieces::write::<M, D, N>(&run, show))?;
    let index = clock.time("links", |show| pieces::link(&run, show))?;
    let State { tiles, steps, sent, .. } = run.state;
    let fallbacks = run.devices.fallbacks.into_inner().unwrap_or_else(PoisonError::into_inner);
    run.folder.finish(&index)?;
    let proof = request.verify.then(|| prove::<M, D, N>(path)).transpose()?;
    let report = Report {
        points: index.points,
        duplicates: index.duplicates,
        dimension: index.dimension,
        simplices: Simplices::new(D, index.simplices),
        tiles,
        steps,
        sent,
        gpus: Gpus { count: run.devices.triangulators.len(), fallbacks },
        resumed,
        verified: proof.as_ref().map(Proof::passed),
        seconds: clock.0,
    };
    print(request.stats, &report)?;
    proof.map_or(Ok(()), |proof| conclude(path, &proof))
}

/// Returns what tells a file from another version of it.
fn stamp(input: &Input) -> Result<(PathBuf, u64, u128), Failure> {
    let path = input.path();
    let data = path.metadata().map_err(folder::read_error(path))?;
    let modified = data.modified().map_err(folder::read_error(path))?;
    let since = modified.duration_since(UNIX_EPOCH).unwrap_or_default().as_nanos();
    let whole = path.canonicalize().map_err(folder::read_error(path))?;
    Ok((whole, data.len(), since))
}

/// The seconds that each stage took.
#[derive(Default)]
struct Clock(BTreeMap<&'static str, f64>);

impl Clock {
    /// Runs a stage, which tells how far it is.
    fn time<T>(
        &mut self,
        stage: &'static str,
        work: impl FnOnce(&(dyn Fn(f64) + Sync)) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let progress = Progress::new(stage);
        let show = progress.reporter();
        let start = Instant::now();
        let result = work(&|fraction| show(stage, fraction));
        self.0.insert(stage, start.elapsed().as_secs_f64());
        result
    }
}

/// The statistics of a run: as JSON by `serde`, for people by `Display`.
#[derive(Serialize)]
struct Report {
    points: u64,
    duplicates: u64,
    dimension: u8,
    #[serde(flatten)]
    simplices: Simplices,
    tiles: u32,
    /// Steps of the exchange of points.
    steps: u32,
    /// Points that tiles have sent each other.
    sent: u64,
    #[serde(flatten)]
    gpus: Gpus,
    /// Whether the run went on with what an earlier one had done.
    resumed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    verified: Option<bool>,
    seconds: BTreeMap<&'static str, f64>,
}

/// What GPUs did.
#[derive(Serialize)]
struct Gpus {
    /// How many GPUs triangulated tiles.
    #[serde(rename = "gpus")]
    count: usize,
    #[serde(flatten)]
    fallbacks: Fallbacks,
}

/// The number of simplices.
#[derive(Serialize)]
enum Simplices {
    #[serde(rename = "triangles")]
    Triangles(u64),
    #[serde(rename = "tetrahedra")]
    Tetrahedra(u64),
}

impl Simplices {
    fn new(dim: usize, count: u64) -> Self {
        if dim == 2 { Simplices::Triangles(count) } else { Simplices::Tetrahedra(count) }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "points          {}", self.points)?;
        if self.duplicates > 0 {
            write!(f, " ({} duplicates)", self.duplicates)?;
        }
        let (full, name, count) = match self.simplices {
            Simplices::Triangles(count) => (2, "triangles", count),
            Simplices::Tetrahedra(count) => (3, "tetrahedra", count),
        };
        if self.dimension < full {
            write!(f, "\ndimension       {}, so there are no {name}", self.dimension)?;
        }
        write!(f, "\n{name:<15} {count}\ntiles           {}", self.tiles)?;
        if self.sent > 0 {
            write!(f, ", which sent each other {} points in {} steps", self.sent, self.steps)?;
        }
        let Gpus { count, fallbacks } = &self.gpus;
        if *count > 0 {
            write!(f, "\nGPUs            {count}")?;
        }
        if let Fallbacks { count, why: Some(why) } = fallbacks {
            write!(f, "; the CPU triangulated {count} tiles: {why}")?;
        }
        let total: f64 = self.seconds.values().sum();
        write!(f, "\nseconds         {total:.3}")?;
        for (i, stage) in ["survey", "split", "steps", "pieces", "links"].into_iter().enumerate() {
            if let Some(seconds) = self.seconds.get(stage) {
                write!(
                    f,
                    "{}{stage} {seconds:.3}",
                    if i == 0 || self.resumed && stage == "steps" { " (" } else { ", " }
                )?;
            }
        }
        write!(f, ")")?;
        if self.resumed {
            write!(f, ", after an earlier run")?;
        }
        match self.verified {
            Some(true) => write!(f, "\nverified        this is the Delaunay triangulation"),
            Some(false) => write!(f, "\nverified        NOT the Delaunay triangulation"),
            None => Ok(()),
        }
    }
}
