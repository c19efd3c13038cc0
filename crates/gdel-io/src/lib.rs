//! File formats: reads point clouds and meshes, writes point clouds, meshes and hulls.
//!
//! Everything here works on bytes and [`std::io::Write`]; only [`files`] knows paths. A reader
//! takes a whole file. It compares the counts of a header with the size of the file before it
//! allocates memory, and every error says where in the file it is. No reader drops a point
//! silently: a contradiction in the file is an error.
//!
//! Other crates read a format where one was found that neither panics on a broken file nor
//! allocates what it promises, or that can be guarded. Modules that read a format themselves say
//! why.

mod archive;
mod colors;
mod e57;
mod edges;
mod error;
#[cfg(not(target_arch = "wasm32"))]
pub mod files;
mod format;
mod geojson;
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
mod poly;
mod ptx;
mod raster;
mod raw;
mod scalar;
mod shapes;
mod solver;
mod stl;
mod surface;
mod svg;
mod table;
mod tetgen;
mod text;
mod three_mf;
mod tiles;
mod vtu;

pub use colors::{ColorSource, PointColors};
pub use edges::read_edges;
pub use error::{FormatError, Position, printable};
pub use format::{MeshFormat, PointFormat, ShapeFormat, SolverFormat, SurfaceFormat, TableFormat};
pub use las::panics_are_caught;
pub use mesh::{Mesh, MeshData, MeshData2, MeshData3};
pub use npz::{read_npz, write_npz};
pub use point_cloud::{PointBuf, PointCloud};
pub use raster::Raster;
pub use shapes::Shapes;
pub use solver::{write_msh, write_poly};
pub use table::{CellShape, Column, Grid, Table};
pub use tetgen::{read_ele, read_neigh, write_ele, write_neigh, write_node, write_weighted_node};
pub use tiles::{append_links, read_tile, read_tile_vtu, write_pvtu, write_tile, write_tile_vtu};
pub use vtu::{read_vtu, write_vtu};
