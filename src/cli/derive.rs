//! What the commands that derive something from a triangulation have in common.

use super::{
    Failure,
    dimension::{Counts, Dimension, Triangulation, format_parser, read},
    input,
    progress::Progress,
    triangulate::{BackendName, StatsForm, triangulate},
};
use clap::Args;
use gdel::{
    Points, Triangulator,
    internals::io::{
        Mesh, PointCloud, PointFormat,
        files::{Input, ResultOutput},
    },
};
use serde::Serialize;
use std::{
    collections::BTreeMap,
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
    /// Replace the output even if it is no earlier output of gdel; CSV files, which nothing marks
    /// as such, are replaced with this only
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
    /// Print statistics instead of a summary: one line per run
    #[arg(long, value_enum)]
    stats: Option<StatsForm>,
    /// Do it this many times
    #[arg(long, value_name = "N", default_value = "1")]
    repeat: NonZeroUsize,
}

/// What a run says about itself: as JSON by `serde`, for people by `Display`.
#[derive(Serialize)]
struct Report<'a> {
    points: usize,
    dimension: u8,
    #[serde(flatten)]
    counts: Counts,
    #[serde(flatten)]
    results: &'a BTreeMap<&'static str, f64>,
    seconds: BTreeMap<&'static str, f64>,
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<16}{}", "points", self.points)?;
        match self.counts {
            Counts::D3 { tetrahedra, .. } => writeln!(f, "{:<16}{tetrahedra}", "tetrahedra")?,
            Counts::D2 { triangles, .. } => writeln!(f, "{:<16}{triangles}", "triangles")?,
        }
        for (name, value) in self.results {
            writeln!(f, "{:<16}{value}", name.replace('_', " "))?;
        }
        let seconds: Vec<String> = self.seconds.iter().map(|(name, time)| format!("{name} {time:.3}")).collect();
        write!(f, "{:<16}{}", "seconds", seconds.join(", "))
    }
}

/// What a command found, and the numbers about it that are printed.
pub(super) struct Found<T> {
    pub(super) result: T,
    pub(super) numbers: BTreeMap<&'static str, f64>,
}

impl Common {
    /// Creates the input of the points.
    pub(super) fn input(&self) -> Result<Input, Failure> {
        Ok(input(&self.points, self.format)?)
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

    /// Triangulates and calls `derive` with the mesh, as often as wanted, and prints what is to be said. Returns the last result.
    pub(super) fn run<M: Triangulation<D, N> + Mesh<D, N>, const D: usize, const N: usize, T>(
        &self,
        points: Points<'_, D>,
        what: &'static str,
        derive: impl Fn(&M) -> Result<Found<T>, gdel::Error>,
    ) -> Result<(M, T), Failure> {
        let failure = |source| Failure::Points { path: self.points.clone(), source };
        let triangulator = Triangulator::new().backend(self.backend.into());
        let mut last = None;
        for _ in 0..self.repeat.get() {
            // Each run gives its memory back before the next.
            drop(last.take());
            let (mesh, triangulating) = triangulate::<M, D, N>(points, &triangulator).map_err(failure)?;
            let progress = Progress::new(what);
            let start = Instant::now();
            let Found { result, numbers } = derive(&mesh).map_err(failure)?;
            let times = [("triangulate", triangulating), (what, start.elapsed())];
            drop(progress);
            self.print(&mesh, points.len(), &numbers, &times)?;
            last = Some((mesh, result));
        }
        // There is at least one run.
        last.ok_or(Failure::StandardOutput(io::ErrorKind::Other.into()))
    }

    fn print<M: Triangulation<D, N>, const D: usize, const N: usize>(
        &self,
        mesh: &M,
        points: usize,
        results: &BTreeMap<&'static str, f64>,
        times: &[(&'static str, Duration)],
    ) -> Result<(), io::Error> {
        let seconds = times.iter().map(|&(name, time)| (name, time.as_secs_f64())).collect();
        let report = Report { points, dimension: mesh.dimension(), counts: mesh.counts(), results, seconds };
        let mut stdout = io::stdout().lock();
        match self.stats {
            Some(StatsForm::Json) => {
                serde_json::to_writer(&mut stdout, &report)?;
                writeln!(stdout)
            }
            None => writeln!(stdout, "{report}"),
        }
    }
}

/// Writes the output, with a word on the terminal if that takes long.
pub(super) fn write<F: Copy>(
    output: &ResultOutput<F>,
    content: impl Fn(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    let _progress = Progress::new("writing");
    Ok(output.write(content)?)
}
