//! Tensors of Python's libraries.

use crate::{
    array::{CudaArray, MeshArray},
    device::ordinal_of,
    tensor::{Precision, Tensor},
};
use cudarc::driver::{result::stream::synchronize, sys::CUstream};
use dlpark::{
    DlpackElement, DlpackFlags, Managed, ManagedTensorBase,
    ffi::{DLDevice, DLDeviceType, DLManagedTensor, DLManagedTensorVersioned},
    metadata::Dynamic,
    python::{
        DlpackExporter, DlpackStream, ExportRequest, ImportRequest, StreamArg, consumer::stream::cuda, export_dlpack,
    },
};
use pyo3::{
    exceptions::{PyRuntimeError, PyTypeError, PyValueError},
    intern,
    prelude::*,
    types::{PyDict, PyTuple},
};
use std::ffi::c_void;

/// The stream on which points are read.
struct DefaultStream;

// SAFETY: every device has it, always.
unsafe impl DlpackStream for DefaultStream {
    fn as_python_arg(&self, _: Python<'_>, _: DLDevice) -> PyResult<StreamArg> {
        Ok(cuda(std::ptr::null_mut()))
    }
}

impl Tensor {
    /// Borrows the points of an object that speaks DLPack, or that has a CUDA array interface. Work on them is awaited.
    ///
    /// # Errors
    ///
    /// Returns a `TypeError` for what is not in CUDA memory, or not in single or double precision, and a `ValueError`
    /// for other shapes than two or three columns whose rows follow each other.
    pub fn from_python(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = object.py();
        if object.hasattr(intern!(py, "__dlpack__"))? {
            return Self::from_dlpack(object);
        }
        match object.getattr_opt(intern!(py, "__cuda_array_interface__"))? {
            Some(interface) => Self::from_interface(object, &interface.cast_into()?),
            None => {
                let kind = object.get_type().name()?;
                Err(PyTypeError::new_err(format!("points must be a tensor in CUDA memory, not {kind}")))
            }
        }
    }

    fn from_dlpack(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let request = ImportRequest::new(object.as_borrowed())?;
        let device = request.device()?;
        if device.device_type != DLDeviceType::CUDA {
            return Err(PyTypeError::new_err("points must be in CUDA memory; gdel.Delaunay takes those of the host"));
        }
        let imported = request.import(Some(&DefaultStream), None)?;
        let invalid = |error: dlpark::tensor::Error| PyValueError::new_err(error.to_string());
        let (address, shape, precision) = {
            let tensor = imported.validate().map_err(invalid)?;
            let precision = match tensor.dtype() {
                kind if kind == f32::DTYPE => Precision::Single,
                kind if kind == f64::DTYPE => Precision::Double,
                _ => return Err(wrong_type()),
            };
            if !tensor.is_compact().map_err(invalid)? {
                return Err(not_contiguous());
            }
            let shape = tensor.shape().iter().map(|&size| size as usize).collect::<Vec<_>>();
            (tensor.data_ptr() as u64 + tensor.byte_offset(), shape_of(&shape)?, precision)
        };
        // SAFETY: DLPack promises that the memory stays until it is given back. The caller must not write meanwhile.
        Ok(unsafe { Tensor::new(address, shape, precision, device.device_id as usize, imported.into_deleter()) })
    }

    fn from_interface(object: &Bound<'_, PyAny>, interface: &Bound<'_, PyDict>) -> PyResult<Self> {
        let interface = Interface::new(interface)?;
        let precision = match &*interface.typestr {
            "<f4" => Precision::Single,
            "<f8" => Precision::Double,
            _ => return Err(wrong_type()),
        };
        let shape = shape_of(&interface.shape)?;
        if !interface.is_compact(if precision == Precision::Single { 4 } else { 8 }) {
            return Err(not_contiguous());
        }
        let ordinal = ordinal_of(interface.address).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        if let Some(stream) = interface.stream {
            // SAFETY: whoever has the array names a stream that exists. 1 and 2 stand for default streams in CUDA as well.
            let waited = object.py().detach(|| unsafe { synchronize(stream as CUstream) });
            waited.map_err(|error| PyValueError::new_err(format!("the stream of the points: {error}")))?;
        }
        // SAFETY: the object keeps the memory. The caller must not write meanwhile.
        Ok(unsafe { Tensor::new(interface.address, shape, precision, ordinal, object.clone().unbind()) })
    }
}

/// What a CUDA array interface says.
struct Interface {
    shape: Vec<usize>,
    typestr: String,
    address: u64,
    is_read_only: bool,
    strides: Option<Vec<isize>>,
    stream: Option<usize>,
}

impl Interface {
    fn new(interface: &Bound<'_, PyDict>) -> PyResult<Self> {
        let entry = |name: &str| {
            let missing = || PyValueError::new_err(format!("__cuda_array_interface__ has no {name:?}"));
            interface.get_item(name)?.ok_or_else(missing)
        };
        let optional = |name: &str| Ok::<_, PyErr>(interface.get_item(name)?.filter(|value| !value.is_none()));
        let (address, is_read_only) = entry("data")?.extract()?;
        Ok(Interface {
            shape: entry("shape")?.extract()?,
            typestr: entry("typestr")?.extract()?,
            address,
            is_read_only,
            strides: optional("strides")?.map(|strides| strides.extract()).transpose()?,
            stream: optional("stream")?.map(|stream| stream.extract()).transpose()?,
        })
    }

    /// Returns whether the elements, of so many bytes, follow each other.
    fn is_compact(&self, bytes: isize) -> bool {
        let Some(strides) = &self.strides else { return true };
        let mut expected = bytes;
        let fits = |(&size, &stride): (&usize, &isize)| {
            let is_next = size <= 1 || stride == expected;
            expected = expected.saturating_mul(size as isize);
            is_next
        };
        strides.len() == self.shape.len() && self.shape.iter().zip(strides).rev().all(fits)
    }
}

fn shape_of(shape: &[usize]) -> PyResult<[usize; 2]> {
    match *shape {
        [rows, columns @ (2 | 3)] => Ok([rows, columns]),
        _ => Err(PyValueError::new_err(format!("points must have the shape (n, 2) or (n, 3), not {shape:?}"))),
    }
}

fn wrong_type() -> PyErr {
    PyTypeError::new_err("points must be float32 or float64")
}

fn not_contiguous() -> PyErr {
    PyValueError::new_err("points must be contiguous, one row after the other")
}

impl MeshArray {
    /// Returns the shape: one number for a list.
    pub fn shape(&self) -> Vec<usize> {
        shape(self.rows(), self.columns())
    }

    /// Copies the array into one of the caller's, of the same shape and of `int32`, as work of a stream of CUDA; 0 is the
    /// default one. Waits until it is there.
    ///
    /// # Errors
    ///
    /// Returns a `TypeError` or a `ValueError` for arrays that do not fit, and a `RuntimeError` where copying fails.
    pub fn copy_into(&self, to: &Bound<'_, PyAny>, stream: usize) -> PyResult<()> {
        let interface = Interface::new(&to.getattr(intern!(to.py(), "__cuda_array_interface__"))?.cast_into()?)?;
        if interface.typestr != "<i4" || interface.is_read_only || !interface.is_compact(4) {
            return Err(PyTypeError::new_err("the array must be of int32, contiguous, and writable"));
        }
        if interface.shape != self.shape() {
            let (given, own) = (interface.shape, self.shape());
            return Err(PyValueError::new_err(format!("the array has the shape {given:?}, not {own:?}")));
        }
        // SAFETY: the object has so much memory, and the caller names the stream that knows of it.
        let copied = to.py().detach(|| unsafe { self.copy_to(interface.address, stream as CUstream) });
        copied.map_err(|error| PyRuntimeError::new_err(error.to_string()))
    }
}

fn shape(rows: usize, columns: usize) -> Vec<usize> {
    if columns == 1 { vec![rows] } else { vec![rows, columns] }
}

impl CudaArray {
    /// Returns the shape: one number for a list.
    pub fn shape(&self) -> Vec<usize> {
        shape(self.rows(), self.columns())
    }

    /// Returns the entry `__cuda_array_interface__`.
    ///
    /// # Errors
    ///
    /// Returns Python's errors.
    pub fn interface<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", "<i4")?;
        interface.set_item("data", (self.address(), false))?;
        interface.set_item("shape", PyTuple::new(py, self.shape())?)?;
        // Everything that writes it has ended.
        interface.set_item("stream", py.None())?;
        Ok(interface)
    }

    /// Returns what `__dlpack_device__` does: the kind of device and its number.
    pub fn dlpack_device(&self) -> (u32, i32) {
        let device = self.device();
        (device.device_type.0, device.device_id)
    }

    /// Returns what `__dlpack__` does with these arguments.
    ///
    /// # Errors
    ///
    /// Returns a `BufferError` or a `ValueError` for requests that would take a copy, and for an unknown version.
    pub fn dlpack<'py>(
        &self,
        py: Python<'py>,
        stream: Option<&Bound<'py, PyAny>>,
        max_version: Option<(u32, u32)>,
        device: Option<(u32, i32)>,
        copy: Option<bool>,
    ) -> PyResult<Py<PyAny>> {
        export_dlpack(self, py, ExportRequest::parse(stream, max_version, device, copy)?)
    }

    fn managed<M: ManagedTensorBase>(&self) -> PyResult<Managed<M>> {
        let (rows, columns) = (self.rows() as i64, self.columns() as i64);
        let prepared = match columns {
            1 => Dynamic::new(&[rows], &[1]).prepare_as::<M>(),
            _ => Dynamic::new(&[rows, columns], &[columns, 1]).prepare_as::<M>(),
        };
        let prepared = prepared.map_err(|error| PyValueError::new_err(error.to_string()))?;
        let mut tensor = prepared.initialize(Box::new(self.clone()));
        tensor.set_device(self.device());
        tensor.set_dtype(i32::DTYPE);
        tensor.set_data(self.address() as *mut c_void);
        // SAFETY: the clone keeps the memory, which has this shape.
        Ok(unsafe { tensor.finish() })
    }
}

impl DlpackExporter for CudaArray {
    fn device(&self) -> DLDevice {
        DLDevice::cuda(self.ordinal() as i32)
    }

    fn flags(&self) -> DlpackFlags {
        DlpackFlags::empty()
    }

    /// Everything that writes the array has ended.
    fn prepare_export(&self, _: Python<'_>, _: &ExportRequest<'_>) -> PyResult<()> {
        Ok(())
    }

    fn export_legacy(&self, _: Python<'_>) -> PyResult<Managed<DLManagedTensor>> {
        self.managed()
    }

    fn export_versioned(&self, _: Python<'_>) -> PyResult<Managed<DLManagedTensorVersioned>> {
        self.managed()
    }
}
