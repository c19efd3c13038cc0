//! Exact Delaunay triangulation of point clouds.
//!
//! The result is a function of the input alone: the Delaunay triangulation of the input's exact coordinates, where
//! ties are broken as if point *i* (input index) had the lifted height |pᵢ|² + δᵢ with δ₀ ≫ δ₁ ≫ … > 0 infinitesimal.
//! It is unique, has no tetrahedron of zero volume, and every distinct point is a vertex of it.
//!
//! ```
//! let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
//! let mesh = gdel::delaunay3d(&points, &gdel::Options::default())?;
//! assert_eq!(mesh.tetrahedra.len(), 1);
//! # Ok::<(), gdel::Error>(())
//! ```
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod d2;
pub mod d3;
mod error;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod index;
pub mod input;
#[cfg(feature = "io")]
pub mod io;
pub mod options;
pub mod parallel;
pub mod predicates;
pub mod random;
#[cfg(feature = "gpu")]
pub mod reference;
pub mod stats;
#[cfg(feature = "gpu")]
pub mod triangulator;
pub mod verify;
#[cfg(all(feature = "wasm", target_arch = "wasm32"))]
mod wasm;

pub use d2::{
    Mesh2,
    verify::{MeshView2, verify2d},
};
pub use d3::{
    Mesh3,
    verify::{MeshView, verify3d},
};
pub use error::Error;
pub use input::points::{Points, Points2};
pub use options::{Backend, Options, Progress};
#[cfg(feature = "gpu")]
pub use triangulator::Triangulator;

/// The 3D Delaunay triangulation of `points`.
///
/// `points` may be slices or vectors of `[f32; 3]`, `[f64; 3]`, `glam::Vec3` or `glam::DVec3`; for interleaved
/// coordinates see [`Points::from_interleaved_f32`] and [`Points::from_interleaved_f64`].
///
/// Coplanar, collinear, coincident and empty input is no error: the mesh then has no tetrahedra and its
/// [`dimension`](Mesh3::dimension) says why.
///
/// The GPU engine is opened when it is first needed and kept for the process; see [`engines`] for more control, and for a
/// form that does not block.
///
/// # Errors
///
/// [`Error::NotFinite`] names the first coordinate that is NaN or infinite, [`Error::TooManyPoints`] says what would
/// fit, and [`Error::Cancelled`] follows a progress callback that broke off. [`Backend::Gpu`], and only that, can fail with
/// the errors of a GPU: [`Error::NoAdapter`], [`Error::DeviceLost`], [`Error::OutOfDeviceMemory`],
/// [`Error::BufferTooLarge`], [`Error::Gpu`].
pub fn delaunay3d<'a>(points: impl Into<Points<'a>>, options: &Options) -> Result<Mesh3, Error> {
    let points = points.into();
    match options.backend {
        Backend::Cpu => d3::cpu::delaunay3d(points, options),
        #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
        Backend::Auto | Backend::Gpu => pollster::block_on(Triangulator::shared().delaunay3d(points, options)),
        #[cfg(not(all(feature = "gpu", not(target_arch = "wasm32"))))]
        Backend::Auto => d3::cpu::delaunay3d(points, options),
        #[cfg(all(feature = "gpu", target_arch = "wasm32"))]
        Backend::Gpu => {
            Err(Error::NoAdapter { reason: "a browser's GPU cannot be waited for: use `Triangulator`".to_owned() })
        }
    }
}

/// The 2D Delaunay triangulation of `points`.
///
/// `points` may be slices or vectors of `[f32; 2]`, `[f64; 2]`, `glam::Vec2` or `glam::DVec2`; for interleaved
/// coordinates see [`Points::from_interleaved_f32`](Points::from_interleaved_f32) and
/// [`Points::from_interleaved_f64`](Points::from_interleaved_f64).
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points, &gdel::Options::default())?;
/// // Counter-clockwise where the y axis points down.
/// assert_eq!(mesh.hull, [0, 2, 1]);
/// # Ok::<(), gdel::Error>(())
/// ```
///
/// Collinear, coincident and empty input is no error: the mesh then has no triangles and its
/// [`dimension`](Mesh2::dimension) says why.
///
/// # Errors
///
/// As for [`delaunay3d`](crate::delaunay3d).
pub fn delaunay2d<'a>(points: impl Into<Points2<'a>>, options: &Options) -> Result<Mesh2, Error> {
    let points = points.into();
    match options.backend {
        Backend::Cpu => d2::cpu::delaunay2d(points, options),
        #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
        Backend::Auto | Backend::Gpu => pollster::block_on(Triangulator::shared().delaunay2d(points, options)),
        #[cfg(not(all(feature = "gpu", not(target_arch = "wasm32"))))]
        Backend::Auto => d2::cpu::delaunay2d(points, options),
        #[cfg(all(feature = "gpu", target_arch = "wasm32"))]
        Backend::Gpu => {
            Err(Error::NoAdapter { reason: "a browser's GPU cannot be waited for: use `Triangulator`".to_owned() })
        }
    }
}

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
