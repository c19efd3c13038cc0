//! The meshes that follow their points, when these move, come or go.

#[cfg(feature = "gpu")]
use crate::gpu::device_mesh::{DeviceMesh2, DeviceMesh3};
#[cfg(feature = "gpu")]
use crate::{
    cpu::Incremental,
    stats::{Phase, Stopwatch},
};
use crate::{
    cpu::edit::{Edit, Used, edit},
    d2::Mesh2,
    d3::Mesh3,
    dimension::Dimension,
    error::Error,
    input::points::{Points, Points2, Points3},
    mesh::{MeshInfo, sealed::Sealed},
    stats::{Restart, UpdateStats},
    triangulator::Triangulator,
};
#[cfg(feature = "gpu")]
use std::time::Duration;

/// A mesh that [`Triangulator::update`], [`insert`](Triangulator::insert) and
/// [`remove`](Triangulator::remove) take: [`Mesh3`], [`Mesh2`], and with the feature `gpu`
/// `DeviceMesh3` and `DeviceMesh2`.
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
pub trait Moving: Sealed + Sized {
    /// The points of the mesh.
    type Points<'a>: Copy;

    /// Returns the points if there are as many as the mesh has.
    #[doc(hidden)]
    fn as_many<'a>(&self, points: Self::Points<'a>) -> Result<Self::Points<'a>, Error>;

    #[doc(hidden)]
    fn follow(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error>;

    #[doc(hidden)]
    async fn follow_async(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error>;

    /// Takes the points from the number of points of the mesh on as new ones, and removes those with the
    /// indices in `removed`.
    #[doc(hidden)]
    fn edit(&mut self, triangulator: &Triangulator, points: Self::Points<'_>, removed: &[u32]) -> Result<(), Error>;

    #[doc(hidden)]
    async fn edit_async(
        &mut self,
        triangulator: &Triangulator,
        points: Self::Points<'_>,
        removed: &[u32],
    ) -> Result<(), Error>;
}

/// Returns the points if there are so many.
fn checked<const D: usize>(points: Points<'_, D>, expected: usize) -> Result<Points<'_, D>, Error> {
    match points.len() {
        len if len == expected => Ok(points),
        len => Err(Error::PointCount { points: len, expected }),
    }
}

/// Returns the mesh of all points, given that of those that are used, if not all are.
fn restored<const D: usize, M: MeshInfo + Send>(
    triangulator: &Triangulator,
    mut made: M,
    used: Option<Used<D>>,
    why: Restart,
) -> Result<M, Error> {
    if let Some(used) = used {
        used.restore(&mut made, triangulator.options.threads)?;
    }
    made.stats_mut().update = Some(UpdateStats::from_scratch(why));
    Ok(made)
}

/// Implements it for a mesh in the memory of the host.
macro_rules! on_host {
    ($D:literal, $N:literal, $mesh:ident, $points:ident, $scratch:ident, $scratch_async:ident) => {
        impl Moving for $mesh {
            type Points<'a> = $points<'a>;

            fn as_many<'a>(&self, points: Self::Points<'a>) -> Result<Self::Points<'a>, Error> {
                checked(points, self.duplicate_of.len())
            }

            fn follow(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error> {
                let points = self.as_many(points)?;
                let used = Used::of(points, &self.duplicate_of);
                let made = triangulator.$scratch(used.as_ref().map_or(points, Used::points))?;
                *self = restored(triangulator, made, used, Restart::NotResident)?;
                Ok(())
            }

            async fn follow_async(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
            ) -> Result<(), Error> {
                let points = self.as_many(points)?;
                let used = Used::of(points, &self.duplicate_of);
                let made = triangulator.$scratch_async(used.as_ref().map_or(points, Used::points)).await?;
                *self = restored(triangulator, made, used, Restart::NotResident)?;
                Ok(())
            }

            fn edit(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
                removed: &[u32],
            ) -> Result<(), Error> {
                if let Some(again) = edit::<$D, $N>(
                    self,
                    points,
                    removed,
                    &triangulator.options,
                    <Dimension<$D> as Edit<$D, $N>>::MAX_SHARE,
                )? {
                    let used = again.used(points);
                    let made = triangulator.$scratch(used.as_ref().map_or(points, Used::points))?;
                    *self = restored(triangulator, made, used, again.why)?;
                }
                Ok(())
            }

            async fn edit_async(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
                removed: &[u32],
            ) -> Result<(), Error> {
                if let Some(again) = edit::<$D, $N>(
                    self,
                    points,
                    removed,
                    &triangulator.options,
                    <Dimension<$D> as Edit<$D, $N>>::MAX_SHARE,
                )? {
                    let used = again.used(points);
                    let made = triangulator.$scratch_async(used.as_ref().map_or(points, Used::points)).await?;
                    *self = restored(triangulator, made, used, again.why)?;
                }
                Ok(())
            }
        }
    };
}
on_host!(3, 4, Mesh3, Points3, delaunay3d, delaunay3d_async);
on_host!(2, 3, Mesh2, Points2, delaunay2d, delaunay2d_async);

/// Has the host do what the future of a device does.
#[cfg(feature = "gpu")]
fn wait(work: impl Future<Output = Result<(), Error>>) -> Result<(), Error> {
    #[cfg(not(target_arch = "wasm32"))]
    {
        pollster::block_on(work)
    }
    #[cfg(target_arch = "wasm32")]
    {
        drop(work);
        Err(Error::Gpu { message: "in WebAssembly, only methods that end in _async can wait for it".to_owned() })
    }
}

/// Implements it for a mesh on the device.
#[cfg(feature = "gpu")]
macro_rules! on_device {
    ($D:literal, $N:literal, $mesh:ident, $points:ident, $scratch_async:ident, $on_device_async:ident) => {
        impl Sealed for $mesh {}

        impl Moving for $mesh {
            type Points<'a> = $points<'a>;

            fn as_many<'a>(&self, points: Self::Points<'a>) -> Result<Self::Points<'a>, Error> {
                checked(points, self.point_count())
            }

            fn follow(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error> {
                wait(self.follow_async(triangulator, points))
            }

            async fn follow_async(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
            ) -> Result<(), Error> {
                if !self.has_unused() {
                    return triangulator.device.update(self, points, &triangulator.options).await;
                }
                // The device triangulates all points or none.
                let mut stopwatch = Stopwatch::start();
                let mut mesh = self.read_all().await?;
                let read = stopwatch.lap();
                mesh.follow_async(triangulator, points).await?;
                *self = self.changed_by_host(mesh, read).await?;
                Ok(())
            }

            fn edit(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
                removed: &[u32],
            ) -> Result<(), Error> {
                wait(self.edit_async(triangulator, points, removed))
            }

            async fn edit_async(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
                removed: &[u32],
            ) -> Result<(), Error> {
                let mut stopwatch = Stopwatch::start();
                let mut mesh = self.read_all().await?;
                let read = stopwatch.lap();
                *self = match edit::<$D, $N>(
                    &mut mesh,
                    points,
                    removed,
                    &triangulator.options,
                    <Dimension<$D> as Edit<$D, $N>>::MAX_SHARE,
                )? {
                    None => self.changed_by_host(mesh, read).await?,
                    Some(again) => match again.used(points) {
                        None => {
                            let mut made = triangulator.$on_device_async(points).await?;
                            made.stats_mut().update = Some(UpdateStats::from_scratch(again.why));
                            made
                        }
                        Some(used) => {
                            let made = triangulator.$scratch_async(used.points()).await?;
                            let made = restored(triangulator, made, Some(used), again.why)?;
                            self.changed_by_host(made, read).await?
                        }
                    },
                };
                Ok(())
            }
        }

        impl $mesh {
            /// Returns the mesh that the host has made of this one, which took so long to read.
            async fn changed_by_host(
                &self,
                mut mesh: <Dimension<$D> as Incremental<$D>>::Mesh,
                read: Duration,
            ) -> Result<$mesh, Error> {
                let stats = &mut mesh.stats;
                stats.phases.insert(0, (Phase::Readback, read));
                if let Some(update) = &mut stats.update {
                    update.on_host = true;
                }
                $mesh::upload(self.gpu(), mesh).await
            }

            /// Makes the mesh one of the points that were not [removed](Triangulator::remove), numbered
            /// in their order, as [`Mesh3::compact`](crate::Mesh3::compact) does. The host does it: the
            /// mesh is read and uploaded. Blocks the thread.
            ///
            /// # Errors
            ///
            /// Returns the errors of [`read`](Self::read).
            #[cfg(not(target_arch = "wasm32"))]
            pub fn compact(&mut self) -> Result<Vec<u32>, Error> {
                pollster::block_on(self.compact_async())
            }

            /// Does the same without blocking the thread.
            ///
            /// # Errors
            ///
            /// Returns the errors of [`read_async`](Self::read_async).
            pub async fn compact_async(&mut self) -> Result<Vec<u32>, Error> {
                let mut mesh = self.read_all().await?;
                let kept = mesh.compact();
                *self = $mesh::upload(self.gpu(), mesh).await?;
                Ok(kept)
            }
        }
    };
}
#[cfg(feature = "gpu")]
on_device!(3, 4, DeviceMesh3, Points3, delaunay3d_async, delaunay3d_on_device_async);
#[cfg(feature = "gpu")]
on_device!(2, 3, DeviceMesh2, Points2, delaunay2d_async, delaunay2d_on_device_async);
