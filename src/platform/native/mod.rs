//! Native targets.

#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(not(feature = "threads"))]
pub(crate) use super::single as threads;
#[cfg(feature = "threads")]
pub(crate) use pool as threads;

#[cfg(feature = "threads")]
pub(crate) mod pool;

pub(crate) use std::time::Instant;
