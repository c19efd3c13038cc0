//! File formats: point clouds in, meshes and hulls out.
//!
//! Everything here works on bytes and [`std::io::Write`]; only [`files`] knows paths. A reader takes a whole file, so
//! what a header promises is checked against what is there before anything is allocated, and every error says where in
//! the file it is.
//!
//! Crates read the formats where one was found that neither panics nor allocates on a broken file's word, or that can
//! be guarded against it; the modules that read a format themselves say why.

mod error;
#[cfg(not(target_arch = "wasm32"))]
pub mod files;
mod format;
mod glb;
mod las;
mod mesh_data;
mod npy;
mod npz;
mod obj;
mod pcd;
mod plane;
mod ply;
mod point_cloud;
mod raw;
mod stl;
mod tetgen;
mod text;
mod vtu;

pub use error::{FormatError, Position};
pub use format::{HullFormat, MeshFormat, PointFormat};
pub use glb::write_hull_glb;
pub use las::panics_are_caught;
pub use mesh_data::{MeshData, MeshData2};
pub use npz::{read_npz, read_npz2, write_npz, write_npz2};
pub use obj::write_hull_obj;
pub use plane::{
    PlanePoints, drop_z, read_ele2, read_vtu2, write_ele2, write_glb2, write_neigh2, write_obj2, write_ply2,
    write_stl2, write_vtu2,
};
pub use ply::write_hull_ply;
pub use point_cloud::{PointBuf, PointCloud};
pub use stl::write_hull_stl;
pub use tetgen::{read_ele, read_neigh, write_ele, write_neigh, write_node};
pub use vtu::{read_vtu, write_vtu};
