//! Delaunay triangulation of points in CUDA memory, with the mesh in CUDA memory: on NVIDIA's GPUs under Linux.
//!
//! [`gdel`] computes by Vulkan. Arrays go to CUDA through memory of the GPU that both interfaces see, never through the
//! host. Points are read by the host as well, which decides what rounding leaves open.
//!
//! # Examples
//!
//! ```no_run
//! use gdel_cuda::{CudaTriangulator, Precision, Tensor};
//!
//! # fn addresses() -> (u64, u64) { (0, 0) }
//! let triangulator = CudaTriangulator::new(0)?;
//! // The addresses of 100,000 points in CUDA memory before and after they have moved.
//! let (points, moved) = addresses();
//! // SAFETY: there are so many, and nobody writes them meanwhile.
//! let tensor = |address| unsafe { Tensor::new(address, [100_000, 3], Precision::Single, 0, ()) };
//! let mut mesh = triangulator.delaunay3d(&tensor(points))?;
//! let simplices = mesh.simplices().to_cuda()?;
//! println!("{} rows of {} at {:#x}", simplices.rows(), simplices.columns(), simplices.address());
//! triangulator.update3d(&mut mesh, &tensor(moved))?;
//! # Ok::<(), gdel::Error>(())
//! ```
#![cfg(target_os = "linux")]

mod array;
mod device;
mod error;
mod mesh;
#[cfg(feature = "python")]
mod python;
mod staging;
mod tensor;
mod triangulator;

pub use array::{CudaArray, MeshArray};
pub use mesh::CudaMesh;
pub use tensor::{Precision, Tensor};
pub use triangulator::CudaTriangulator;
