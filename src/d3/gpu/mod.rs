//! The GPU engine of 3D: what differs from that of 2D.

pub mod aliases;
pub mod buffers;
mod dim;
mod engine;
pub(crate) mod exchange;
pub mod finish;
mod host;
pub mod outputs;
pub mod trace;
pub mod vertex;
#[cfg(not(target_arch = "wasm32"))]
mod whole;
