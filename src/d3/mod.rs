//! 3D Delaunay triangulations. The folder mirrors [`d2`](crate::d2) file by file.

mod adjacency;
mod cpu;
mod edit;
pub mod generate;
#[cfg(feature = "gpu")]
pub mod gpu;
pub(crate) mod insert;
mod lawson;
pub mod mesh;
pub mod splay;
pub mod triangulation;
mod update;
pub mod verify;

pub use mesh::Mesh3;
