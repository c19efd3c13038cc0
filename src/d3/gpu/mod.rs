//! The GPU engine of space.

pub mod buffers;
pub mod engine;
pub mod finish;
pub mod flip;
pub mod insert;
pub(crate) mod memory;
pub mod phase1;
pub mod relocate;
pub mod run;
mod dim;
pub(crate) mod trace;
pub mod vertex;
