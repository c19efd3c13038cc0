//! Weights with which cells have given volumes.

use crate::{
    arrays::Input,
    compute::{self, Options},
    core::Core,
    voronoi::Shape,
};
use gdel::{Mesh2, Mesh3, Transport, TransportOptions};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::{prelude::*, types::PyDict};

/// As many triangulations as it takes to find the weights, about.
const TRIANGULATIONS: usize = 10;

/// The masses of the points, whether they are only compared with each other, and the tolerance.
type Wanted<'py> = (Option<PyReadonlyArray1<'py, f64>>, bool, f64);

/// Returns the weights, and the volumes of the cells.
#[pyfunction]
#[pyo3(signature = (points, clip, wanted, threads, progress))]
pub(crate) fn transport<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    clip: &Bound<'py, PyAny>,
    wanted: Wanted<'py>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let run = Options::new("cpu", threads, progress)?;
    let input = Input::new(points)?;
    let (masses, normalize, tolerance) = &wanted;
    let mut options = TransportOptions::default();
    options.masses = masses.as_ref().map(|masses| masses.as_slice()).transpose()?;
    (options.normalize, options.tolerance) = (*normalize, *tolerance);
    let found = if input.dimension() == 2 {
        transported::<Mesh2, 2, 3>(py, &input, clip, &options, &run)?
    } else {
        transported::<Mesh3, 3, 4>(py, &input, clip, &options, &run)?
    };
    let result = PyDict::new(py);
    result.set_item("weights", found.weights.into_pyarray(py))?;
    result.set_item("volumes", found.volumes.into_pyarray(py))?;
    result.set_item("error", found.error)?;
    result.set_item("steps", found.steps)?;
    Ok(result)
}

fn transported<M: Core<D, N>, const D: usize, const N: usize>(
    py: Python<'_>,
    input: &Input<'_>,
    clip: &Bound<'_, PyAny>,
    options: &TransportOptions<'_>,
    run: &Options,
) -> PyResult<Transport> {
    let points = input.points::<D>()?;
    let shape = Shape::new(clip)?;
    let clip = shape.clip(points);
    let work = points.len().saturating_mul(TRIANGULATIONS);
    compute::triangulate(py, run, work, |by| M::transport(by, points, clip, options))
}
