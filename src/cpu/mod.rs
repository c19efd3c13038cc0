//! The CPU engine.
use crate::{Error, Mesh3, Options, Points};

/// The triangulation of `points` by incremental insertion.
///
/// # Errors
///
/// As for [`delaunay3d`](crate::delaunay3d).
pub fn delaunay3d(points: Points<'_>, options: &Options) -> Result<Mesh3, Error> {
    points.validate()?;
    options.report("sort", 0.0)?;
    todo!()
}
