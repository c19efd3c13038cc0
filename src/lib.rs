//! Exact Delaunay triangulation of point clouds in 2D and 3D, on the CPU and the GPU.
//!
//! ```
//! let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
//! let mesh = gdel::delaunay3d(&points)?;
//! assert_eq!(mesh.tetrahedra.len(), 1);
//!
//! let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0f64]];
//! let mesh = gdel::delaunay2d(&points)?;
//! assert_eq!(mesh.triangles.len(), 2);
//! assert_eq!(mesh.hull, [0, 1, 2, 3]);
//! # Ok::<(), gdel::Error>(())
//! ```
//!
//! The mesh is a function of the input alone: the Delaunay triangulation of the exact coordinates,
//! where ties are broken as if point *i* (input index) had the lifted height |pᵢ|² + δᵢ with δ₀ ≫
//! δ₁ ≫ … > 0 infinitesimal. It is unique, has no flat tetrahedron or triangle, and every distinct
//! point is a vertex of it.
//!
//! [`Triangulator`] offers options: the backend, progress and cancellation, the GPU to use, and
//! methods that do not block. [`verify`] proves that a mesh is the Delaunay triangulation of its
//! points, whoever computed it.
//!
//! # Which answer for which question
//!
//! | question | answer |
//! | --- | --- |
//! | Which simplex contains a point? Which vertices are nearest to it? | [`Locator`] |
//! | What is the value at a point, given values at the vertices? | [`Interpolator`] |
//! | Where do values at the points have a level? | [`Contours`] |
//! | Which region belongs to each point, how large is it, who are its neighbours? | [`Voronoi`] |
//! | With which weights do the cells have given volumes? | [`Triangulator::transport3d`] |
//! | Which solid, or which surface, do the points describe? | [`AlphaShape`] |
//! | Which balls meet, and which shape has their union? | [`BallComplex`] |
//! | What connects all points at the least length? Which clusters are there? | [`SpanningTree`] |
//! | Which triangles has a polygon with holes, or a terrain with breaklines? | [`Triangulator::constrained2d`] |
//! | How does such a mesh get triangles for simulations, without small angles? | [`Constrained2::refine`] |
//! | Which few points of a scan make a terrain that is near to all of them? | [`Triangulator::tin`] |
//! | How are more points triangulated than fit into one memory, or by machines that share none? | [`tiles`] |
//! | The same for places on a globe, by longitude and latitude | [`Sphere`] |
//! | Which edges, facets and neighbours are there? | [`Mesh3::edges`], [`facets`](Mesh3::facets), [`vertex_neighbors`](Mesh3::vertex_neighbors) |
//! | How large and how well shaped is each simplex? | [`Mesh3::volumes`], [`circumcenters`](Mesh3::circumcenters), [`radius_ratios`](Mesh3::radius_ratios) |
#![cfg_attr(
    all(feature = "gpu", not(target_arch = "wasm32")),
    doc = "| The same for a mesh on the GPU | [`DeviceLocator`], [`DeviceMesh::edges`] |"
)]
//!
//! # Features
//!
//! | feature | what it adds |
//! | --- | --- |
//! | `gpu` (default) | the GPU backend, by [wgpu](https://docs.rs/wgpu); else [`Backend::Auto`] is the CPU |
//! | `threads` (implied by `gpu`) | the CPU backend on several threads |
//! | `serde` | `Serialize` and `Deserialize` for meshes, `Serialize` for statistics |
//! | `glam`, `mint`, `nalgebra`, `ndarray` | conversions of these crates' points into [`Points`], without a copy |
//!
//! The program `gdel` is the crate `gdel-cli`, and the file formats that it reads and writes are in `gdel-io`.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

// What data passes through, in this order.
mod input;
mod predicates;
mod triangulator;

// The wings, 2D and 3D, file by file the same; and the engines, as far as the dimensions share
// them.
mod cpu;
mod d2;
mod d3;
mod dimension;
mod geometry;
#[cfg(feature = "gpu")]
mod gpu;

// What is derived from a mesh, and what else is made of one.
mod constrained;
mod derived;
pub mod tiles;

// What a run says about itself, and what is checked afterwards.
mod backend;
mod error;
mod mesh;
mod options;
pub mod stats;
pub mod verify;

// Tools.
mod fields;
mod index;
#[doc(hidden)]
pub mod internals;
mod parallel;
mod platform;
mod random;
mod slots;

pub use backend::Backend;
pub use constrained::{
    Constrained2, Constraints, Fill, RefineLeft, RefineOptions, RefineStats, Refined2, Size, Tin, TinOptions, TinStats,
};
pub use d2::{
    Mesh2,
    verify::{MeshView2, verify2d},
};
pub use d3::{
    Mesh3,
    verify::{MeshView3, verify3d},
};
pub use derived::{
    AlphaComplex, AlphaShape, AlphaShape2, BallComplex, BallComplex2, Cell, Clip, Contour, Contours, Contours2,
    Diagram, Duplicates, Evidence, FaceClass, Grid, Interpolated, Interpolation, Interpolator, Interpolator2, Interval,
    Location, Locator, Locator2, Open, Outside, Side, SpanningTree, Sphere, Surface, SurfaceOptions, Transport,
    TransportOptions, Voronoi, Voronoi2, WeightTable, lon_lat, on_sphere,
};
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub use derived::{DeviceLocator, DeviceLocator2, Locations};
pub use error::Error;
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub use gpu::device_edges::DeviceEdges;
#[cfg(feature = "gpu")]
pub use gpu::{
    AdapterChoice, AdapterSummary,
    device_mesh::{DeviceMesh, DeviceMesh2, DeviceMesh3, Outputs},
};
pub use index::NONE;
pub use input::points::{Points, Points2, Points3};
#[cfg(feature = "mint")]
pub use input::points::{from_mint2, from_mint3};
pub use mesh::{Csr, Mesh};
pub use options::Progress;
pub use predicates::{Sign, incircle, insphere, orient2d, orient3d};
#[cfg(feature = "gpu")]
pub use triangulator::DeviceTriangulator;
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub use triangulator::adapters;
pub use triangulator::{Editable, Triangulator};
#[cfg(feature = "gpu")]
pub use wgpu;

/// Returns the 3D Delaunay triangulation of `points`.
///
/// `points` may be slices, arrays or vectors of `[f32; 3]` or `[f64; 3]`, or [`Points`] of another
/// form. The backend is [`Backend::Auto`]: the first large input opens a GPU, which is kept for the
/// process. [`Triangulator`] gives the choice.
///
/// Coplanar, collinear, coincident and empty input is not an error: the mesh then has no
/// tetrahedra, and its [`dimension`](Mesh3::dimension) says why.
///
/// # Examples
///
/// ```
/// let mut points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// points.push([1.0, 1.0, 1.0]);
/// let mesh = gdel::delaunay3d(&points)?;
/// assert_eq!((mesh.tetrahedra.len(), mesh.hull.len()), (2, 6));
/// # Ok::<(), gdel::Error>(())
/// ```
///
/// # Errors
///
/// Returns [`Error::NotFinite`] gives the first coordinate that is NaN or infinite,
/// [`Error::TooManyPoints`] what would fit. [`Error::TooManySimplices`] and [`Error::OutOfMemory`]
/// concern inputs of extreme size.
pub fn delaunay3d<'a>(points: impl Into<Points3<'a>>) -> Result<Mesh3, Error> {
    Triangulator::of_process().delaunay3d(points)
}

/// Returns the 2D Delaunay triangulation of `points`.
///
/// `points` may be slices, arrays or vectors of `[f32; 2]` or `[f64; 2]`, or [`Points`] of another
/// form. The backend is [`Backend::Auto`]: the first large input opens a GPU, which is kept for the
/// process. [`Triangulator`] gives the choice.
///
/// Collinear, coincident and empty input is not an error: the mesh then has no triangles, and its
/// [`dimension`](Mesh2::dimension) says why.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// assert_eq!(mesh.triangles.len(), 1);
/// // Counter-clockwise with y up.
/// assert_eq!(mesh.hull, [0, 1, 2]);
/// # Ok::<(), gdel::Error>(())
/// ```
///
/// # Errors
///
/// Returns the errors of [`delaunay3d`].
pub fn delaunay2d<'a>(points: impl Into<Points2<'a>>) -> Result<Mesh2, Error> {
    Triangulator::of_process().delaunay2d(points)
}

/// Compiles and runs the README's examples.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Compiles and runs the examples of what is derived from meshes.
#[cfg(doctest)]
#[doc = include_str!("../docs/answers.md")]
struct Answers;
