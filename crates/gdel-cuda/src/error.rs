//! What CUDA reports, as errors.

use cudarc::driver::{DriverError, sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY};
use gdel::Error;

/// Returns the error for what CUDA reports.
pub(crate) fn failed(error: DriverError) -> Error {
    match error {
        DriverError(CUDA_ERROR_OUT_OF_MEMORY) => Error::OutOfDeviceMemory { label: "CUDA memory" },
        error => Error::Gpu { reason: format!("CUDA: {error}") },
    }
}
