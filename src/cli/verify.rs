//! `gdel verify`: the proof that a mesh is the Delaunay triangulation of its points.

use super::{
    Failure,
    dimension::{Dimension, plane_points},
    progress::Progress,
};
use clap::Args;
use gdel::{
    Points2,
    internals::io::{PointCloud, files},
    verify::{MeshView, MeshView2, Report, verify2d, verify3d},
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
    /// Whether the mesh consists of tetrahedra, or of triangles of the plane
    #[arg(long, value_enum, default_value_t = Dimension::Three)]
    dim: Dimension,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { points, mesh, dim } = arguments;
    let reading = Progress::new("reading");
    let cloud = files::read_points(points)?;
    let report = match dim {
        Dimension::Three => {
            let mesh = files::read_mesh(mesh)?;
            drop(reading);
            prove(points, &cloud, &mesh)?
        }
        Dimension::Two => {
            let mesh = files::read_mesh2(mesh)?;
            drop(reading);
            prove2(points, (&plane_points(points, &cloud)).into(), &mesh)?
        }
    };
    writeln!(io::stdout().lock(), "{report}")?;
    conclude(&arguments.mesh, &report)
}

/// Checks `mesh` against the points, which come from the file `path`.
pub(super) fn prove<'m>(path: &Path, cloud: &PointCloud, mesh: impl Into<MeshView<'m>>) -> Result<Report, Failure> {
    let _progress = Progress::new("verifying");
    verify3d(cloud, mesh).map_err(|source| Failure::Points { path: path.into(), source })
}

/// Checks `mesh` of the plane against the points, which come from the file `path`.
pub(super) fn prove2<'m>(path: &Path, points: Points2<'_>, mesh: impl Into<MeshView2<'m>>) -> Result<Report, Failure> {
    let _progress = Progress::new("verifying");
    verify2d(points, mesh).map_err(|source| Failure::Points { path: path.into(), source })
}

/// A failure that names `path` unless all checks passed.
pub(super) fn conclude(path: &Path, report: &Report) -> Result<(), Failure> {
    match report.failures().next() {
        Some((check, defect, _)) => Err(Failure::Mesh { path: path.into(), what: format!("{check}: {defect}") }),
        None => Ok(()),
    }
}
