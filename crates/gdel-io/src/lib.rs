//! File formats: reads point clouds and meshes, writes point clouds, meshes and hulls.
//!
//! Everything here works on bytes and [`std::io::Write`]; only [`files`] knows paths. A reader
//! takes a whole file, so what a header promises is checked against what is there before anything
//! is allocated, and every error says where in the file it is. No reader drops a point silently:
//! what does not add up is an error.
//!
//! Crates read the formats where one was found that neither panics nor allocates on a broken file's
//! word, or that can be guarded against it; the modules that read a format themselves say why.

mod colors;
mod e57;
mod error;
#[cfg(not(target_arch = "wasm32"))]
pub mod files;
mod format;
mod glb;
mod las;
mod mesh;
mod npy;
mod npz;
mod obj;
mod off;
mod pcd;
mod ply;
mod point_cloud;
mod raw;
mod scalar;
mod stl;
mod surface;
mod table;
mod tetgen;
mod text;
mod vtu;

pub use colors::{ColorSource, PointColors};
pub use error::{FormatError, Position, printable};
pub use format::{MeshFormat, PointFormat, SurfaceFormat, TableFormat};
pub use las::panics_are_caught;
pub use mesh::{Mesh, MeshData, MeshData2, MeshData3};
pub use npz::{read_npz, write_npz};
pub use point_cloud::{PointBuf, PointCloud};
pub use table::{CellShape, Column, Grid, Table};
pub use tetgen::{read_ele, read_neigh, write_ele, write_neigh, write_node};
pub use vtu::{read_vtu, write_vtu};
