//! The frame of the commands that derive something from a triangulation.

use super::{
    backend::BackendName,
    dimension::{Counts, Dimension, Triangulation, format_parser, read},
    failure::Failure,
    progress::Progress,
    report::{Flatness, StatsForm, print},
    triangulate::triangulate,
};
use clap::{
    Args,
    error::ErrorKind::{ArgumentConflict, MissingRequiredArgument},
};
use gdel::{Backend, Error, Points, Triangulator, stats::Fallback};
use gdel_io::{
    CellShape, Grid, Mesh, PointCloud, PointFormat, SurfaceFormat, Table, TableFormat,
    files::{Input, ResultOutput},
};
use serde::{Serialize, Serializer};
use std::{
    fmt,
    io::{self, Write},
    num::NonZeroUsize,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

/// Arguments of all these commands.
#[derive(Args)]
pub(super) struct Common {
    /// The points, in any format that `triangulate` reads, or `-` for standard input, with
    /// `--format`
    pub(super) points: PathBuf,
    /// Replace the output even if it is not marked as an earlier output of gdel; CSV files have no
    /// mark, so they always need this
    #[arg(short, long)]
    force: bool,
    /// The dimension of the points; 2D drops z
    #[arg(long, value_enum, default_value_t = Dimension::Three)]
    pub(super) dim: Dimension,
    /// The format of the points, whatever the extension of their file
    #[arg(long, value_parser = format_parser())]
    format: Option<PointFormat>,
    /// Where to triangulate; the mesh is the same everywhere
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    backend: BackendName,
    #[command(flatten)]
    runs: Runs,
}

/// How often a command does its work, and what it prints.
#[derive(Args)]
pub(super) struct Runs {
    /// Print statistics instead of a summary: one line per run
    #[arg(long, value_enum)]
    pub(super) stats: Option<StatsForm>,
    /// Do it this many times
    #[arg(long, value_name = "N", default_value = "1")]
    repeat: NonZeroUsize,
}

impl Runs {
    /// Calls `run` as often as requested, or until nobody reads what it prints, which it returns with its result. Returns
    /// the last result.
    pub(super) fn repeated<T>(&self, run: impl Fn() -> Result<(T, bool), Failure>) -> Result<T, Failure> {
        // Each run gives its memory back before the next.
        for _ in 1..self.repeat.get() {
            if !run()?.1 {
                break;
            }
        }
        Ok(run()?.0)
    }
}

/// Arguments of the commands that take query points.
#[derive(Args)]
pub(super) struct Queries {
    /// The query points, in any format that `triangulate` reads, or `-` for standard input, with
    /// `--queries-format`
    queries: PathBuf,
    /// The format of the queries, whatever the extension of their file
    #[arg(long, value_name = "FORMAT", value_parser = format_parser())]
    queries_format: Option<PointFormat>,
}

impl Queries {
    /// Creates the input of the queries, beside that of the points.
    pub(super) fn input(&self, points: &Input) -> Result<Input, Failure> {
        let standard_input = Path::new("-");
        if self.queries == standard_input {
            if self.queries_format.is_none() {
                let what = "give the format of the queries with `--queries-format`";
                return Err(Failure::Usage(MissingRequiredArgument, what.into()));
            }
            if points.path() == standard_input {
                let what = "only one of the points and the queries can be standard input";
                return Err(Failure::Usage(ArgumentConflict, what.into()));
            }
        }
        Ok(Input::new(&self.queries, self.queries_format)?)
    }

    /// Reads the queries, and checks that all are finite.
    pub(super) fn read<const D: usize>(input: &Input) -> Result<PointCloud<D>, Failure> {
        let queries = read::<D>(input)?;
        let are_valid = Points::from(&queries).validate();
        are_valid.map_err(|source| Failure::Points { path: input.path().into(), source })?;
        Ok(queries)
    }
}

/// The formats for what has a shape and values: a grid, or tables of the values.
#[derive(Debug, Clone, Copy)]
pub(super) enum GridFormat {
    Vtu,
    Csv,
    Npz,
}

/// Parses the name of a file for `what`, such as "Voronoi cells". An error lists the extensions that are `known`.
pub(super) fn parse_grid(
    path: &str,
    what: &'static str,
    known: &[&'static str],
) -> Result<ResultOutput<GridFormat>, String> {
    let format_of = |extension: &str| match extension.to_ascii_lowercase().as_str() {
        "vtu" => Some(GridFormat::Vtu),
        "csv" => Some(GridFormat::Csv),
        "npz" => Some(GridFormat::Npz),
        _ => None,
    };
    ResultOutput::new(Path::new(path), what, format_of, known).map_err(|error| error.to_string())
}

/// The formats for a solid and its surface.
#[derive(Debug, Clone, Copy)]
pub(super) enum SolidFormat {
    /// The triangles of the surface.
    Surface(SurfaceFormat),
    /// The simplices of the solid.
    Vtu,
}

/// Parses the name of a file for `what`, such as "alpha shapes".
pub(super) fn parse_solid(path: &str, what: &'static str) -> Result<ResultOutput<SolidFormat>, String> {
    let format_of = |extension: &str| match extension.to_ascii_lowercase().as_str() {
        "vtu" => Some(SolidFormat::Vtu),
        other => SurfaceFormat::from_extension(other).map(SolidFormat::Surface),
    };
    let known = ["ply", "obj", "stl", "glb", "3mf", "vtu"];
    ResultOutput::new(Path::new(path), what, format_of, &known).map_err(|error| error.to_string())
}

/// The report of a run: as JSON by `serde`, for people by `Display`.
#[derive(Serialize)]
struct Report<'a> {
    points: usize,
    duplicates: usize,
    /// Points that are no vertices because of their weights, where there are different ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    hidden: Option<usize>,
    dimension: u8,
    #[serde(flatten)]
    counts: Counts,
    #[serde(flatten, serialize_with = "as_map")]
    numbers: &'a [(&'static str, Number)],
    backend: Backend,
    /// Why the CPU computed the mesh, where it was not requested explicitly.
    #[serde(skip_serializing_if = "Option::is_none")]
    fallback: Option<&'a Fallback>,
    /// Without reading and writing files.
    #[serde(serialize_with = "as_map")]
    seconds: &'a [(&'static str, f64)],
}

/// Serialises names and what they stand for.
pub(super) fn as_map<T: Serialize, S: Serializer>(
    entries: &impl AsRef<[(&'static str, T)]>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.as_ref().iter().map(|(name, value)| (name, value)))
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<16}{}", "points", self.points)?;
        if self.duplicates > 0 {
            write!(f, " ({} duplicates)", self.duplicates)?;
        }
        if let Some(hidden) = self.hidden {
            write!(f, ", {hidden} hidden")?;
        }
        writeln!(f)?;
        write!(f, "{}", Flatness { dimension: self.dimension, points: self.points, counts: self.counts })?;
        match self.counts {
            Counts::D3 { tetrahedra, .. } => writeln!(f, "{:<16}{tetrahedra}", "tetrahedra")?,
            Counts::D2 { triangles, .. } => writeln!(f, "{:<16}{triangles}", "triangles")?,
        }
        numbers(f, self.numbers)?;
        let seconds: Vec<String> = self.seconds.iter().map(|(name, time)| format!("{name} {time:.3}")).collect();
        write!(f, "{:<16}{}", "seconds", seconds.join(", "))
    }
}

/// Writes numbers, one on each line, after their names.
pub(super) fn numbers(f: &mut fmt::Formatter<'_>, numbers: &[(&'static str, Number)]) -> fmt::Result {
    for (name, number) in numbers {
        let name = name.replace('_', " ");
        match *number {
            Number::Count(count) => writeln!(f, "{name:<16}{count}")?,
            // With an exponent where digits would be many.
            Number::Real(real) if real == 0.0 || (1e-5..1e16).contains(&real.abs()) => {
                writeln!(f, "{name:<16}{real}")?;
            }
            Number::Real(real) => writeln!(f, "{name:<16}{real:e}")?,
            Number::Name(word) => writeln!(f, "{name:<16}{word}")?,
            Number::Truth(truth) => writeln!(f, "{name:<16}{}", if truth { "yes" } else { "no" })?,
        }
    }
    Ok(())
}

/// A number, what is true or not, or a word, that a command prints.
#[derive(Clone, Copy, Serialize)]
#[serde(untagged)]
pub(super) enum Number {
    Count(usize),
    Real(f64),
    Truth(bool),
    Name(&'static str),
}

/// The result of a command, and the numbers about it that are printed.
pub(super) struct Found<T> {
    pub(super) result: T,
    pub(super) numbers: Vec<(&'static str, Number)>,
}

impl Common {
    /// Creates the input of the points.
    pub(super) fn input(&self) -> Result<Input, Failure> {
        Ok(Input::new(&self.points, self.format)?)
    }

    /// Checks early that the output can be written and is none of the inputs.
    pub(super) fn check<F: Copy>(&self, output: &ResultOutput<F>, inputs: &[&Path]) -> Result<(), Failure> {
        Ok(output.check(inputs, self.force)?)
    }

    /// Reads the points.
    pub(super) fn read<const D: usize>(&self, input: &Input) -> Result<PointCloud<D>, Failure> {
        let _progress = Progress::new("reading");
        read::<D>(input)
    }

    /// Checks the output as [`check`](Self::check) does, and reads the points.
    pub(super) fn read_for<const D: usize, F: Copy>(&self, output: &ResultOutput<F>) -> Result<PointCloud<D>, Failure> {
        let input = self.input()?;
        self.check(output, &[input.path()])?;
        self.read::<D>(&input)
    }

    /// Reads the points, and the values in a column of their file.
    pub(super) fn read_with_values<const D: usize>(
        &self,
        input: &Input,
        column: &str,
    ) -> Result<(PointCloud<D>, Vec<f64>), Failure> {
        let _progress = Progress::new("reading");
        Ok(input.read_with_values::<D>(column)?)
    }

    /// Triangulates, calls `derive` with the mesh and prints the report, as often as requested.
    /// Returns the last mesh and what was derived from it.
    pub(super) fn run<M: Triangulation<D, N> + Mesh<D, N>, const D: usize, const N: usize, T>(
        &self,
        points: Points<'_, D>,
        what: &'static str,
        derive: impl Fn(&M) -> Result<Found<T>, Error>,
    ) -> Result<(M, T), Failure> {
        self.run_weighted((points, None), what, derive)
    }

    /// Does the same with points that may have weights.
    pub(super) fn run_weighted<M: Triangulation<D, N> + Mesh<D, N>, const D: usize, const N: usize, T>(
        &self,
        (points, weights): (Points<'_, D>, Option<&[f64]>),
        what: &'static str,
        derive: impl Fn(&M) -> Result<Found<T>, Error>,
    ) -> Result<(M, T), Failure> {
        let failure = |source| Failure::Points { path: self.points.clone(), source };
        // One device for all runs.
        let triangulator = Triangulator::new().backend(self.backend.into());
        let run = || {
            let (mesh, triangulating) = triangulate::<M, D, N>(points, weights, &triangulator).map_err(failure)?;
            let progress = Progress::new(what);
            let start = Instant::now();
            let Found { result, numbers } = derive(&mesh).map_err(failure)?;
            let deriving = start.elapsed();
            drop(progress);
            let times = [("triangulate", triangulating), (what, deriving)];
            let is_read = self.print(&mesh, points.len(), &numbers, &times)?;
            Ok::<_, Failure>(((mesh, result), is_read))
        };
        self.runs.repeated(run)
    }

    fn print<M: Triangulation<D, N>, const D: usize, const N: usize>(
        &self,
        mesh: &M,
        points: usize,
        numbers: &[(&'static str, Number)],
        times: &[(&'static str, Duration)],
    ) -> Result<bool, io::Error> {
        let total = ("total", times.iter().map(|(_, time)| time).sum());
        let seconds: Vec<_> = [total].iter().chain(times).map(|&(name, time)| (name, time.as_secs_f64())).collect();
        let stats = mesh.stats();
        let report = Report {
            points,
            duplicates: mesh.duplicates(),
            hidden: mesh.hidden_count(),
            dimension: mesh.dimension(),
            counts: mesh.counts(),
            numbers,
            backend: stats.backend,
            fallback: stats.fallback.as_ref(),
            seconds: &seconds,
        };
        print(self.runs.stats, &report)
    }
}

/// Writes the output, with a progress message on the terminal if that takes long.
pub(super) fn write<F: Copy>(
    output: &ResultOutput<F>,
    content: impl Fn(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    let _progress = Progress::new("writing");
    Ok(output.write(content)?)
}

/// Parses the name of a file for a table.
pub(super) fn parse_table(path: &str) -> Result<ResultOutput<TableFormat>, String> {
    let known = ["csv", "npz"];
    let output = ResultOutput::new(Path::new(path), "tables", TableFormat::from_extension, &known);
    output.map_err(|error| error.to_string())
}

/// Writes a table in the format of its file.
pub(super) fn write_table(output: &ResultOutput<TableFormat>, table: &Table) -> Result<(), Failure> {
    write(output, |to| match output.format() {
        TableFormat::Csv => table.write_csv(to),
        TableFormat::Npz => table.write_npz(to),
    })
}

/// Writes simplices as cells of a grid.
pub(super) fn write_cells<F: Copy, const D: usize, const K: usize>(
    output: &ResultOutput<F>,
    points: Points<'_, D>,
    shape: CellShape,
    cells: &[[u32; K]],
) -> Result<(), Failure> {
    let mut grid = Grid::new(points, shape);
    cells.iter().for_each(|cell| grid.push(*cell));
    write(output, |to| grid.write_vtu(to))
}

/// Writes triangles, which are simplices in 2D or facets in 3D, under a name.
pub(super) fn write_triangles<F: Copy, const D: usize, const K: usize>(
    output: &ResultOutput<F>,
    format: SurfaceFormat,
    points: Points<'_, D>,
    triangles: &[[u32; K]],
    name: &'static str,
) -> Result<(), Failure> {
    let triangles: Vec<[u32; 3]> = triangles.iter().map(|vertices| std::array::from_fn(|k| vertices[k])).collect();
    write(output, |to| format.write_triangles(to, points, &triangles, name))
}
