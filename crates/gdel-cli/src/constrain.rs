//! Segments of `gdel triangulate`, from `--edges` or from shapes, and what becomes of them.

use super::{failure::Failure, progress::Progress, report::ConstraintCounts};
use clap::ValueEnum;
use gdel::{Constrained2, Constraints, Error, Fill, MeshView2, Points, verify::Report, verify2d};
use gdel_io::{
    PointCloud, ShapeFormat,
    files::{self, shown},
};
use std::path::Path;

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum FillRule {
    /// Keep all triangles
    All,
    /// Those from which a way out crosses boundaries an odd number of times
    Evenodd,
    /// Those around which boundaries wind, with counter-clockwise turns less clockwise ones
    Nonzero,
    /// Those from which no way leads out without crossing a segment
    Enclosed,
}

impl From<FillRule> for Fill {
    fn from(rule: FillRule) -> Self {
        match rule {
            FillRule::All => Fill::All,
            FillRule::Evenodd => Fill::EvenOdd,
            FillRule::Nonzero => Fill::NonZero,
            FillRule::Enclosed => Fill::Enclosed,
        }
    }
}

/// Points with segments between them.
pub(super) struct Constrained {
    pub(super) cloud: PointCloud<2>,
    pub(super) constraints: Constraints,
}

/// Reads the segments of points; those of boundaries, if there is a rule that needs some.
pub(super) fn read_edges(cloud: PointCloud<2>, edges: &Path, fill: Option<FillRule>) -> Result<Constrained, Failure> {
    let segments = files::read_edges(edges)?;
    let constraints = match fill.unwrap_or(FillRule::All) {
        rule @ (FillRule::All | FillRule::Enclosed) => Constraints::new().edges(&segments).fill(rule.into()),
        rule => Constraints::new().boundary(&segments).fill(rule.into()),
    };
    Ok(Constrained { cloud, constraints })
}

/// Reads shapes, with a note on standard error about what is left out.
pub(super) fn read_shapes(path: &Path, format: ShapeFormat, fill: Option<FillRule>) -> Result<Constrained, Failure> {
    let _progress = Progress::new("reading");
    let shapes = files::read_shapes(path, format)?;
    if shapes.dropped_z {
        eprintln!("gdel: {}: the z coordinates are dropped", shown(path));
    }
    if !shapes.left_out.is_empty() {
        eprintln!("gdel: {}: left out: {}", shown(path), shapes.left_out.join(", "));
    }
    let constraints = shapes.constraints();
    let constraints = match fill {
        Some(rule) => constraints.fill(rule.into()),
        None => constraints,
    };
    Ok(Constrained { cloud: shapes.into_cloud(), constraints })
}

/// Returns whether an error is one of the segments.
pub(super) fn is_of_segments(error: &Error) -> bool {
    matches!(error, Error::BadConstraint { .. } | Error::CrossingConstraints { .. } | Error::OpenBoundary { .. })
}

pub(super) fn counts(constraints: &Constraints, found: &Constrained2) -> ConstraintCounts {
    ConstraintCounts {
        segments: constraints.segments().len(),
        zero_length: found.zero_length,
        constrained_edges: found.mesh.constraints.len(),
        inside_triangles: found.inside_triangles().count(),
        added_points: found.added.len(),
        moved: found.moved,
    }
}

/// Verifies a mesh of points and segments.
pub(super) fn prove(points: Points<'_, 2>, found: &Constrained2) -> Result<Report, Error> {
    let mut view = MeshView2::from(&found.mesh);
    view.segments = Some(&found.segments);
    verify2d(points, view)
}
