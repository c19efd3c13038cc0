//! Native targets.

#[cfg(feature = "gpu")]
pub(crate) mod gpu;
#[cfg(feature = "gpu")]
pub(crate) mod records;
#[cfg(not(feature = "threads"))]
pub(crate) use super::single as threads;
#[cfg(feature = "threads")]
pub(crate) use pool as threads;

#[cfg(feature = "threads")]
pub(crate) mod pool;

pub(crate) use std::time::Instant;

/// Whether 3D meshes are made on the device even where the host wants to have them. Memory of the host is plentiful.
#[cfg(feature = "gpu")]
pub(crate) const MESHES_STAY_ON_DEVICE: bool = false;

/// Whether a thread can wait for a GPU.
#[cfg(feature = "gpu")]
pub(crate) const CAN_WAIT: bool = true;

#[cfg(not(feature = "gpu"))]
pub(crate) use super::if_ready as wait;

/// Waits for a future.
#[cfg(feature = "gpu")]
pub(crate) fn wait<T>(work: impl Future<Output = T>) -> Option<T> {
    Some(pollster::block_on(work))
}

/// Returns the host as the engine takes it: natively there is only one kind.
#[cfg(feature = "gpu")]
pub(crate) fn any_host<H>(here: H) -> H {
    here
}
