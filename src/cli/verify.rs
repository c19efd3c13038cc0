//! `gdel verify`: the proof that a mesh is the Delaunay triangulation of its points.

use super::{Failure, progress::Progress};
use clap::Args;
use gdel::{
    io::{PointCloud, files},
    verify::{Report, Statement, verify3d},
};
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Prove that a mesh is the Delaunay triangulation of its points, or say what is wrong with it.
#[derive(Args)]
pub(super) struct Arguments {
    /// The points, in any format that `triangulate` reads
    points: PathBuf,
    /// The mesh: .ele (with the .neigh beside it, if any), .vtu or .npz
    mesh: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (cloud, mesh) = {
        let _progress = Progress::new("reading");
        (files::read_points(&arguments.points)?, files::read_mesh(&arguments.mesh)?)
    };
    let report = prove(&arguments.points, &cloud, &mesh)?;
    writeln!(io::stdout().lock(), "{report}")?;
    conclude(&arguments.mesh, &report)
}

/// Checks `mesh` against the points, which come from the file `path`.
pub(super) fn prove<'m>(path: &Path, cloud: &PointCloud, mesh: impl Into<Statement<'m>>) -> Result<Report, Failure> {
    let _progress = Progress::new("verifying");
    verify3d(cloud, mesh).map_err(|source| Failure::Points { path: path.into(), source })
}

/// A failure that names `path` unless all checks passed.
pub(super) fn conclude(path: &Path, report: &Report) -> Result<(), Failure> {
    match report.failures().next() {
        Some((check, defect, _)) => Err(Failure::Mesh { path: path.into(), what: format!("{check}: {defect}") }),
        None => Ok(()),
    }
}
