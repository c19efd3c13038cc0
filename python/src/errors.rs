//! Errors as Python's exceptions.

use gdel::Error;
use pyo3::{
    create_exception,
    exceptions::{PyIndexError, PyMemoryError, PyRuntimeError, PyValueError},
    prelude::*,
};

create_exception!(gdel, GpuError, PyRuntimeError, "The GPU cannot be opened, was lost, or is wrong.");
create_exception!(gdel, CrossingError, PyValueError, "Segments cross where there is no point; `pairs` are the first.");

/// Returns the exception for segments that cross, with their ends in pairs.
fn crossing(message: String, pairs: Vec<[[u32; 2]; 2]>) -> PyErr {
    let error = CrossingError::new_err(message);
    let pairs: Vec<_> =
        pairs.into_iter().map(|pair| <((u32, u32), (u32, u32))>::from(pair.map(<(u32, u32)>::from))).collect();
    match Python::attach(|py| error.value(py).setattr("pairs", pairs)) {
        Ok(()) => error,
        Err(other) => other,
    }
}

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
        Error::CrossingConstraints { pairs, .. } => crossing(message, pairs),
        _ => PyValueError::new_err(message),
    }
}
