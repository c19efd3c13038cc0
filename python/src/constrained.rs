//! Points with constraints in 2D.

use crate::{
    arrays::{self, Input},
    compute::{self, Options},
    mesh::Mesh,
};
use gdel::{Constrained2, Constraints, Fill, Mesh2, RefineOptions, Refined2, Size, Tin, TinOptions};
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::{exceptions::PyValueError, prelude::*, types::PyDict};

/// Constraints of the caller.
#[derive(FromPyObject)]
pub(crate) struct Given<'py> {
    edges: PyReadonlyArray2<'py, u32>,
    boundary: PyReadonlyArray2<'py, u32>,
    holes: PyReadonlyArray2<'py, f64>,
    fill: String,
    is_split: bool,
}

impl Given<'_> {
    fn constraints(&self) -> PyResult<Constraints> {
        let fill = match self.fill.as_str() {
            "all" => Fill::All,
            "evenodd" => Fill::EvenOdd,
            "nonzero" => Fill::NonZero,
            "enclosed" => Fill::Enclosed,
            fill => {
                let what = format!("fill must be 'all', 'evenodd', 'nonzero' or 'enclosed', not {fill:?}");
                return Err(PyValueError::new_err(what));
            }
        };
        let edges = self.edges.as_slice()?.as_chunks().0;
        let constraints = Constraints::new().edges(edges).boundary(self.boundary.as_slice()?.as_chunks().0).fill(fill);
        let constraints = if self.is_split { constraints.split_crossings() } else { constraints };
        Ok(self.holes.as_slice()?.as_chunks().0.iter().fold(constraints, |all, &hole| all.hole(hole)))
    }
}

/// Triangulates points with segments, and returns what became of these.
#[pyfunction]
#[pyo3(signature = (points, given, backend, threads, progress))]
pub(crate) fn constrain<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    given: Given<'py>,
    backend: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Mesh, Bound<'py, PyDict>)> {
    let options = Options::new(backend, threads, progress)?;
    let constraints = given.constraints()?;
    let input = Input::new(points)?;
    let points = input.points()?;
    let (found, regions) = compute::triangulate(py, &options, points.len(), |by| {
        let found = by.constrained2d(points, &constraints)?;
        let regions = found.triangle_regions();
        Ok((found, regions))
    })?;
    dict(py, found, regions, threads)
}

/// Makes terrain of points, and returns it with its triangulation as seen from above.
#[pyfunction]
#[pyo3(signature = (points, given, max_error, max_points, threads, progress))]
pub(crate) fn tin<'py>(
    py: Python<'py>,
    points: &Bound<'py, PyAny>,
    given: Given<'py>,
    max_error: f64,
    max_points: Option<usize>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Mesh, Bound<'py, PyDict>)> {
    let options = Options::new("cpu", threads, progress)?;
    let constraints = given.constraints()?;
    let input = Input::new(points)?;
    let points = input.points()?;
    let mut reached = TinOptions::default();
    (reached.max_error, reached.max_points) = (max_error, max_points);
    let (tin, regions) = compute::triangulate(py, &options, points.len(), |by| {
        let tin = by.tin(points, &constraints, &reached)?;
        let regions = tin.constrained.triangle_regions();
        Ok((tin, regions))
    })?;
    let Tin { constrained, vertices, sources, max_error, stats, .. } = tin;
    let (mesh, result) = dict(py, constrained, regions, threads)?;
    result.set_item("vertices", arrays::rows(py, vertices)?)?;
    result.set_item("sources", arrays::list(py, sources))?;
    result.set_item("max_error", max_error)?;
    let counts = PyDict::new(py);
    counts.set_item("start", stats.start)?;
    counts.set_item("duplicates", stats.duplicates)?;
    counts.set_item("other_heights", stats.other_heights)?;
    counts.set_item("outside", stats.outside)?;
    counts.set_item("limited", stats.limited)?;
    result.set_item("stats", counts)?;
    Ok((mesh, result))
}

/// Returns the mesh, and what became of segments as the package takes it.
fn dict(
    py: Python<'_>,
    found: Constrained2,
    regions: Vec<u32>,
    threads: Option<usize>,
) -> PyResult<(Mesh, Bound<'_, PyDict>)> {
    let result = PyDict::new(py);
    result.set_item("inside", found.inside.into_pyarray(py))?;
    result.set_item("regions", arrays::list(py, regions))?;
    result.set_item("segments", arrays::index_rows(py, found.segments)?)?;
    result.set_item("added", arrays::rows(py, found.added)?)?;
    result.set_item("zero_length", found.zero_length)?;
    result.set_item("moved", found.moved)?;
    Ok((Mesh::two(found.mesh, threads), result))
}

/// To what a mesh is refined: one size, or one for each point, or none.
#[derive(FromPyObject)]
pub(crate) struct RefineArguments<'py> {
    min_angle: f64,
    max_area: Option<f64>,
    size: Option<f64>,
    sizes: Option<PyReadonlyArray1<'py, f64>>,
    max_points: Option<usize>,
}

/// Refines a mesh of these points with constraints.
pub(crate) fn refine<'py>(
    py: Python<'py>,
    mesh: &Mesh2,
    points: &Input<'py>,
    inside: PyReadonlyArray1<'py, bool>,
    segments: PyReadonlyArray2<'py, i32>,
    arguments: RefineArguments<'py>,
    threads: Option<usize>,
) -> PyResult<(Mesh, Bound<'py, PyDict>)> {
    let RefineArguments { min_angle, max_area, size, sizes, max_points } = arguments;
    let points = points.points()?;
    let mut found = Constrained2::default();
    found.mesh = mesh.clone();
    found.inside = inside.as_slice()?.to_vec();
    found.segments = bytemuck::cast_slice::<i32, u32>(segments.as_slice()?).as_chunks().0.to_vec();
    let mut options = RefineOptions::default();
    (options.min_angle, options.max_area, options.max_points) = (min_angle, max_area, max_points);
    options.size = match (size, &sizes) {
        (_, Some(sizes)) => Size::PerPoint(sizes.as_slice()?),
        (Some(size), None) => Size::Uniform(size),
        (None, None) => Size::Any,
    };
    let (refined, regions) = compute::run(py, threads, || {
        let refined = found.refine(points, &options)?;
        let regions = refined.constrained.triangle_regions();
        Ok((refined, regions))
    })?;
    let Refined2 { constrained: found, segment_of, stats, .. } = refined;
    let (mesh, result) = dict(py, found, regions, threads)?;
    result.set_item("segment_of", arrays::list(py, segment_of))?;
    let counts = PyDict::new(py);
    counts.set_item("points_on_segments", stats.points_on_segments)?;
    counts.set_item("points_inside", stats.points_inside)?;
    counts.set_item("min_angle", stats.min_angle)?;
    counts.set_item("at_input_angles", stats.left.input_angle)?;
    counts.set_item("too_fine", stats.left.resolution)?;
    counts.set_item("beyond_limit", stats.left.limit)?;
    counts.set_item("too_large", stats.left.too_large)?;
    counts.set_item("limited", stats.limited)?;
    result.set_item("refinement", counts)?;
    Ok((mesh, result))
}
