//! `--edges` of `gdel triangulate`: segments, and what becomes of them.

use super::{failure::Failure, report::ConstraintCounts};
use clap::ValueEnum;
use gdel::{Constrained2, Constraints, Error, Fill, Mesh2, MeshView2, NONE, Points, verify::Report, verify2d};
use gdel_io::files::read_edges;
use std::path::Path;

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum FillRule {
    /// Keep all triangles
    All,
    /// Those from which a way out crosses boundaries an odd number of times
    Evenodd,
    /// Those around which boundaries wind, with counter-clockwise turns less clockwise ones
    Nonzero,
}

/// Reads segments, which get points where they cross if they are to be split.
pub(super) fn read_constraints(edges: &Path, fill: FillRule, is_split: bool) -> Result<Constraints, Failure> {
    let segments = read_edges(edges)?;
    let constraints = match fill {
        FillRule::All => Constraints::new().edges(&segments),
        FillRule::Evenodd => Constraints::new().boundary(&segments).fill(Fill::EvenOdd),
        FillRule::Nonzero => Constraints::new().boundary(&segments).fill(Fill::NonZero),
    };
    Ok(if is_split { constraints.split_crossings() } else { constraints })
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

/// Returns the triangles inside as a mesh, which ends where they do.
pub(super) fn inside(found: Constrained2) -> Mesh2 {
    let Constrained2 { mut mesh, inside, .. } = found;
    if inside.iter().all(|&inside| inside) {
        return mesh;
    }
    let mut places = vec![NONE; inside.len()];
    let kept: Vec<usize> = (0..inside.len()).filter(|&t| inside[t]).collect();
    (0..).zip(&kept).for_each(|(place, &t)| places[t] = place);
    let halfedge = |e: u32| match e {
        NONE => NONE,
        e if places[e as usize / 3] == NONE => NONE,
        e => 3 * places[e as usize / 3] + e % 3,
    };
    mesh.halfedges = kept.iter().map(|&t| mesh.halfedges[t].map(halfedge)).collect();
    mesh.triangles = kept.iter().map(|&t| mesh.triangles[t]).collect();
    mesh
}
