//! The meshes that follow their points.

use crate::{
    cpu::update::{Limits, update},
    d2::Mesh2,
    d3::Mesh3,
    error::Error,
    input::points::{Points2, Points3},
    mesh::{MeshInfo, sealed::Sealed},
    options::Options,
    stats::UpdateStats,
    triangulator::Triangulator,
};

/// A mesh that [`Triangulator::update`] takes: [`Mesh3`] or [`Mesh2`].
///
/// It cannot be implemented for others.
///
/// # Examples
///
/// ```
/// use gdel::{Backend, Error, Mesh2, Mesh3, Moving, Points3, Triangulator};
///
/// fn follow<'a, M: Moving>(mesh: &mut M, points: impl Into<M::Points<'a>>) -> Result<(), Error> {
///     Triangulator::new().backend(Backend::Cpu).update(mesh, points)
/// }
///
/// let mut mesh = gdel::delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?;
/// follow(&mut mesh, &[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0f64]])?;
/// assert_eq!(mesh.canonical(), [[0, 1, 2]]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[expect(async_fn_in_trait, reason = "only this crate implements it, and no caller is generic over threads")]
pub trait Moving: Sealed + MeshInfo + Sized {
    /// The points of the mesh.
    type Points<'a>: Copy;

    /// Returns the repaired mesh, or nothing if the points have to be triangulated from scratch,
    /// and what was done.
    #[doc(hidden)]
    fn repaired(&self, points: Self::Points<'_>, options: &Options) -> Result<(Option<Self>, UpdateStats), Error>;

    #[doc(hidden)]
    fn from_scratch(triangulator: &Triangulator, points: Self::Points<'_>) -> Result<Self, Error>;

    #[doc(hidden)]
    async fn from_scratch_async(triangulator: &Triangulator, points: Self::Points<'_>) -> Result<Self, Error>;
}

impl Moving for Mesh3 {
    type Points<'a> = Points3<'a>;

    fn repaired(&self, points: Points3<'_>, options: &Options) -> Result<(Option<Self>, UpdateStats), Error> {
        update::<3>(self, points, options, Limits::measured(3))
    }

    fn from_scratch(triangulator: &Triangulator, points: Points3<'_>) -> Result<Self, Error> {
        triangulator.delaunay3d(points)
    }

    async fn from_scratch_async(triangulator: &Triangulator, points: Self::Points<'_>) -> Result<Self, Error> {
        triangulator.delaunay3d_async(points).await
    }
}

impl Moving for Mesh2 {
    type Points<'a> = Points2<'a>;

    fn repaired(&self, points: Points2<'_>, options: &Options) -> Result<(Option<Self>, UpdateStats), Error> {
        update::<2>(self, points, options, Limits::measured(2))
    }

    fn from_scratch(triangulator: &Triangulator, points: Points2<'_>) -> Result<Self, Error> {
        triangulator.delaunay2d(points)
    }

    async fn from_scratch_async(triangulator: &Triangulator, points: Self::Points<'_>) -> Result<Self, Error> {
        triangulator.delaunay2d_async(points).await
    }
}
