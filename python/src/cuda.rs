//! Meshes of tensors in CUDA memory.

use crate::{
    arrays,
    compute::{self, Options, Reporting},
    errors::exception,
};
use gdel::{Error, Progress};
use gdel_cuda::{CudaTriangulator, Tensor};
use pyo3::{
    exceptions::PyValueError,
    prelude::*,
    types::{PyDict, PyTuple},
};
use std::{
    ops::ControlFlow,
    sync::{Mutex, PoisonError, RwLock},
};

/// The GPUs that were opened, by their numbers.
static OPENED: Mutex<Vec<(usize, CudaTriangulator)>> = Mutex::new(Vec::new());

/// Returns the triangulator of the GPU of this number.
fn on(py: Python<'_>, ordinal: usize) -> PyResult<CudaTriangulator> {
    compute::note_gpu(py)?;
    py.detach(|| {
        let mut opened = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, triangulator)) = opened.iter().find(|(number, _)| *number == ordinal) {
            return Ok(triangulator.clone());
        }
        let triangulator = CudaTriangulator::new(ordinal)?;
        opened.push((ordinal, triangulator.clone()));
        Ok(triangulator)
    })
    .map_err(exception)
}

impl Reporting for CudaTriangulator {
    fn reporting_to(self, on_progress: impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static) -> Self {
        self.on_progress(on_progress)
    }
}

/// A mesh of either dimension.
enum Either {
    Two(gdel_cuda::CudaMesh<2>),
    Three(gdel_cuda::CudaMesh<3>),
}

/// Calls a method of the mesh of either dimension, with the lock released.
macro_rules! in_dimension {
    ($self:ident, $py:ident, $method:ident) => {
        $py.detach(|| match &*$self.either.read().unwrap_or_else(PoisonError::into_inner) {
            Either::Two(mesh) => mesh.$method(),
            Either::Three(mesh) => mesh.$method(),
        })
    };
}

/// A mesh in CUDA memory.
#[pyclass(frozen, module = "gdel._gdel")]
pub(crate) struct CudaMesh {
    either: RwLock<Either>,
    ordinal: usize,
    columns: usize,
}

/// Triangulates a tensor.
#[pyfunction]
#[pyo3(signature = (points, backend, progress))]
pub(crate) fn triangulate_cuda(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    backend: &str,
    progress: Option<Py<PyAny>>,
) -> PyResult<CudaMesh> {
    let options = Options::new(backend, None, progress)?;
    let points = Tensor::from_python(points)?;
    let (ordinal, columns) = (points.ordinal(), points.columns());
    let triangulator = on(py, ordinal)?.backend(options.backend);
    let work = |by: &CudaTriangulator| match columns {
        2 => by.delaunay2d(&points).map(Either::Two),
        _ => by.delaunay3d(&points).map(Either::Three),
    };
    let either = compute::triangulate_by(py, &options, triangulator, points.rows(), work)?;
    Ok(CudaMesh { either: RwLock::new(either), ordinal, columns })
}

#[pymethods]
impl CudaMesh {
    /// Updates the mesh to points that have moved.
    #[pyo3(signature = (points, backend, progress))]
    fn update(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        backend: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let options = Options::new(backend, None, progress)?;
        let points = Tensor::from_python(points)?;
        if points.columns() != self.columns {
            let (columns, own) = (points.columns(), self.columns);
            return Err(PyValueError::new_err(format!("there are {columns} coordinates per point, not {own}")));
        }
        if points.ordinal() != self.ordinal {
            let (ordinal, own) = (points.ordinal(), self.ordinal);
            return Err(PyValueError::new_err(format!("the points are on GPU {ordinal}, the mesh is on GPU {own}")));
        }
        let triangulator = on(py, self.ordinal)?.backend(options.backend);
        let work = |by: &CudaTriangulator| match &mut *self.either.write().unwrap_or_else(PoisonError::into_inner) {
            Either::Two(mesh) => by.update2d(mesh, &points),
            Either::Three(mesh) => by.update3d(mesh, &points),
        };
        compute::triangulate_by(py, &options, triangulator, points.rows(), work)
    }

    /// The vertices of each simplex.
    fn simplices(&self, py: Python<'_>) -> MeshArray {
        MeshArray(in_dimension!(self, py, simplices))
    }

    /// The neighbours of each simplex, in 2D half-edges.
    fn neighbors(&self, py: Python<'_>) -> MeshArray {
        MeshArray(in_dimension!(self, py, neighbors))
    }

    /// The facets of the hull, in 2D its vertices.
    fn hull(&self, py: Python<'_>) -> MeshArray {
        MeshArray(in_dimension!(self, py, hull))
    }

    /// The lowest simplex of each point, or −1.
    fn vertex_simplex(&self, py: Python<'_>) -> MeshArray {
        MeshArray(in_dimension!(self, py, vertex_simplex))
    }

    /// Where the neighbours of each vertex start, and the neighbours.
    fn adjacency(&self, py: Python<'_>) -> PyResult<(MeshArray, MeshArray)> {
        let [offsets, neighbors] = in_dimension!(self, py, adjacency).map_err(exception)?;
        Ok((MeshArray(offsets), MeshArray(neighbors)))
    }

    /// For each simplex the one with the same vertices before the last update, or −1.
    fn survivors(&self, py: Python<'_>) -> PyResult<Option<MeshArray>> {
        Ok(in_dimension!(self, py, survivors).map_err(exception)?.map(MeshArray))
    }

    /// For each point the one that stands for it, or −1.
    fn duplicate_of<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<i32>> {
        arrays::list(py, self.with(|mesh| mesh.duplicate_of().to_vec(), |mesh| mesh.duplicate_of().to_vec()))
    }

    /// The affine dimension of the points.
    fn dimension(&self) -> u8 {
        self.with(gdel_cuda::CudaMesh::dimension, gdel_cuda::CudaMesh::dimension)
    }

    /// The number of points.
    fn point_count(&self) -> usize {
        self.with(gdel_cuda::CudaMesh::point_count, gdel_cuda::CudaMesh::point_count)
    }

    /// The number of coordinates.
    fn columns(&self) -> usize {
        self.columns
    }

    /// The number of simplices.
    fn simplex_count(&self) -> usize {
        self.with(gdel_cuda::CudaMesh::simplex_count, gdel_cuda::CudaMesh::simplex_count)
    }

    /// What the run says about itself, as JSON.
    fn stats(&self) -> PyResult<String> {
        let json = self.with(|mesh| serde_json::to_string(mesh.stats()), |mesh| serde_json::to_string(mesh.stats()));
        json.map_err(|error| exception(Error::Gpu { reason: error.to_string() }))
    }
}

impl CudaMesh {
    fn with<R>(
        &self,
        two: impl FnOnce(&gdel_cuda::CudaMesh<2>) -> R,
        three: impl FnOnce(&gdel_cuda::CudaMesh<3>) -> R,
    ) -> R {
        match &*self.either.read().unwrap_or_else(PoisonError::into_inner) {
            Either::Two(mesh) => two(mesh),
            Either::Three(mesh) => three(mesh),
        }
    }
}

/// An array of a mesh, which CUDA does not see.
#[pyclass(frozen, module = "gdel._gdel")]
pub(crate) struct MeshArray(gdel_cuda::MeshArray);

#[pymethods]
impl MeshArray {
    /// The shape.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.0.shape())
    }

    /// The array in CUDA memory of its own.
    fn to_cuda(&self, py: Python<'_>) -> PyResult<CudaArray> {
        py.detach(|| self.0.to_cuda()).map(CudaArray).map_err(exception)
    }

    /// Copies the array into one of the caller's, as work of a stream.
    #[pyo3(signature = (array, stream))]
    fn copy_into(&self, array: &Bound<'_, PyAny>, stream: usize) -> PyResult<()> {
        self.0.copy_into(array, stream)
    }
}

/// An array in CUDA memory.
#[pyclass(frozen, module = "gdel._gdel")]
pub(crate) struct CudaArray(gdel_cuda::CudaArray);

#[pymethods]
impl CudaArray {
    /// The shape.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.0.shape())
    }

    #[getter]
    fn __cuda_array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.0.interface(py)
    }

    fn __dlpack_device__(&self) -> (u32, i32) {
        self.0.dlpack_device()
    }

    #[pyo3(signature = (*, stream=None, max_version=None, dl_device=None, copy=None))]
    fn __dlpack__<'py>(
        &self,
        py: Python<'py>,
        stream: Option<Bound<'py, PyAny>>,
        max_version: Option<(u32, u32)>,
        dl_device: Option<(u32, i32)>,
        copy: Option<bool>,
    ) -> PyResult<Py<PyAny>> {
        self.0.dlpack(py, stream.as_ref(), max_version, dl_device, copy)
    }
}
