//! The GPU engine of 3D: what differs from that of 2D.

pub mod aliases;
#[cfg(not(target_arch = "wasm32"))]
mod beside;
pub mod buffers;
mod dim;
mod engine;
pub(crate) mod exchange;
pub mod finish;
mod host;
pub mod outputs;
mod stars;
pub mod trace;
pub mod vertex;
#[cfg(not(target_arch = "wasm32"))]
mod whole;
