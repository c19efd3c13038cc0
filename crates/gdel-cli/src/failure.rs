//! How commands fail.

use clap::error::ErrorKind;
use gdel::verify::Report;
use gdel_io::files::{FileError, shown};
use std::{
    io,
    path::{Path, PathBuf},
};

/// Why a command failed. The text is one line of printable characters.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    /// Wrong usage, which ends the program with 2.
    #[error("{1}")]
    Usage(ErrorKind, String),
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{}: {source}", shown(path))]
    Points { path: PathBuf, source: gdel::Error },
    #[error("{}: not the Delaunay triangulation: {what}", shown(path))]
    Mesh { path: PathBuf, what: String },
    #[error("{}: not a mesh of the points in {}: {what}", shown(path), shown(input))]
    OtherPoints { path: PathBuf, input: PathBuf, what: String },
    #[error(
        "{}: this file holds no points: name the file that does first, as in `gdel verify POINTS MESH`",
        shown(path)
    )]
    NoPoints { path: PathBuf },
    #[error("{}: damaged ({what}): remove the folder {} to begin anew", shown(path), shown(folder))]
    Damaged { path: PathBuf, folder: PathBuf, what: String },
    #[error("{}: {what}", shown(path))]
    Folder { path: PathBuf, what: String },
    #[error("{} computes wrong results", .0.join(" and "))]
    WrongDevices(Vec<String>),
    #[error("standard output: {0}")]
    StandardOutput(#[from] io::Error),
}

/// Creates a failure that names `path` unless all checks passed.
pub(super) fn conclude(path: &Path, report: &Report) -> Result<(), Failure> {
    match report.failures().next() {
        Some((check, defect, _)) => Err(Failure::Mesh { path: path.into(), what: format!("{check}: {defect}") }),
        None => Ok(()),
    }
}
