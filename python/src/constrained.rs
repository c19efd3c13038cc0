//! Points with constraints in 2D.

use crate::{
    arrays::{self, Input},
    compute::{self, Options},
    mesh::Mesh,
};
use gdel::{Constraints, Fill};
use numpy::{IntoPyArray, PyReadonlyArray2};
use pyo3::{exceptions::PyValueError, prelude::*, types::PyDict};

/// Triangulates points with segments, and returns what became of these.
#[pyfunction]
#[pyo3(signature = (points, edges, boundary, holes, fill, is_split, backend, threads, progress))]
#[expect(clippy::too_many_arguments, reason = "the package names all of them")]
pub(crate) fn constrain<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    edges: PyReadonlyArray2<'py, u32>,
    boundary: PyReadonlyArray2<'py, u32>,
    holes: PyReadonlyArray2<'py, f64>,
    fill: &str,
    is_split: bool,
    backend: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Mesh, Bound<'py, PyDict>)> {
    let options = Options::new(backend, threads, progress)?;
    let fill = match fill {
        "all" => Fill::All,
        "evenodd" => Fill::EvenOdd,
        "nonzero" => Fill::NonZero,
        "enclosed" => Fill::Enclosed,
        _ => {
            let what = format!("fill must be 'all', 'evenodd', 'nonzero' or 'enclosed', not {fill:?}");
            return Err(PyValueError::new_err(what));
        }
    };
    let [edges, boundary] = [edges.as_slice()?.as_chunks().0, boundary.as_slice()?.as_chunks().0];
    let constraints = Constraints::new().edges(edges).boundary(boundary).fill(fill);
    let constraints = if is_split { constraints.split_crossings() } else { constraints };
    let constraints = holes.as_slice()?.as_chunks().0.iter().fold(constraints, |all, &hole| all.hole(hole));
    let input = Input::new(points)?;
    let points = input.points()?;
    let (found, regions) = compute::triangulate(py, &options, points.len(), |by| {
        let found = by.constrained2d(points, &constraints)?;
        let regions = found.triangle_regions();
        Ok((found, regions))
    })?;
    let result = PyDict::new(py);
    result.set_item("inside", found.inside.into_pyarray(py))?;
    result.set_item("regions", arrays::list(py, regions))?;
    result.set_item("segments", arrays::index_rows(py, found.segments)?)?;
    result.set_item("zero_length", found.zero_length)?;
    result.set_item("added", arrays::rows(py, found.added)?)?;
    result.set_item("moved", found.moved)?;
    Ok((Mesh::two(found.mesh, threads), result))
}
