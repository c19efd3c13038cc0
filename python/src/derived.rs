//! What is derived from meshes, as dictionaries of arrays.

use crate::{
    arrays::{self, Input},
    compute,
    core::{Core, Data, Derives},
    tree::Tree,
};
use gdel::{
    AlphaShape, BallComplex, FaceClass, Mesh2, MeshView2, Open, Side, SpanningTree, Surface, SurfaceOptions,
    internals::geometry::Euclidean,
};
use numpy::IntoPyArray;
use pyo3::{exceptions::PyValueError, prelude::*, types::PyDict};
use std::borrow::Cow;

/// Returns the shapes of the simplices.
pub(crate) fn shapes<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let points = input.points::<D>()?;
    let shapes = compute::run(py, threads, || Ok(data.mesh.shapes(points)))?;
    let result = PyDict::new(py);
    result.set_item("circumcenters", arrays::rows(py, shapes.circumcenters)?)?;
    result.set_item("circumradii", shapes.circumradii.into_pyarray(py))?;
    result.set_item("volumes", shapes.volumes.into_pyarray(py))?;
    result.set_item("radius_ratios", shapes.radius_ratios.into_pyarray(py))?;
    Ok(result)
}

/// Returns the alpha shape of a radius, or of the smallest one whose solid has all points and so many components.
pub(crate) fn alpha_shape<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    alpha: Option<f64>,
    components: usize,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>>
where
    Euclidean: Derives<D, N>,
{
    let points = input.points::<D>()?;
    let (alpha, solid, surface, radii) = compute::run(py, threads, || {
        let shape = AlphaShape::new(&*data.mesh, points)?;
        let radii: Vec<f64> = shape.simplices().collect();
        let alpha = match alpha {
            Some(alpha) => shape.up_to_rounding(alpha),
            None => shape.auto_alpha(components).unwrap_or(0.0),
        };
        let complex = shape.at(alpha)?;
        let solid: Vec<u32> = complex.solid().map(|t| t as u32).collect();
        let surface: Vec<[u32; D]> = complex.surface().collect();
        Ok((alpha, solid, surface, radii))
    })?;
    let result = PyDict::new(py);
    result.set_item("alpha", alpha)?;
    result.set_item("solid", arrays::list(py, solid))?;
    result.set_item("surface", arrays::index_rows(py, surface)?)?;
    result.set_item("radii", radii.into_pyarray(py))?;
    Ok(result)
}

/// Returns the alpha complex of the balls of a mesh. Where it has no weights, since all are equal, they are `weight`.
pub(crate) fn ball_complex<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    alpha: f64,
    weight: f64,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>>
where
    Euclidean: Derives<D, N>,
{
    let points = input.points::<D>()?;
    let (solid, faces, (component_of, components)) = compute::run(py, threads, || {
        let weights = match data.mesh.weights() {
            [] => Cow::Owned(vec![weight; points.len()]),
            weights => Cow::Borrowed(weights),
        };
        let complex = BallComplex::new(&*data.mesh, points, &weights, alpha)?;
        let solid: Vec<u32> = complex.solid().map(|t| t as u32).collect();
        let faces = (parts(complex.facets()), parts(complex.edges()), parts(complex.vertices()));
        Ok((solid, (complex.surface().to_vec(), faces), complex.components()))
    })?;
    let (surface, (facets, edges, vertices)) = faces;
    let result = PyDict::new(py);
    result.set_item("alpha", alpha)?;
    result.set_item("solid", arrays::list(py, solid))?;
    result.set_item("surface", arrays::index_rows(py, surface)?)?;
    result.set_item("facets", arrays::index_rows(py, facets.all)?)?;
    result.set_item("edges", arrays::index_rows(py, edges.all)?)?;
    result.set_item("vertices", arrays::list(py, vertices.all))?;
    result.set_item("singular_facets", arrays::index_rows(py, facets.singular)?)?;
    result.set_item("singular_edges", arrays::index_rows(py, edges.singular)?)?;
    result.set_item("singular_vertices", arrays::list(py, vertices.singular))?;
    result.set_item("components", components)?;
    result.set_item("component_of", arrays::list(py, component_of))?;
    Ok(result)
}

/// Faces that are part of a complex.
struct Parts<F> {
    all: Vec<F>,
    /// Those that belong to no larger one.
    singular: Vec<F>,
}

fn parts<F: Copy>(faces: &[(F, FaceClass)]) -> Parts<F> {
    let those = |is_one: fn(FaceClass) -> bool| {
        faces.iter().filter(|(_, class)| is_one(*class)).map(|&(face, _)| face).collect()
    };
    Parts { all: those(FaceClass::is_part), singular: those(|class| class == FaceClass::Singular) }
}

/// Returns the surface and the solid that it encloses.
pub(crate) fn surface<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    wanted: &Bound<'py, PyDict>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>>
where
    Euclidean: Derives<D, N>,
{
    let points = input.points::<D>()?;
    let array = |name: &str| match wanted.get_item(name)? {
        Some(array) => Input::new(&array).map(Some),
        None => Ok::<_, PyErr>(None),
    };
    let (normals, sensors) = (array("normals")?, array("sensors")?);
    let mut options = SurfaceOptions::<D>::default();
    if let Some(min_part) = wanted.get_item("min_part")? {
        options.min_part = min_part.extract()?;
    }
    if let Some(drop_isolated) = wanted.get_item("drop_isolated")? {
        options.drop_isolated = drop_isolated.extract()?;
    }
    if let Some(smooth) = wanted.get_item("smooth")? {
        options.smooth = Some(smooth.extract()?);
    }
    if let Some(up) = wanted.get_item("up")? {
        options.up = Some(up.extract()?);
    }
    if let Some(open) = wanted.get_item("open")? {
        options.open = match open.extract::<String>()?.as_str() {
            "never" => Open::Never,
            "auto" => Open::Auto,
            name => return Err(PyValueError::new_err(format!("open must be 'never' or 'auto', not {name:?}"))),
        };
    }
    if let Some(refine) = wanted.get_item("refine")? {
        options.refine = refine.extract()?;
    }
    options.normals = normals.as_ref().map(Input::points).transpose()?;
    options.sensors = sensors.as_ref().map(Input::points).transpose()?;
    let surface = compute::run(py, threads, || Surface::new(&*data.mesh, points, &options))?;
    surface_arrays(py, &surface)
}

fn surface_arrays<'py, const D: usize, const N: usize>(
    py: Python<'py>,
    surface: &Surface<D, N>,
) -> PyResult<Bound<'py, PyDict>>
where
    Euclidean: Derives<D, N>,
{
    let result = PyDict::new(py);
    let side = |side: &Side| match side {
        Side::Inside => 1,
        Side::On => 0,
        Side::Outside => -1i8,
    };
    result.set_item("vertices", arrays::rows(py, surface.vertices().to_vec())?)?;
    result.set_item("facets", arrays::index_rows(py, surface.facets().to_vec())?)?;
    result.set_item("sources", arrays::list(py, surface.sources().to_vec()))?;
    result.set_item("solid", arrays::index_rows(py, surface.solid().to_vec())?)?;
    result.set_item("sides", surface.sides().iter().map(side).collect::<Vec<i8>>().into_pyarray(py))?;
    result.set_item("volume", surface.volume())?;
    result.set_item("area", surface.area())?;
    result.set_item("components", surface.components())?;
    result.set_item("genus", surface.genus())?;
    result.set_item("boundaries", surface.boundaries())?;
    result.set_item("evidence", surface.evidence().name())?;
    result.set_item("isolated", surface.isolated())?;
    result.set_item("noise", surface.noise())?;
    result.set_item("closed", surface.is_closed())?;
    Ok(result)
}

/// Returns the minimum spanning tree.
pub(crate) fn spanning_tree<M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'_>,
    input: &Input<'_>,
    threads: Option<usize>,
) -> PyResult<Tree>
where
    Euclidean: Derives<D, N>,
{
    let points = input.points::<D>()?;
    compute::run(py, threads, || SpanningTree::new(&*data.mesh, points)).map(Tree)
}

/// Returns what an exact check of the mesh has found.
pub(crate) fn verify<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let points = input.points::<D>()?;
    report(py, &compute::run(py, threads, || data.mesh.verify(points))?)
}

pub(crate) fn verify_constrained<'py>(
    data: &Data<Mesh2, 2, 3>,
    py: Python<'py>,
    input: &Input<'_>,
    segments: &[[u32; 2]],
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>> {
    let points = input.points::<2>()?;
    let mut view = MeshView2::from(&*data.mesh);
    view.segments = Some(segments);
    report(py, &compute::run(py, threads, || gdel::verify2d(points, view))?)
}

fn report<'py>(py: Python<'py>, report: &gdel::verify::Report) -> PyResult<Bound<'py, PyDict>> {
    let failures: Vec<(&str, String, usize)> =
        report.failures().map(|(check, defect, count)| (check.name(), defect.to_string(), count)).collect();
    let result = PyDict::new(py);
    result.set_item("passed", report.passed())?;
    result.set_item("failures", failures)?;
    result.set_item("vertices", report.counts.vertices)?;
    result.set_item("dimension", report.dimension)?;
    Ok(result)
}
