//! WebAssembly in browsers and JavaScript runtimes.

#[cfg(feature = "gpu")]
pub(crate) mod gpu;
pub(crate) use super::single as threads;

#[cfg(not(feature = "gpu"))]
mod no_clock;

#[cfg(not(feature = "gpu"))]
pub(crate) use no_clock::Instant;
#[cfg(feature = "gpu")]
pub(crate) use web_time::Instant;
