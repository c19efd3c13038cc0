//! `--dim`: space or the plane.

use clap::ValueEnum;
use gdel::internals::io::{PlanePoints, PointCloud, drop_z};
use std::path::Path;

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Dimension {
    /// The plane: z is left out
    #[value(name = "2")]
    Two,
    /// StarPredicates
    #[value(name = "3")]
    Three,
}

/// The points of the plane, with a word on standard error if that loses a coordinate.
pub(super) fn plane_points(path: &Path, cloud: &PointCloud) -> PlanePoints {
    let (points, lost) = drop_z(cloud);
    if lost {
        eprintln!("gdel: {}: the z coordinates are dropped", path.display());
    }
    points
}
