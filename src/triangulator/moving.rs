//! The meshes that follow their points.

#[cfg(feature = "gpu")]
use crate::gpu::device_mesh::{DeviceMesh2, DeviceMesh3};
use crate::{
    cpu::update::{Limits, update},
    d2::Mesh2,
    d3::Mesh3,
    error::Error,
    input::points::{Points2, Points3},
    mesh::{MeshInfo, sealed::Sealed},
    triangulator::Triangulator,
};

/// A mesh that [`Triangulator::update`] takes: [`Mesh3`], [`Mesh2`], and with the feature `gpu`
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

    #[doc(hidden)]
    fn follow(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error>;

    #[doc(hidden)]
    async fn follow_async(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error>;
}

/// Implements it for a mesh in the memory of the host.
macro_rules! on_host {
    ($D:literal, $mesh:ident, $points:ident, $scratch:ident, $scratch_async:ident) => {
        impl Moving for $mesh {
            type Points<'a> = $points<'a>;

            fn follow(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error> {
                let (repaired, stats) = update::<$D>(self, points, &triangulator.options, Limits::measured($D))?;
                *self = match repaired {
                    Some(repaired) => repaired,
                    None => {
                        let mut made = triangulator.$scratch(points)?;
                        made.stats_mut().update = Some(stats);
                        made
                    }
                };
                Ok(())
            }

            async fn follow_async(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
            ) -> Result<(), Error> {
                let (repaired, stats) = update::<$D>(self, points, &triangulator.options, Limits::measured($D))?;
                *self = match repaired {
                    Some(repaired) => repaired,
                    None => {
                        let mut made = triangulator.$scratch_async(points).await?;
                        made.stats_mut().update = Some(stats);
                        made
                    }
                };
                Ok(())
            }
        }
    };
}
on_host!(3, Mesh3, Points3, delaunay3d, delaunay3d_async);
on_host!(2, Mesh2, Points2, delaunay2d, delaunay2d_async);

/// Implements it for a mesh on the device.
#[cfg(feature = "gpu")]
macro_rules! on_device {
    ($mesh:ident, $points:ident) => {
        impl Sealed for $mesh {}

        impl Moving for $mesh {
            type Points<'a> = $points<'a>;

            fn follow(&mut self, triangulator: &Triangulator, points: Self::Points<'_>) -> Result<(), Error> {
                #[cfg(not(target_arch = "wasm32"))]
                {
                    pollster::block_on(self.follow_async(triangulator, points))
                }
                #[cfg(target_arch = "wasm32")]
                {
                    let _ = (triangulator, points);
                    Err(Error::Gpu { message: "in WebAssembly, only update_async can wait for it".to_owned() })
                }
            }

            async fn follow_async(
                &mut self,
                triangulator: &Triangulator,
                points: Self::Points<'_>,
            ) -> Result<(), Error> {
                triangulator.device.update(self, points, &triangulator.options).await
            }
        }
    };
}
#[cfg(feature = "gpu")]
on_device!(DeviceMesh3, Points3);
#[cfg(feature = "gpu")]
on_device!(DeviceMesh2, Points2);
