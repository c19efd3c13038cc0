//! The GPU engine of 2D: what differs from that of 3D.

pub mod aliases;
pub(crate) mod certify;
mod dim;
mod engine;
pub mod finish;
mod host;
pub mod layout;
pub mod outputs;
pub mod vertex;
