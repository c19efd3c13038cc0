//! What a run says about itself.

use gdel::{
    Mesh3,
    io::PointCloud,
    splay::SplayStats,
    stats::{ExactCounts, GpuStats},
};
use serde::{Serialize, Serializer, ser::SerializeMap};
use std::{fmt, time::Duration};

/// The statistics of a run: as JSON by `serde`, for people by `Display`.
#[derive(Serialize)]
pub(super) struct Report<'a> {
    /// Those of the mesh, without the `no_return` of the file.
    points: usize,
    /// Points of the file that hold no measurement.
    no_return: usize,
    duplicates: usize,
    dimension: u8,
    tetrahedra: usize,
    hull_triangles: usize,
    engine: &'a str,
    /// Why the CPU engine made the mesh, where it was not asked for by name.
    #[serde(skip_serializing_if = "Option::is_none")]
    fallback: Option<String>,
    seconds: Seconds<'a>,
    /// Signs that the filters left open on the CPU.
    exact: ExactCounts,
    #[serde(skip_serializing_if = "Option::is_none")]
    gpu: Option<&'a GpuStats>,
    #[serde(skip_serializing_if = "Option::is_none")]
    splay: Option<&'a SplayStats>,
}

/// Without reading and writing files.
struct Seconds<'a> {
    total: Duration,
    phases: &'a [(&'static str, f64)],
}

impl Serialize for Seconds<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1 + self.phases.len()))?;
        map.serialize_entry("total", &self.total.as_secs_f64())?;
        for (phase, seconds) in self.phases {
            map.serialize_entry(phase, seconds)?;
        }
        map.end()
    }
}

impl<'a> Report<'a> {
    pub(super) fn new(cloud: &PointCloud, mesh: &'a Mesh3, total: Duration) -> Self {
        Report {
            points: cloud.points.len(),
            no_return: cloud.no_return,
            duplicates: mesh.duplicates(),
            dimension: mesh.dimension,
            tetrahedra: mesh.tetrahedra.len(),
            hull_triangles: mesh.hull.len(),
            engine: mesh.stats.engine,
            fallback: mesh.stats.fallback.as_ref().map(ToString::to_string),
            seconds: Seconds { total, phases: &mesh.stats.phases },
            exact: mesh.stats.exact,
            gpu: mesh.stats.gpu.as_ref(),
            splay: mesh.stats.splay.as_ref(),
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
        writeln!(f)?;
        if self.dimension < 3 {
            let shape = match (self.dimension, self.points) {
                (_, 0) => "there are no points",
                (0, _) => "all points are equal",
                (1, _) => "all points are collinear",
                _ => "all points are coplanar",
            };
            writeln!(f, "dimension       {} ({shape}, so there are no tetrahedra)", self.dimension)?;
        }
        writeln!(f, "tetrahedra      {}", self.tetrahedra)?;
        writeln!(f, "hull triangles  {}", self.hull_triangles)?;
        write!(f, "seconds         {:.3} ({}", self.seconds.total.as_secs_f64(), self.engine)?;
        if let Some(why) = &self.fallback {
            write!(f, ", since {why}")?;
        }
        for (phase, seconds) in self.seconds.phases {
            write!(f, ", {phase} {seconds:.3}")?;
        }
        write!(f, ")")
    }
}
