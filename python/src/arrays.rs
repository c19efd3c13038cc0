//! Arrays in and out.

use gdel::{Csr, Error, Points};
use numpy::{
    Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods,
    prelude::PyArrayDescrMethods,
};
use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    intern,
    prelude::*,
    sync::PyOnceLock,
    types::PyDict,
};
use std::{any::Any, sync::Arc};

/// Points or queries of the caller, one per row, borrowed from NumPy. The package has made sure that they are
/// contiguous and in single or double precision.
pub(crate) enum Input<'py> {
    /// In single precision.
    F32(PyReadonlyArray2<'py, f32>),
    /// In double precision.
    F64(PyReadonlyArray2<'py, f64>),
}

impl<'py> Input<'py> {
    /// Borrows an array.
    pub(crate) fn new(array: &Bound<'py, PyAny>) -> PyResult<Self> {
        let untyped = array.cast::<numpy::PyUntypedArray>()?;
        if untyped.dtype().is_equiv_to(&numpy::dtype::<f64>(array.py())) {
            Ok(Input::F64(array.extract()?))
        } else if untyped.dtype().is_equiv_to(&numpy::dtype::<f32>(array.py())) {
            Ok(Input::F32(array.extract()?))
        } else {
            Err(PyTypeError::new_err(format!("points of the type {} are not supported", untyped.dtype())))
        }
    }

    /// Returns the number of coordinates per point.
    pub(crate) fn dimension(&self) -> usize {
        match self {
            Input::F32(array) => array.shape()[1],
            Input::F64(array) => array.shape()[1],
        }
    }

    /// Returns the points.
    pub(crate) fn points<const D: usize>(&self) -> PyResult<Points<'_, D>> {
        if self.dimension() != D {
            return Err(PyValueError::new_err(format!("there are {} coordinates, not {D}", self.dimension())));
        }
        let wrong = |error: Error| PyValueError::new_err(error.to_string());
        match self {
            Input::F32(array) => Points::from_interleaved_f32(array.as_slice()?).map_err(wrong),
            Input::F64(array) => Points::from_interleaved_f64(array.as_slice()?).map_err(wrong),
        }
    }
}

/// Indices in Rust's memory that NumPy sees as 32-bit integers, in which `NONE` is −1, and cannot change.
#[pyclass(frozen)]
pub(crate) struct Indices {
    /// Keeps the indices where they are.
    _owner: Arc<dyn Any + Send + Sync>,
    address: usize,
    rows: usize,
    /// The number of columns; `None` for a list.
    columns: Option<usize>,
}

#[pymethods]
impl Indices {
    /// Describes the memory as NumPy's array interface does; NumPy keeps this object as long as its array.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", if cfg!(target_endian = "big") { ">i4" } else { "<i4" })?;
        interface.set_item("data", (self.address, true))?;
        match self.columns {
            Some(columns) => interface.set_item("shape", (self.rows, columns))?,
            None => interface.set_item("shape", (self.rows,))?,
        }
        Ok(interface)
    }
}

/// Returns an array of indices that `owner` keeps in place.
pub(crate) fn view<'py>(
    py: Python<'py>,
    owner: Arc<dyn Any + Send + Sync>,
    indices: &[u32],
    columns: Option<usize>,
) -> PyResult<Bound<'py, PyAny>> {
    static AS_ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let rows = indices.len() / columns.unwrap_or(1);
    let indices = Indices { _owner: owner, address: indices.as_ptr() as usize, rows, columns };
    let as_array = AS_ARRAY
        .get_or_try_init(py, || py.import(intern!(py, "numpy"))?.getattr(intern!(py, "asarray")).map(Bound::unbind))?;
    as_array.bind(py).call1((indices,))
}

/// Returns rows as an array, without a copy.
pub(crate) fn rows<T: Element, const N: usize>(py: Python<'_>, rows: Vec<[T; N]>) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    rows.into_flattened().into_pyarray(py).reshape([count, N])
}

/// Returns rows of indices as an array, without a copy.
pub(crate) fn index_rows<const N: usize>(py: Python<'_>, indices: Vec<[u32; N]>) -> PyResult<Bound<'_, PyArray2<i32>>> {
    let count = indices.len();
    list(py, indices.into_flattened()).reshape([count, N])
}

/// Returns indices as an array, without a copy.
pub(crate) fn list(py: Python<'_>, indices: Vec<u32>) -> Bound<'_, PyArray1<i32>> {
    bytemuck::cast_vec::<u32, i32>(indices).into_pyarray(py)
}

/// Returns offsets as an array, without a copy.
pub(crate) fn offsets(py: Python<'_>, offsets: Vec<usize>) -> Bound<'_, PyArray1<isize>> {
    bytemuck::cast_vec::<usize, isize>(offsets).into_pyarray(py)
}

/// Arrays of offsets and indices.
pub(crate) type PyCsr<'py> = (Bound<'py, PyArray1<isize>>, Bound<'py, PyArray1<i32>>);

/// Returns lists as their offsets and indices.
pub(crate) fn csr(py: Python<'_>, lists: Csr) -> PyCsr<'_> {
    (offsets(py, lists.offsets), list(py, lists.indices))
}
