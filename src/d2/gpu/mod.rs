//! The GPU engine of the plane.

pub mod buffers;
pub(crate) mod certify;
pub mod engine;
pub(crate) mod kernels;
pub mod layout;
pub mod phase1;
pub mod run;
mod dim;
pub mod vertex;
