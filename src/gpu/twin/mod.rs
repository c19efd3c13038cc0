//! The kernels' twins: the same functions on the CPU, for tests on the same buffers.

pub mod hilbert;
pub mod predicates;
