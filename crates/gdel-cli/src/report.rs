//! The report of a run.

use super::dimension::{Counts, Triangulation};
use clap::ValueEnum;
use gdel::{
    Backend, RefineStats,
    stats::{ExactCounts, Fallback, GpuStats, Phase, SplayStats},
};
use gdel_io::PointCloud;
use serde::{Serialize, Serializer, ser::SerializeMap};
use std::{
    fmt::{self, Display},
    io::{self, Write},
    time::Duration,
};

/// The statistics of a run: as JSON by `serde`, for people by `Display`.
#[derive(Serialize)]
pub(super) struct Report<'a> {
    /// The number of points of the mesh, without the `no_return` of the file.
    points: usize,
    /// Points of the file that hold no measurement.
    no_return: usize,
    /// Columns of a text file that are not coordinates.
    ignored_columns: usize,
    duplicates: usize,
    /// Points that are no vertices because of their weights, where there are different ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    hidden: Option<usize>,
    dimension: u8,
    /// The numbers of simplices and their faces.
    #[serde(flatten)]
    counts: Counts,
    /// What became of segments, where there are any.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub(super) constraints: Option<ConstraintCounts>,
    /// Whether the mesh was proven to be the triangulation that it should be, where that was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    verified: Option<bool>,
    backend: Backend,
    /// Why the CPU computed the mesh, where it was not requested explicitly.
    #[serde(skip_serializing_if = "Option::is_none")]
    fallback: Option<&'a Fallback>,
    seconds: Seconds<'a>,
    /// Predicate evaluations that the filters left open on the CPU.
    exact: ExactCounts,
    #[serde(skip_serializing_if = "Option::is_none")]
    gpu: Option<&'a GpuStats>,
    #[serde(skip_serializing_if = "Option::is_none")]
    splay: Option<&'a SplayStats>,
}

/// What became of segments.
#[derive(Clone, Copy, Serialize)]
pub(super) struct ConstraintCounts {
    pub(super) segments: usize,
    /// Segments that are ignored, since their ends are equal.
    pub(super) zero_length: usize,
    pub(super) constrained_edges: usize,
    pub(super) inside_triangles: usize,
    /// Points that were put at crossings.
    pub(super) added_points: usize,
    /// The greatest distance of one of these from its crossing.
    pub(super) moved: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) refined: Option<RefineStats>,
}

impl fmt::Display for ConstraintCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "constraints     {} edges of {} segments", self.constrained_edges, self.segments)?;
        if self.zero_length > 0 {
            write!(f, ", {} of them without a length", self.zero_length)?;
        }
        if self.added_points > 0 {
            write!(f, "; points at crossings: {}, ", self.added_points)?;
            match self.moved {
                0.0 => write!(f, "exactly there")?,
                moved => write!(f, "at most {moved:e} from there")?,
            }
        }
        writeln!(f, "\ninside          {} triangles", self.inside_triangles)?;
        let Some(RefineStats { points_on_segments, points_inside, min_angle, left, limited, .. }) = self.refined else {
            return Ok(());
        };
        write!(f, "refined         {points_on_segments} points on segments, {points_inside} beside them; ")?;
        write!(f, "the smallest angle is {min_angle:.2}°")?;
        let kept = [(left.input_angle, "between segments"), (left.resolution, "where coordinates are too coarse")];
        for (count, what) in kept.into_iter().filter(|&(count, _)| count > 0) {
            write!(f, ", {count} triangles below the bound {what}")?;
        }
        if limited {
            write!(
                f,
                "; more points are needed: {} triangles are below the bound, {} too large",
                left.limit, left.too_large
            )?;
        }
        writeln!(f)
    }
}

/// Without reading and writing files.
struct Seconds<'a> {
    total: Duration,
    phases: &'a [(Phase, Duration)],
}

impl Serialize for Seconds<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1 + self.phases.len()))?;
        map.serialize_entry("total", &self.total.as_secs_f64())?;
        for (phase, time) in self.phases {
            map.serialize_entry(phase, &time.as_secs_f64())?;
        }
        map.end()
    }
}

impl<'a> Report<'a> {
    pub(super) fn new<const D: usize, const N: usize>(
        cloud: &PointCloud<D>,
        mesh: &'a impl Triangulation<D, N>,
        total: Duration,
        verified: Option<bool>,
    ) -> Self {
        let stats = mesh.stats();
        Report {
            points: cloud.points.len(),
            no_return: cloud.no_return,
            ignored_columns: cloud.ignored_columns,
            duplicates: mesh.duplicates(),
            hidden: mesh.hidden_count(),
            dimension: mesh.dimension(),
            counts: mesh.counts(),
            constraints: None,
            verified,
            backend: stats.backend,
            fallback: stats.fallback.as_ref(),
            seconds: Seconds { total, phases: &stats.phases },
            exact: stats.exact,
            gpu: stats.gpu.as_ref(),
            splay: stats.splay.as_ref(),
        }
    }
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "points          {}", self.points)?;
        if self.duplicates > 0 {
            write!(f, " ({} duplicates)", self.duplicates)?;
        }
        if self.no_return > 0 {
            write!(f, " and {} without a return, dropped", self.no_return)?;
        }
        if let Some(hidden) = self.hidden {
            write!(f, ", {hidden} hidden")?;
        }
        match self.ignored_columns {
            0 => {}
            1 => write!(f, "; the column after the coordinates is ignored")?,
            n => write!(f, "; {n} columns after the coordinates are ignored")?,
        }
        writeln!(f)?;
        write!(f, "{}", Flatness { dimension: self.dimension, points: self.points, counts: self.counts })?;
        match self.counts {
            Counts::D3 { tetrahedra, hull_triangles } => {
                writeln!(f, "tetrahedra      {tetrahedra}\nhull triangles  {hull_triangles}")?;
            }
            Counts::D2 { triangles, hull_edges } => {
                writeln!(f, "triangles       {triangles}\nhull edges      {hull_edges}")?;
            }
        }
        if let Some(constraints) = self.constraints {
            write!(f, "{constraints}")?;
        }
        write!(f, "seconds         {:.3} ({}", self.seconds.total.as_secs_f64(), self.backend)?;
        if let Some(why) = &self.fallback {
            write!(f, ", since {why}")?;
        }
        for (phase, time) in self.seconds.phases {
            write!(f, ", {phase} {:.3}", time.as_secs_f64())?;
        }
        write!(f, ")")?;
        let kind = match (self.hidden, self.constraints) {
            (Some(_), _) => "regular",
            (None, Some(_)) => "constrained Delaunay",
            (None, None) => "Delaunay",
        };
        match self.verified {
            Some(true) => write!(f, "\nverified        this is the {kind} triangulation"),
            Some(false) => write!(f, "\nverified        NOT the {kind} triangulation"),
            None => Ok(()),
        }
    }
}

/// A line that says why there are no simplices, where the points are flat.
pub(super) struct Flatness {
    pub(super) dimension: u8,
    pub(super) points: usize,
    pub(super) counts: Counts,
}

impl fmt::Display for Flatness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (full, simplices) = match self.counts {
            Counts::D3 { .. } => (3, "tetrahedra"),
            Counts::D2 { .. } => (2, "triangles"),
        };
        if self.dimension == full {
            return Ok(());
        }
        let shape = match (self.dimension, self.points) {
            (_, 0) => "there are no points",
            (0, _) => "all points are equal",
            (1, _) => "all points are collinear",
            _ => "all points are coplanar",
        };
        writeln!(f, "dimension       {} ({shape}, so there are no {simplices})", self.dimension)
    }
}

/// How statistics are printed.
#[derive(Clone, Copy, ValueEnum)]
pub(super) enum StatsForm {
    /// One JSON object
    Json,
}

/// Prints the report of a run. Returns whether standard output is still open: after `gdel … | head
/// -1` the files are written all the same.
pub(super) fn print(form: Option<StatsForm>, report: &(impl Serialize + Display)) -> Result<bool, io::Error> {
    let text = match form {
        Some(StatsForm::Json) => serde_json::to_string(report)?,
        None => report.to_string(),
    };
    match writeln!(io::stdout().lock(), "{text}") {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(false),
        written => written.map(|()| true),
    }
}
