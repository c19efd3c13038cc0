//! Reference implementations of the GPU kernels on the CPU, for tests only: production code never imports them.

pub mod d2;
pub mod d3;
