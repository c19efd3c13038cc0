//! `gdel verify`: the proof that a mesh is the Delaunay triangulation of its points.

use super::{
    dimension::{Dimension, Triangulation, format_parser, in_dimension, read},
    failure::{Failure, conclude},
    progress::Progress,
    tiles,
};
use clap::{Args, error::ErrorKind};
use gdel::{
    Points,
    internals::geometry::{Euclidean, Geometry},
    tiles::Provable,
    verify::Report,
};
use gdel_io::{
    PointBuf, PointFormat,
    files::{Input, read_mesh},
};
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Prove that a mesh is the Delaunay triangulation of its points, or the regular one if its file has weights, or say what
/// is wrong with it.
#[derive(Args)]
#[command(allow_missing_positional = true)]
pub(super) struct Arguments {
    /// The points, in any format that `triangulate` reads, or `-` for standard input; without them,
    /// the points that the mesh's file holds. Where both are there, they must be the same.
    points: Option<PathBuf>,
    /// The mesh: .ele (with the .neigh and .node beside it, if any), .vtu or .npz, or the folder of a mesh in tiles, which
    /// holds its points
    mesh: PathBuf,
    /// The dimension of the mesh
    #[arg(long, value_enum, default_value_t = Dimension::Three)]
    dim: Dimension,
    /// The format of the points, whatever the extension of their file
    #[arg(long, value_parser = format_parser(), requires = "points")]
    format: Option<PointFormat>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    in_dimension!(arguments.dim, run_in, arguments)
}

fn run_in<M: Triangulation<D, N>, const D: usize, const N: usize>(arguments: &Arguments) -> Result<(), Failure>
where
    gdel::internals::dimension::Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
{
    let path = &arguments.mesh;
    if path.is_dir() {
        if arguments.points.is_some() {
            let what = "a mesh in tiles holds its points: leave out the other file";
            return Err(Failure::Usage(ErrorKind::ArgumentConflict, what.into()));
        }
        return tell(path, &tiles::prove::<M, D, N>(path)?);
    }
    let points = arguments.points.as_ref().map(|path| Input::new(path, arguments.format)).transpose()?;
    let reading = Progress::new("reading");
    let given = points.as_ref().map(read::<D>).transpose()?;
    let mut mesh = read_mesh::<M, D, N>(path)?;
    drop(reading);
    let stored = mesh.points.take();
    let report = match (&points, &given, &stored) {
        (Some(input), Some(given), _) => {
            compare(input, given.into(), path, stored.as_ref())?;
            let report = proof(|| M::verify_data(given.into(), &mesh));
            report.map_err(|source| Failure::Points { path: input.path().into(), source })?
        }
        (_, _, Some(stored)) => {
            let report = proof(|| M::verify_data(stored.into(), &mesh));
            report.map_err(|source| Failure::Points { path: path.clone(), source })?
        }
        _ => return Err(Failure::NoPoints { path: path.clone() }),
    };
    tell(path, &report)
}

/// Prints the report, and fails unless all checks passed.
fn tell(path: &Path, report: &Report) -> Result<(), Failure> {
    let printed = writeln!(io::stdout().lock(), "{report}");
    // Also for those who do not read the report.
    conclude(path, report)?;
    Ok(printed?)
}

/// Checks that the points in a mesh's file, if any, are those of the input.
fn compare<const D: usize>(
    input: &Input,
    given: Points<'_, D>,
    path: &Path,
    stored: Option<&PointBuf<D>>,
) -> Result<(), Failure> {
    let Some(stored) = stored.map(Points::from) else { return Ok(()) };
    let what = if stored.len() != given.len() {
        format!("it has {} points, not {}", stored.len(), given.len())
    } else if let Some(i) = stored.iter().zip(given.iter()).position(|(stored, given)| stored != given) {
        format!("its point {i} is {:?}, not {:?}", stored.get(i), given.get(i))
    } else {
        return Ok(());
    };
    Err(Failure::OtherPoints { path: path.into(), input: input.path().into(), what })
}

/// Runs the verifier.
pub(super) fn proof<E>(verify: impl FnOnce() -> Result<Report, E>) -> Result<Report, E> {
    let _progress = Progress::new("verifying");
    verify()
}
