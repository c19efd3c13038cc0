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

pub mod cpu;
#[cfg(feature = "gpu")]
pub mod engines;
mod error;
pub mod generate;
#[cfg(feature = "gpu")]
pub mod gpu;
mod hilbert;
#[cfg(feature = "gpu")]
pub mod hybrid;
#[cfg(feature = "io")]
pub mod io;
pub mod lattice;
pub mod mesh;
pub mod options;
pub mod parallel;
pub mod plane;
pub mod points;
pub mod predicates;
pub mod splay;
pub mod stats;
#[cfg(feature = "gpu")]
mod trace;
pub mod triangulation;
pub mod verify;
#[cfg(all(feature = "wasm", target_arch = "wasm32"))]
mod wasm;

#[cfg(feature = "gpu")]
pub use engines::Engines;
pub use error::Error;
pub use mesh::Mesh3;
pub use options::{Engine, Options, Progress};
pub use plane::{Mesh2, delaunay2d};
pub use points::{Points, Points2};

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
/// fit, and [`Error::Cancelled`] follows a progress callback that broke off. [`Engine::Gpu`], and only that, can fail with
/// the errors of a GPU: [`Error::NoAdapter`], [`Error::DeviceLost`], [`Error::OutOfDeviceMemory`],
/// [`Error::BufferTooLarge`], [`Error::Gpu`].
pub fn delaunay3d<'a>(points: impl Into<Points<'a>>, options: &Options) -> Result<Mesh3, Error> {
    let points = points.into();
    match options.engine {
        Engine::Cpu => cpu::delaunay3d(points, options),
        #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
        Engine::Auto | Engine::Gpu => pollster::block_on(engines::Engines::shared().delaunay3d(points, options)),
        #[cfg(not(all(feature = "gpu", not(target_arch = "wasm32"))))]
        Engine::Auto => cpu::delaunay3d(points, options),
        #[cfg(all(feature = "gpu", target_arch = "wasm32"))]
        Engine::Gpu => {
            Err(Error::NoAdapter { reason: "a browser's GPU cannot be waited for: use `Engines`".to_owned() })
        }
    }
}

/// Compiles and runs the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
