//! 2D Delaunay triangulations. The folder mirrors [`d3`](crate::d3) file by file.

mod cpu;
mod edit;
pub mod generate;
#[cfg(feature = "gpu")]
pub mod gpu;
pub(crate) mod insert;
pub mod lawson;
mod mesh;
pub(crate) mod triangulation;
pub mod verify;

pub use mesh::Mesh2;
pub use triangulation::Triangulation2;
