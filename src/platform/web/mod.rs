//! WebAssembly in browsers and JavaScript runtimes.

#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(feature = "gpu")]
mod host;
#[cfg(feature = "gpu")]
pub(crate) mod records;
#[cfg(feature = "gpu")]
mod target;
pub(crate) use super::single as threads;

#[cfg(not(feature = "gpu"))]
mod no_clock;

#[cfg(feature = "gpu")]
pub use host::AnyHost;
#[cfg(feature = "gpu")]
pub(crate) use host::any_host;
#[cfg(not(feature = "gpu"))]
pub(crate) use no_clock::Instant;
#[cfg(feature = "gpu")]
pub(crate) use web_time::Instant;

/// Whether 3D meshes are made on the device even where the host wants to have them. So they need not fit the memory of
/// WebAssembly, and reach JavaScript with one copy.
#[cfg(feature = "gpu")]
pub(crate) const MESHES_STAY_ON_DEVICE: bool = true;

/// Whether a thread can wait for a GPU: its events come only when the thread is idle.
#[cfg(feature = "gpu")]
pub(crate) const CAN_WAIT: bool = false;

pub(crate) use super::if_ready as wait;
