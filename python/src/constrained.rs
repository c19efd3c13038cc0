//! Points with constraints in 2D.

use crate::{
    arrays::{self, Input},
    compute::{self, Options},
    mesh::Mesh,
};
use gdel::{Constrained2, Constraints, Fill, Mesh2, RefineOptions, Refined2, Size};
use numpy::{IntoPyArray, PyReadonlyArray1, PyReadonlyArray2};
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
    let result = dict(py, found.inside, regions, found.segments, found.added)?;
    result.set_item("zero_length", found.zero_length)?;
    result.set_item("moved", found.moved)?;
    Ok((Mesh::two(found.mesh, threads), result))
}

/// Returns what became of segments, as the package takes it.
fn dict(
    py: Python<'_>,
    inside: Vec<bool>,
    regions: Vec<u32>,
    segments: Vec<[u32; 2]>,
    added: Vec<[f64; 2]>,
) -> PyResult<Bound<'_, PyDict>> {
    let result = PyDict::new(py);
    result.set_item("inside", inside.into_pyarray(py))?;
    result.set_item("regions", arrays::list(py, regions))?;
    result.set_item("segments", arrays::index_rows(py, segments)?)?;
    result.set_item("added", arrays::rows(py, added)?)?;
    Ok(result)
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
    let result = dict(py, found.inside, regions, found.segments, found.added)?;
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
    Ok((Mesh::two(found.mesh, threads), result))
}
