//! Errors as Python's exceptions.

use gdel::Error;
use pyo3::{
    create_exception,
    exceptions::{PyIndexError, PyMemoryError, PyRuntimeError, PyValueError},
    prelude::*,
};

create_exception!(gdel, GpuError, PyRuntimeError, "The GPU cannot be opened, was lost, or is wrong.");

/// Returns the exception for an error.
pub(crate) fn exception(error: Error) -> PyErr {
    let message = error.to_string();
    match error {
        Error::OutOfMemory { .. } | Error::OutOfDeviceMemory { .. } => PyMemoryError::new_err(message),
        Error::BadIndex { .. } => PyIndexError::new_err(message),
        Error::GpuUnavailable { .. }
        | Error::NoAdapter { .. }
        | Error::AdapterNotFound { .. }
        | Error::DeviceLost { .. }
        | Error::BufferTooLarge { .. }
        | Error::Gpu { .. }
        | Error::WrongResults { .. } => GpuError::new_err(message),
        Error::Threads { .. } | Error::Cancelled => PyRuntimeError::new_err(message),
        _ => PyValueError::new_err(message),
    }
}
