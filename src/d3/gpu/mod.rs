//! The GPU engine of 3D: what differs from that of 2D.

pub mod aliases;
#[cfg(not(target_arch = "wasm32"))]
mod arrays;
pub mod buffers;
mod dim;
mod engine;
pub(crate) mod exchange;
pub mod finish;
pub mod outputs;
#[cfg(not(target_arch = "wasm32"))]
mod pool;
pub mod trace;
pub mod vertex;
#[cfg(not(target_arch = "wasm32"))]
mod whole;
