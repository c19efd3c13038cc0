//! The meshes that can be updated, and gain and lose points.

use crate::{
    cpu::{
        MeshOf,
        edit::{Edit, Used, edit},
    },
    d2::Mesh2,
    d3::Mesh3,
    dimension::Dimension,
    error::Error,
    input::points::Points,
    mesh::{Mesh, MeshInfo, sealed::Sealed},
    stats::{Restart, UpdateStats},
    triangulator::{Choice, Triangulator},
};
#[cfg(feature = "gpu")]
use crate::{
    gpu::device_mesh::{DeviceMesh2, DeviceMesh3},
    stats::{Phase, Stopwatch},
    triangulator::wait::wait,
};

/// A mesh of points with `D` coordinates that [`Triangulator::update`],
/// [`insert`](Triangulator::insert) and [`remove`](Triangulator::remove) change: [`Mesh3`], [`Mesh2`],
/// and with the feature `gpu` `DeviceMesh3` and `DeviceMesh2`.
///
/// It cannot be implemented for others.
///
/// # Examples
///
/// ```
/// use gdel::{Backend, Editable, Error, Points, Triangulator};
///
/// fn update<const D: usize>(mesh: &mut impl Editable<D>, points: Points<'_, D>) -> Result<(), Error> {
///     Triangulator::new().backend(Backend::Cpu).update(mesh, points)
/// }
///
/// let mut mesh = gdel::delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?;
/// update(&mut mesh, (&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0f64]]).into())?;
/// assert_eq!(mesh.canonical(), [[0, 1, 2]]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[expect(async_fn_in_trait, reason = "only this crate implements it, and no caller is generic over threads")]
pub trait Editable<const D: usize>: Sealed + Sized {
    /// Returns the number of points, the removed ones included.
    fn point_count(&self) -> usize;

    #[doc(hidden)]
    async fn update(&mut self, triangulator: &Triangulator, points: Points<'_, D>) -> Result<(), Error>;

    #[doc(hidden)]
    fn update_weights(
        &mut self,
        triangulator: &Triangulator,
        points: Points<'_, D>,
        weights: &[f64],
    ) -> Result<(), Error>;

    /// Inserts the points of `points` that the mesh does not have yet, which are the last ones, and
    /// removes those with the indices in `removed`.
    #[doc(hidden)]
    async fn edit(&mut self, triangulator: &Triangulator, points: Points<'_, D>, removed: &[u32]) -> Result<(), Error>;
}

/// Checks that a mesh is a Delaunay triangulation.
fn check_delaunay<const D: usize, const N: usize>(mesh: &impl Mesh<D, N>) -> Result<(), Error> {
    match (mesh.weights().is_empty(), mesh.constraints().is_empty()) {
        (false, _) => Err(Error::WeightedMesh),
        (true, false) => Err(Error::ConstrainedMesh),
        (true, true) => Ok(()),
    }
}

/// Checks that a mesh has as many points.
pub(super) fn check_count<const D: usize>(mesh: &impl Editable<D>, points: usize) -> Result<(), Error> {
    match mesh.point_count() {
        expected if expected == points => Ok(()),
        expected => Err(Error::PointCount { points, expected }),
    }
}

/// Triangulates the used ones of the points; if there is no list of these, all.
async fn from_scratch<const D: usize>(
    triangulator: &Triangulator,
    points: Points<'_, D>,
    used: Option<Used<D>>,
    why: Restart,
) -> Result<MeshOf<D>, Error>
where
    Dimension<D>: Choice<D>,
    MeshOf<D>: Default,
{
    let mut mesh = MeshOf::<D>::default();
    triangulator.triangulate(used.as_ref().map_or(points, Used::points), &mut mesh).await?;
    if let Some(used) = used {
        used.restore(&mut mesh, triangulator.options.threads)?;
    }
    mesh.stats_mut().update = Some(UpdateStats::from_scratch(why));
    Ok(mesh)
}

/// Implements [`Editable`] for a mesh in the memory of the host.
macro_rules! on_host {
    ($D:literal, $N:literal, $mesh:ident) => {
        impl Editable<$D> for $mesh {
            fn point_count(&self) -> usize {
                self.duplicate_of.len()
            }

            async fn update(&mut self, triangulator: &Triangulator, points: Points<'_, $D>) -> Result<(), Error> {
                check_count(self, points.len())?;
                if !Mesh::weights(self).is_empty() {
                    let weights = self.weights.clone();
                    return self.update_weights(triangulator, points, &weights);
                }
                check_delaunay(self)?;
                let used = Used::of(points, &self.duplicate_of);
                *self = from_scratch(triangulator, points, used, Restart::NotResident).await?;
                Ok(())
            }

            fn update_weights(
                &mut self,
                triangulator: &Triangulator,
                points: Points<'_, $D>,
                weights: &[f64],
            ) -> Result<(), Error> {
                check_count(self, points.len())?;
                if !Mesh::constraints(self).is_empty() {
                    return Err(Error::ConstrainedMesh);
                }
                // Points of weighted meshes cannot be removed.
                if self.unused_count() > 0 {
                    return Err(Error::WeightedMesh);
                }
                let mut mesh = triangulator.regular::<$D>(points, weights)?;
                mesh.stats.update = Some(UpdateStats::from_scratch(Restart::NotResident));
                *self = mesh;
                Ok(())
            }

            async fn edit(
                &mut self,
                triangulator: &Triangulator,
                points: Points<'_, $D>,
                removed: &[u32],
            ) -> Result<(), Error> {
                check_delaunay(self)?;
                let max_share = <Dimension<$D> as Edit<$D, $N>>::MAX_SHARE;
                if let Some(again) = edit::<$D, $N>(self, points, removed, &triangulator.options, max_share)? {
                    *self = from_scratch(triangulator, points, again.used(points), again.why).await?;
                }
                Ok(())
            }
        }
    };
}
on_host!(3, 4, Mesh3);
on_host!(2, 3, Mesh2);

/// Implements [`Editable`] for a mesh on a device.
#[cfg(feature = "gpu")]
macro_rules! resident {
    ($D:literal, $N:literal, $mesh:ident) => {
        impl Sealed for $mesh {}

        impl Editable<$D> for $mesh {
            fn point_count(&self) -> usize {
                $mesh::point_count(self)
            }

            async fn update(&mut self, triangulator: &Triangulator, points: Points<'_, $D>) -> Result<(), Error> {
                if !self.has_unused() {
                    return triangulator.device.update(self, points, &triangulator.options).await;
                }
                // The device triangulates all points or none.
                check_count(self, points.len())?;
                let used = Used::of(points, self.duplicate_of());
                let made = from_scratch(triangulator, points, used, Restart::NotResident).await?;
                *self = self.changed_by_host(made).await?;
                Ok(())
            }

            fn update_weights(&mut self, _: &Triangulator, _: Points<'_, $D>, _: &[f64]) -> Result<(), Error> {
                Err(Error::WeightedMesh)
            }

            async fn edit(
                &mut self,
                triangulator: &Triangulator,
                points: Points<'_, $D>,
                removed: &[u32],
            ) -> Result<(), Error> {
                let mut stopwatch = Stopwatch::start();
                let mut mesh = self.read_all().await?;
                let read = stopwatch.lap();
                let max_share = <Dimension<$D> as Edit<$D, $N>>::MAX_SHARE;
                *self = match edit::<$D, $N>(&mut mesh, points, removed, &triangulator.options, max_share)? {
                    None => {
                        mesh.stats.phases.insert(0, (Phase::Readback, read));
                        self.changed_by_host(mesh).await?
                    }
                    Some(again) => match again.used(points) {
                        None => {
                            let mut made = triangulator.device.resident(points, &triangulator.options).await?;
                            made.stats_mut().update = Some(UpdateStats::from_scratch(again.why));
                            made
                        }
                        used => {
                            let made = from_scratch(triangulator, points, used, again.why).await?;
                            self.changed_by_host(made).await?
                        }
                    },
                };
                Ok(())
            }
        }

        impl $mesh {
            /// Returns the mesh that the host has made of this one.
            async fn changed_by_host(&self, mut mesh: MeshOf<$D>) -> Result<$mesh, Error> {
                if let Some(update) = &mut mesh.stats.update {
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
            /// Returns the errors of [`read_async`](Self::read_async).
            pub fn compact(&mut self) -> Result<Vec<u32>, Error> {
                wait(self.compact_async())
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
resident!(3, 4, DeviceMesh3);
#[cfg(feature = "gpu")]
resident!(2, 3, DeviceMesh2);
