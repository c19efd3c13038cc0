//! Segments of `gdel triangulate`, from `--edges` or from shapes, and what becomes of them.

use super::{failure::Failure, progress::Progress, report::ConstraintCounts};
use clap::{Args, ValueEnum};
use gdel::{
    Constrained2, Constraints, Error, Fill, MeshView2, Points, RefineOptions, RefineStats, Size, verify::Report,
    verify2d,
};
use gdel_io::{
    PointCloud, ShapeFormat, Shapes,
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

/// To what the triangles inside are refined.
#[derive(Args)]
pub(super) struct Refine {
    /// Add points until no triangle inside has an angle below these degrees, at most 34, except where segments meet under
    /// small angles. They are written after those of the input [default: 20 with the following options, else as it is]
    #[arg(long, value_name = "DEGREES", help_heading = "Refinement of constrained meshes")]
    min_angle: Option<f64>,
    /// Add points until no triangle inside has a larger area
    #[arg(long, value_name = "AREA", help_heading = "Refinement of constrained meshes")]
    max_area: Option<f64>,
    /// Add points until no triangle inside has a longer edge
    #[arg(long, value_name = "LENGTH", help_heading = "Refinement of constrained meshes")]
    max_edge: Option<f64>,
    /// Add at most this many points, and say so where more would be needed
    #[arg(long, value_name = "N", help_heading = "Refinement of constrained meshes")]
    max_points: Option<usize>,
}

impl Refine {
    /// Returns whether anything is to be refined.
    pub(super) fn is_given(&self) -> bool {
        self.min_angle.is_some() || self.max_area.is_some() || self.max_edge.is_some() || self.max_points.is_some()
    }

    fn options(&self) -> RefineOptions<'static> {
        let mut options = RefineOptions::default();
        options.min_angle = self.min_angle.unwrap_or(options.min_angle);
        options.size = self.max_edge.map_or(Size::Any, Size::Uniform);
        (options.max_area, options.max_points) = (self.max_area, self.max_points);
        options
    }

    /// Refines a mesh, and counts what was done, if that is asked for.
    pub(super) fn refine(&self, points: Points<'_, 2>, found: Constrained2) -> Result<Refined, Error> {
        let at_crossings = found.added.len();
        if !self.is_given() {
            return Ok(Refined { found, at_crossings, stats: None });
        }
        let refined = found.refine(points, &self.options())?;
        Ok(Refined { found: refined.constrained, at_crossings, stats: Some(refined.stats) })
    }
}

/// A constrained mesh, refined or not.
pub(super) struct Refined {
    pub(super) found: Constrained2,
    /// The number of points at crossings, which come first of those that were added.
    pub(super) at_crossings: usize,
    pub(super) stats: Option<RefineStats>,
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

/// Reads shapes with their heights, and notes on standard error what is left out.
pub(super) fn read_breaklines(path: &Path, format: ShapeFormat) -> Result<Shapes, Failure> {
    let _progress = Progress::new("reading");
    let shapes = files::read_shapes(path, format)?;
    if !shapes.left_out.is_empty() {
        eprintln!("gdel: {}: left out: {}", shown(path), shapes.left_out.join(", "));
    }
    Ok(shapes)
}

/// Reads shapes as they are seen from above, and notes on standard error what is left out.
pub(super) fn read_shapes(path: &Path, format: ShapeFormat, fill: Option<FillRule>) -> Result<Constrained, Failure> {
    let shapes = read_breaklines(path, format)?;
    if shapes.dropped_z {
        eprintln!("gdel: {}: the z coordinates are dropped", shown(path));
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

pub(super) fn counts(constraints: &Constraints, refined: &Refined) -> ConstraintCounts {
    let Refined { found, at_crossings, stats } = refined;
    ConstraintCounts {
        segments: constraints.segments().len(),
        zero_length: found.zero_length,
        constrained_edges: found.mesh.constraints.len(),
        inside_triangles: found.inside_triangles().count(),
        added_points: *at_crossings,
        moved: found.moved,
        refined: *stats,
    }
}

/// Verifies a mesh of points and segments.
pub(super) fn prove(points: Points<'_, 2>, found: &Constrained2) -> Result<Report, Error> {
    let mut view = MeshView2::from(&found.mesh);
    view.segments = Some(&found.segments);
    verify2d(points, view)
}
