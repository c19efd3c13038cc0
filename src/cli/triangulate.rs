//! `gdel triangulate`: a point cloud in, its Delaunay triangulation out.

use super::{
    Failure,
    dimension::{Dimension, plane_points},
    progress::Progress,
    report::Report,
    verify,
};
use clap::{Args, ValueEnum};
use gdel::{
    Backend, Triangulator,
    internals::io::files::{self, FileError, Output},
    verify::Report as Proof,
};
use std::{
    io::{self, Write},
    num::NonZeroUsize,
    ops::ControlFlow,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// Triangulate a point cloud.
#[derive(Args)]
pub(super) struct Arguments {
    /// The points: .ply, .obj, .stl, .xyz, .txt, .asc, .pts, .csv, .tsv, .pcd, .las, .laz, .npy, .f32 or .f64
    input: PathBuf,
    /// Where to write: the mesh as .node, .ele and .neigh (TetGen, always all three), .vtu or .npz; the hull as .ply,
    /// .obj, .stl or .glb; may be given several times
    #[arg(short, long = "output", value_name = "OUTPUT", value_parser = parse_output)]
    outputs: Vec<Output>,
    /// Triangulate space, or the plane: then z is dropped, and all outputs have the triangles
    #[arg(long, value_enum, default_value_t = Dimension::Three)]
    dim: Dimension,
    /// What computes; all give the same mesh
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    backend: BackendName,
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
enum BackendName {
    /// The GPU for large inputs where there is one, else the CPU
    Auto,
    /// Incremental insertion on one core
    Cpu,
    /// Flipping on the GPU, then star splaying (3D) or flips (2D) on the CPU
    Gpu,
}

impl From<BackendName> for Backend {
    fn from(name: BackendName) -> Self {
        match name {
            BackendName::Auto => Backend::Auto,
            BackendName::Cpu => Backend::Cpu,
            BackendName::Gpu => Backend::Gpu,
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
    let path = &arguments.input;
    match arguments.dim {
        Dimension::Three => {
            let report = |mesh: &_, total| print(arguments.stats, &Report::new(&cloud, mesh, total));
            let mesh = triangulate(arguments, |triangulator| triangulator.delaunay3d(&cloud), report)?;
            conclude(arguments, || verify::prove(path, &cloud, &mesh))?;
            write(arguments, |output| output.write((&cloud).into(), &mesh))
        }
        Dimension::Two => {
            let points = plane_points(path, &cloud);
            let report = |mesh: &_, total| print(arguments.stats, &Report::of_plane(&cloud, mesh, total));
            let mesh = triangulate(arguments, |triangulator| triangulator.delaunay2d(&points), report)?;
            conclude(arguments, || verify::prove2(path, (&points).into(), &mesh))?;
            write(arguments, |output| output.write2((&points).into(), &mesh))
        }
    }
}

/// Runs and reports as often as asked for; gives the last mesh.
fn triangulate<M>(
    arguments: &Arguments,
    run: impl Fn(&Triangulator) -> Result<M, gdel::Error>,
    report: impl Fn(&M, Duration) -> io::Result<()>,
) -> Result<M, Failure> {
    // One device for all runs.
    let triangulator = Triangulator::new().backend(arguments.backend.into());
    let once = || {
        let (mesh, total) = {
            let progress = Progress::new("triangulating");
            let show = progress.reporter();
            let triangulator = triangulator.clone().on_progress(move |progress| {
                show(progress.phase.name(), progress.fraction);
                ControlFlow::Continue(())
            });
            let start = Instant::now();
            let mesh =
                run(&triangulator).map_err(|source| Failure::Points { path: arguments.input.clone(), source })?;
            (mesh, start.elapsed())
        };
        report(&mesh, total)?;
        Ok::<M, Failure>(mesh)
    };
    // Each run gives its memory back before the next.
    for _ in 1..arguments.repeat.get() {
        once()?;
    }
    once()
}

/// Verifies, if that is asked for.
fn conclude(arguments: &Arguments, prove: impl FnOnce() -> Result<Proof, Failure>) -> Result<(), Failure> {
    if arguments.verify {
        verify::conclude(&arguments.input, &prove()?)?;
        if arguments.stats.is_none() {
            writeln!(io::stdout().lock(), "verified")?;
        }
    }
    Ok(())
}

fn write(arguments: &Arguments, write: impl Fn(&Output) -> Result<(), FileError>) -> Result<(), Failure> {
    let _progress = Progress::new("writing");
    Ok(arguments.outputs.iter().try_for_each(write)?)
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
