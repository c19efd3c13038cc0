//! 3D Delaunay triangulations. The folder mirrors [`d2`](crate::d2) file by file.

mod adjacency;
mod cpu;
mod edit;
pub mod generate;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "gpu")]
mod hull;
pub(crate) mod insert;
pub mod mesh;
pub mod splay;
pub mod triangulation;
pub mod verify;

pub use mesh::Mesh3;
