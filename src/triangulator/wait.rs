//! Calls that block.

use crate::{error::Error, platform};

/// Why a call that blocks cannot use the GPU.
pub(super) const CANNOT_WAIT: &str = "a browser's GPU cannot be waited for; use the methods that end in `_async`";

/// Waits for a future. In WebAssembly, where nothing can wait, that is an error unless it is ready.
pub(super) fn wait<T>(work: impl Future<Output = Result<T, Error>>) -> Result<T, Error> {
    platform::wait(work).unwrap_or(Err(Error::GpuUnavailable { reason: CANNOT_WAIT }))
}
