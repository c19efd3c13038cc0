//! `gdel triangulate`: a point cloud in, its Delaunay triangulation out.

use super::{Failure, progress::Progress, report::Report, verify};
use clap::{Args, ValueEnum};
use gdel::{
    Engine, Mesh3, Options,
    io::{
        PointCloud,
        files::{self, Output},
    },
};
use std::{
    io::{self, Write},
    num::NonZeroUsize,
    ops::ControlFlow,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

/// Triangulate a point cloud.
#[derive(Args)]
pub(super) struct Arguments {
    /// The points: .ply, .obj, .stl, .xyz, .txt, .asc, .pts, .csv, .tsv, .pcd, .las, .laz, .npy, .f32 or .f64
    input: PathBuf,
    /// Where to write: the mesh as .node, .ele and .neigh (TetGen, always all three), .vtu or .npz; the hull as .ply,
    /// .obj or .stl; may be given several times
    #[arg(short, long = "output", value_name = "OUTPUT", value_parser = parse_output)]
    outputs: Vec<Output>,
    /// Which engine computes; all give the same mesh
    #[arg(long, value_enum, default_value_t = EngineName::Auto)]
    engine: EngineName,
    /// Print statistics in this form instead of a summary; with --repeat one object a line and run
    #[arg(long, value_enum)]
    stats: Option<StatsForm>,
    /// Triangulate this many times
    #[arg(long, value_name = "N", default_value = "1")]
    repeat: NonZeroUsize,
    /// Prove that the result is the Delaunay triangulation
    #[arg(long)]
    verify: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum EngineName {
    /// The GPU engine for large inputs where there is a graphics card, else the CPU engine
    Auto,
    /// Incremental insertion on one core
    Cpu,
    /// Flipping on the graphics card, splaying on the CPU
    #[cfg(feature = "gpu")]
    Gpu,
}

impl From<EngineName> for Engine {
    fn from(name: EngineName) -> Self {
        match name {
            EngineName::Auto => Engine::Auto,
            EngineName::Cpu => Engine::Cpu,
            #[cfg(feature = "gpu")]
            EngineName::Gpu => Engine::Gpu,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum StatsForm {
    /// One JSON object
    Json,
}

fn parse_output(path: &str) -> Result<Output, String> {
    Output::new(Path::new(path)).map_err(|error| error.to_string())
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let cloud = {
        let _progress = Progress::new("reading");
        files::read_points(&arguments.input)?
    };
    arguments.outputs.iter().try_for_each(Output::check)?;
    let mut last = None;
    for _ in 0..arguments.repeat.get() {
        // The run before gives its memory back first.
        drop(last.take());
        let (mesh, total) = triangulate(arguments, &cloud)?;
        print(arguments.stats, &Report::new(&cloud, &mesh, total))?;
        last = Some(mesh);
    }
    let Some(mesh) = last else { return Ok(()) };
    if arguments.verify {
        let report = verify::prove(&arguments.input, &cloud, &mesh)?;
        verify::conclude(&arguments.input, &report)?;
        if arguments.stats.is_none() {
            writeln!(io::stdout().lock(), "verified")?;
        }
    }
    let _progress = Progress::new("writing");
    arguments.outputs.iter().try_for_each(|output| output.write((&cloud).into(), &mesh))?;
    Ok(())
}

fn triangulate(arguments: &Arguments, cloud: &PointCloud) -> Result<(Mesh3, Duration), Failure> {
    let progress = Progress::new("triangulating");
    let report = progress.reporter();
    let mut options = Options { engine: arguments.engine.into(), ..Options::default() };
    options.on_progress = Some(Arc::new(move |progress| {
        report(progress.phase, progress.fraction);
        ControlFlow::Continue(())
    }));
    let start = Instant::now();
    let mesh = gdel::delaunay3d(cloud, &options)
        .map_err(|source| Failure::Points { path: arguments.input.clone(), source })?;
    Ok((mesh, start.elapsed()))
}

fn print(form: Option<StatsForm>, report: &Report<'_>) -> Result<(), io::Error> {
    let mut stdout = io::stdout().lock();
    match form {
        Some(StatsForm::Json) => {
            serde_json::to_writer(&mut stdout, report)?;
            writeln!(stdout)
        }
        None => writeln!(stdout, "{report}"),
    }
}
