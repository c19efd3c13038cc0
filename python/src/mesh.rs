//! Meshes.

use crate::{
    arrays::{self, Input, PyCsr},
    compute::{self, Options},
    constrained,
    core::{Arrays, Core, Data, Derives},
    derived,
    errors::exception,
    queries::{self, Method, Values},
    tree::Tree,
    voronoi,
};
use gdel::{Error, Mesh2, Mesh3, Points, Triangulator, internals::geometry::Euclidean};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::{exceptions::PyValueError, prelude::*, types::PyDict};

/// Values, their gradients, and which simplices count.
type ValuesArgument<'py> =
    (PyReadonlyArray1<'py, f64>, Option<PyReadonlyArray2<'py, f64>>, Option<PyReadonlyArray1<'py, bool>>);

/// A mesh of either dimension, which does not change any more.
pub(crate) enum Either {
    Two(Data<Mesh2, 2, 3>),
    Three(Data<Mesh3, 3, 4>),
}

/// Calls a function with the mesh of a dimension.
macro_rules! in_dimension {
    ($mesh:expr, $($path:ident)::+($($argument:expr),*)) => {
        match &$mesh.either {
            Either::Two(data) => $($path)::+::<Mesh2, 2, 3>(data, $($argument),*),
            Either::Three(data) => $($path)::+::<Mesh3, 3, 4>(data, $($argument),*),
        }
    };
}

/// A triangulation without its points, which each method takes.
#[pyclass(frozen, module = "gdel._gdel")]
pub(crate) struct Mesh {
    either: Either,
    /// The number of threads for what is derived; that of the process by default.
    threads: Option<usize>,
}

impl Mesh {
    pub(crate) fn two(mesh: Mesh2, threads: Option<usize>) -> Self {
        Mesh { either: Either::Two(Data::new(mesh)), threads }
    }

    fn three(mesh: Mesh3, threads: Option<usize>) -> Self {
        Mesh { either: Either::Three(Data::new(mesh)), threads }
    }
}

/// Triangulates points, which may have weights.
#[pyfunction]
#[pyo3(signature = (points, weights, backend, threads, progress))]
pub(crate) fn triangulate(
    py: Python<'_>,
    points: &Bound<'_, PyAny>,
    weights: Option<PyReadonlyArray1<'_, f64>>,
    backend: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Mesh> {
    let options = Options::new(backend, threads, progress)?;
    let input = Input::new(points)?;
    let weights = weights.as_ref().map(|weights| weights.as_slice()).transpose()?;
    if input.dimension() == 2 {
        Ok(Mesh::two(triangulated(py, &input, weights, &options)?, threads))
    } else {
        Ok(Mesh::three(triangulated(py, &input, weights, &options)?, threads))
    }
}

fn triangulated<M: Core<D, N>, const D: usize, const N: usize>(
    py: Python<'_>,
    input: &Input<'_>,
    weights: Option<&[f64]>,
    options: &Options,
) -> PyResult<M> {
    let points = input.points::<D>()?;
    compute::triangulate(py, options, points.len(), |by| match weights {
        Some(weights) => M::regular(by, points, weights),
        None => M::triangulate(by, points),
    })
}

/// The arrays of a mesh and its dimension, as they are pickled.
type State<'py> = (Vec<Bound<'py, PyAny>>, u8);

/// What `state` has returned: simplices, links, the hull, duplicates, constraints, hidden points and weights.
type Stored<'py> = (
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray2<'py, i32>,
    PyReadonlyArray1<'py, i32>,
    PyReadonlyArray1<'py, f64>,
);

/// Returns the mesh of arrays that `state` has returned.
#[pyfunction]
#[pyo3(signature = (arrays, dimension, threads))]
pub(crate) fn restore(arrays: Stored<'_>, dimension: u8, threads: Option<usize>) -> PyResult<Mesh> {
    fn words(slice: &[i32]) -> &[u32] {
        bytemuck::cast_slice(slice)
    }
    fn parts<const N: usize>(
        [simplices, links, hull, duplicate_of, constraints, hidden]: [&[i32]; 6],
        weights: &[f64],
        dimension: u8,
    ) -> Arrays<N> {
        Arrays {
            simplices: words(simplices).as_chunks().0.to_vec(),
            links: words(links).as_chunks().0.to_vec(),
            hull: words(hull).to_vec(),
            duplicate_of: words(duplicate_of).to_vec(),
            constraints: words(constraints).as_chunks().0.to_vec(),
            weights: weights.to_vec(),
            hidden: words(hidden).to_vec(),
            dimension,
        }
    }
    let corners = arrays.0.shape()[1];
    let (simplices, links, hull, duplicate_of, constraints, hidden, weights) = &arrays;
    let slices = [
        simplices.as_slice()?,
        links.as_slice()?,
        hull.as_slice()?,
        duplicate_of.as_slice()?,
        constraints.as_slice()?,
        hidden.as_slice()?,
    ];
    let weights = weights.as_slice()?;
    match corners {
        3 => Ok(Mesh::two(Mesh2::from_arrays(parts(slices, weights, dimension)), threads)),
        4 => Ok(Mesh::three(Mesh3::from_arrays(parts(slices, weights, dimension)), threads)),
        _ => Err(PyValueError::new_err("the arrays are not those of a mesh")),
    }
}

#[pymethods]
impl Mesh {
    /// The affine dimension of the points.
    #[getter]
    fn dimension(&self) -> u8 {
        match &self.either {
            Either::Two(data) => data.mesh.dimension,
            Either::Three(data) => data.mesh.dimension,
        }
    }

    /// The vertices of each simplex.
    #[getter]
    fn simplices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        in_dimension!(self, simplices(py))
    }

    /// The simplices opposite the vertices of each simplex.
    #[getter]
    fn neighbors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        in_dimension!(self, neighbors(py))
    }

    /// The facets of the hull.
    #[getter]
    fn hull<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        in_dimension!(self, hull(py))
    }

    /// For each point the one that stands for it, or −1.
    #[getter]
    fn duplicate_of<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.either {
            Either::Two(data) => arrays::view(py, data.mesh.clone(), &data.mesh.duplicate_of, None),
            Either::Three(data) => arrays::view(py, data.mesh.clone(), &data.mesh.duplicate_of, None),
        }
    }

    /// The constrained edges; none in 3D.
    #[getter]
    fn constraints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.either {
            Either::Two(data) => arrays::view(py, data.mesh.clone(), data.mesh.constraints.as_flattened(), Some(2)),
            Either::Three(data) => arrays::view(py, data.mesh.clone(), &[], Some(2)),
        }
    }

    /// The points that are no vertices because of their weights.
    #[getter]
    fn hidden<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.either {
            Either::Two(data) => arrays::view(py, data.mesh.clone(), &data.mesh.hidden, None),
            Either::Three(data) => arrays::view(py, data.mesh.clone(), &data.mesh.hidden, None),
        }
    }

    /// The weights of the points; none for a Delaunay triangulation.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        match &self.either {
            Either::Two(data) => PyArray1::from_slice(py, &data.mesh.weights),
            Either::Three(data) => PyArray1::from_slice(py, &data.mesh.weights),
        }
    }

    /// A simplex of each vertex, or −1.
    fn vertex_simplex<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<i32>>> {
        let found = compute::run(py, self.threads, || {
            Ok(match &self.either {
                Either::Two(data) => data.mesh.vertex_triangle(),
                Either::Three(data) => data.mesh.vertex_tetrahedron(),
            })
        })?;
        Ok(arrays::list(py, found))
    }

    /// The neighbours of each vertex.
    fn vertex_neighbors<'py>(&self, py: Python<'py>) -> PyResult<PyCsr<'py>> {
        let found = compute::run(py, self.threads, || {
            Ok(match &self.either {
                Either::Two(data) => data.mesh.vertex_neighbors(),
                Either::Three(data) => data.mesh.vertex_neighbors(),
            })
        })?;
        Ok(arrays::csr(py, found))
    }

    /// The edges.
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let found = compute::run(py, self.threads, || {
            Ok(match &self.either {
                Either::Two(data) => data.mesh.edges().collect(),
                Either::Three(data) => data.mesh.edges().collect::<Vec<_>>(),
            })
        })?;
        Ok(arrays::index_rows(py, found)?.into_any())
    }

    /// Circumcentres, circumradii, volumes and ratios of radii.
    fn shapes<'py>(&self, py: Python<'py>, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        in_dimension!(self, derived::shapes(py, &Input::new(points)?, self.threads))
    }

    /// The statistics of the run as JSON.
    fn stats(&self) -> PyResult<String> {
        let stats = match &self.either {
            Either::Two(data) => &data.mesh.stats,
            Either::Three(data) => &data.mesh.stats,
        };
        serde_json::to_string(stats).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// What `restore` takes.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<State<'py>> {
        in_dimension!(self, state(py))
    }

    /// The simplex that contains each query, or −1.
    fn locate<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        queries: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<i32>>> {
        in_dimension!(self, queries::locate(py, &Input::new(points)?, &Input::new(queries)?, self.threads))
    }

    /// The vertex nearest to each query, or −1.
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        queries: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<i32>>> {
        in_dimension!(self, queries::nearest(py, &Input::new(points)?, &Input::new(queries)?, self.threads))
    }

    /// The `k` vertices nearest to each query.
    fn nearest_k<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        queries: &Bound<'py, PyAny>,
        k: usize,
    ) -> PyResult<PyCsr<'py>> {
        in_dimension!(self, queries::nearest_k(py, &Input::new(points)?, &Input::new(queries)?, k, self.threads))
    }

    /// The gradient of the values at each point.
    fn gradients<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        values: PyReadonlyArray1<'py, f64>,
        duplicates: &str,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let input = Input::new(points)?;
        in_dimension!(self, queries::gradients(py, &input, values.as_slice()?, duplicates, self.threads))
    }

    /// The interpolated value at each query. With the values come their gradients, if these are known, and which simplices
    /// count, if not all do.
    #[pyo3(signature = (points, values, queries, method))]
    fn interpolate<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        values: ValuesArgument<'py>,
        queries: &Bound<'py, PyAny>,
        method: (String, String, f64, String),
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (input, queries) = (Input::new(points)?, Input::new(queries)?);
        let (interpolation, outside, fill, duplicates) = method;
        let method = Method::new(&interpolation, &outside, fill, &duplicates)?;
        let (values, gradients, inside) = values;
        let gradients = gradients.as_ref().map(|gradients| gradients.as_slice()).transpose()?;
        let inside = inside.as_ref().map(|inside| inside.as_slice()).transpose()?;
        let values = Values { values: values.as_slice()?, gradients, inside };
        in_dimension!(self, queries::interpolate(py, &input, values, &queries, &method, self.threads))
    }

    /// The Voronoi diagram, clipped to nothing, "hull" or a box.
    #[pyo3(signature = (points, clip))]
    fn voronoi<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        clip: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyDict>> {
        in_dimension!(self, voronoi::diagram(py, &Input::new(points)?, clip, self.threads))
    }

    /// Ridges and regions as SciPy has them.
    fn voronoi_ridges<'py>(&self, py: Python<'py>, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        in_dimension!(self, voronoi::ridges(py, &Input::new(points)?, self.threads))
    }

    /// The alpha shape of a radius, or of the smallest one for so many components.
    #[pyo3(signature = (points, alpha, components))]
    fn alpha_shape<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        alpha: Option<f64>,
        components: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        in_dimension!(self, derived::alpha_shape(py, &Input::new(points)?, alpha, components, self.threads))
    }

    /// The alpha complex of balls, whose weights are `weight` if the mesh has none.
    #[pyo3(signature = (points, alpha, weight))]
    fn ball_complex<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        alpha: f64,
        weight: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        in_dimension!(self, derived::ball_complex(py, &Input::new(points)?, alpha, weight, self.threads))
    }

    /// The surface, with the options as a dictionary.
    fn surface<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        options: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        in_dimension!(self, derived::surface(py, &Input::new(points)?, options, self.threads))
    }

    /// The minimum spanning tree.
    fn spanning_tree(&self, py: Python<'_>, points: &Bound<'_, PyAny>) -> PyResult<Tree> {
        in_dimension!(self, derived::spanning_tree(py, &Input::new(points)?, self.threads))
    }

    /// What an exact check of the mesh has found.
    fn verify<'py>(&self, py: Python<'py>, points: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        in_dimension!(self, derived::verify(py, &Input::new(points)?, self.threads))
    }

    /// What an exact check of a 2D mesh has found, whose constraints are to be those of these segments.
    fn verify_constrained<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        segments: PyReadonlyArray2<'py, i32>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let input = Input::new(points)?;
        let segments: &[u32] = bytemuck::cast_slice(segments.as_slice()?);
        match &self.either {
            Either::Two(data) => derived::verify_constrained(data, py, &input, segments.as_chunks().0, self.threads),
            Either::Three(_) => Err(PyValueError::new_err("there are no constraints in 3D")),
        }
    }

    /// The mesh with points added until the triangles inside are as asked for, and what became of segments.
    fn refine<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        inside: PyReadonlyArray1<'py, bool>,
        segments: PyReadonlyArray2<'py, i32>,
        options: constrained::RefineArguments<'py>,
    ) -> PyResult<(Mesh, Bound<'py, PyDict>)> {
        let input = Input::new(points)?;
        match &self.either {
            Either::Two(data) => constrained::refine(py, &data.mesh, &input, inside, segments, options, self.threads),
            Either::Three(_) => Err(PyValueError::new_err("there are no constraints in 3D")),
        }
    }

    /// The mesh of the same points after they have moved.
    #[pyo3(signature = (points, backend, progress))]
    fn update(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        backend: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Mesh> {
        let (input, options) = (Input::new(points)?, Options::new(backend, self.threads, progress)?);
        let either = match &self.either {
            Either::Two(data) => Either::Two(updated(data, py, &input, &options)?),
            Either::Three(data) => Either::Three(updated(data, py, &input, &options)?),
        };
        Ok(Mesh { either, threads: self.threads })
    }

    /// The mesh of the same points with these weights.
    #[pyo3(signature = (points, weights, backend, progress))]
    fn update_weights(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        weights: PyReadonlyArray1<'_, f64>,
        backend: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Mesh> {
        let (input, options) = (Input::new(points)?, Options::new(backend, self.threads, progress)?);
        let weights = weights.as_slice()?;
        let either = match &self.either {
            Either::Two(data) => Either::Two(changed(data, py, &input, &options, |by, mesh, points| {
                by.update_weights(mesh, points, weights)
            })?),
            Either::Three(data) => Either::Three(changed(data, py, &input, &options, |by, mesh, points| {
                by.update_weights(mesh, points, weights)
            })?),
        };
        Ok(Mesh { either, threads: self.threads })
    }

    /// The mesh with these points as well, and all points.
    #[pyo3(signature = (points, new, backend, progress))]
    fn insert<'py>(
        &self,
        py: Python<'py>,
        points: &Bound<'py, PyAny>,
        new: &Bound<'py, PyAny>,
        backend: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Mesh, Bound<'py, PyAny>)> {
        let (input, new) = (Input::new(points)?, Input::new(new)?);
        let options = Options::new(backend, self.threads, progress)?;
        let (either, points) = match &self.either {
            Either::Two(data) => {
                let (data, points) = inserted(data, py, &input, &new, &options)?;
                (Either::Two(data), points)
            }
            Either::Three(data) => {
                let (data, points) = inserted(data, py, &input, &new, &options)?;
                (Either::Three(data), points)
            }
        };
        Ok((Mesh { either, threads: self.threads }, points))
    }

    /// The mesh without these points, whose numbers stay unused.
    #[pyo3(signature = (points, indices, backend, progress))]
    fn remove(
        &self,
        py: Python<'_>,
        points: &Bound<'_, PyAny>,
        indices: Vec<u32>,
        backend: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Mesh> {
        let (input, options) = (Input::new(points)?, Options::new(backend, self.threads, progress)?);
        let either = match &self.either {
            Either::Two(data) => {
                Either::Two(changed(data, py, &input, &options, |by, mesh, points| by.remove(mesh, points, &indices))?)
            }
            Either::Three(data) => Either::Three(changed(data, py, &input, &options, |by, mesh, points| {
                by.remove(mesh, points, &indices)
            })?),
        };
        Ok(Mesh { either, threads: self.threads })
    }
}

fn simplices<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    arrays::view(py, data.mesh.clone(), data.mesh.simplices().as_flattened(), Some(N))
}

fn neighbors<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    match data.mesh.opposites() {
        std::borrow::Cow::Borrowed(neighbors) => arrays::view(py, data.mesh.clone(), neighbors.as_flattened(), Some(N)),
        std::borrow::Cow::Owned(neighbors) => Ok(arrays::index_rows(py, neighbors)?.into_any()),
    }
}

fn hull<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    Ok(arrays::index_rows(py, data.mesh.hull_facets())?.into_any())
}

fn state<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
) -> PyResult<State<'py>> {
    let mesh = &data.mesh;
    let view = |words: &[u32], columns| arrays::view(py, mesh.clone(), words, columns);
    let arrays = vec![
        view(mesh.simplices().as_flattened(), Some(N))?,
        view(mesh.links().as_flattened(), Some(N))?,
        view(mesh.hull(), None)?,
        view(mesh.duplicate_of(), None)?,
        view(mesh.constraints().as_flattened(), Some(2))?,
        view(mesh.hidden(), None)?,
        PyArray1::from_slice(py, mesh.weights()).into_any(),
    ];
    Ok((arrays, mesh.dimension()))
}

fn updated<M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'_>,
    input: &Input<'_>,
    options: &Options,
) -> PyResult<Data<M, D, N>> {
    let points = input.points::<D>()?;
    let old = &data.mesh;
    let mesh = compute::triangulate(py, options, points.len(), |by| {
        // An update needs only these of a mesh that is not on a device.
        let mut mesh = M::from_arrays(Arrays {
            simplices: Vec::new(),
            links: Vec::new(),
            hull: Vec::new(),
            duplicate_of: old.duplicate_of().to_vec(),
            constraints: old.constraints().to_vec(),
            weights: old.weights().to_vec(),
            hidden: Vec::new(),
            dimension: old.dimension(),
        });
        by.update(&mut mesh, points)?;
        Ok(mesh)
    })?;
    Ok(Data::new(mesh))
}

fn inserted<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    new: &Input<'_>,
    options: &Options,
) -> PyResult<(Data<M, D, N>, Bound<'py, PyAny>)>
where
    for<'p> Points<'p, D>: From<&'p [[f32; D]]> + From<&'p [[f64; D]]>,
    Euclidean: Derives<D, N>,
{
    let mut mesh = M::clone(&data.mesh);
    match (input.points::<D>()?, new.points::<D>()?) {
        (Points::F32(old), Points::F32(new)) => {
            let mut points = old.to_vec();
            compute::triangulate(py, options, old.len() + new.len(), |by| {
                by.insert(&mut mesh, &mut points, new).map(drop)
            })?;
            Ok((Data::new(mesh), arrays::rows(py, points)?.into_any()))
        }
        (Points::F64(old), Points::F64(new)) => {
            let mut points = old.to_vec();
            compute::triangulate(py, options, old.len() + new.len(), |by| {
                by.insert(&mut mesh, &mut points, new).map(drop)
            })?;
            Ok((Data::new(mesh), arrays::rows(py, points)?.into_any()))
        }
        _ => Err(PyValueError::new_err("the new points are not of the type of the others")),
    }
}

/// Changes a copy of a mesh.
fn changed<M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'_>,
    input: &Input<'_>,
    options: &Options,
    change: impl FnOnce(&Triangulator, &mut M, Points<'_, D>) -> Result<(), Error> + Send,
) -> PyResult<Data<M, D, N>> {
    let points = input.points::<D>()?;
    let mut mesh = M::clone(&data.mesh);
    compute::triangulate(py, options, points.len(), |by| change(by, &mut mesh, points))?;
    Ok(Data::new(mesh))
}

/// Checks that there is a value for each point.
pub(crate) fn check_values(values: usize, points: usize) -> PyResult<()> {
    if values == points { Ok(()) } else { Err(exception(Error::ValueCount { values, points })) }
}
