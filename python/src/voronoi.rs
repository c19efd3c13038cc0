//! Voronoi diagrams, as this library has them and as SciPy has them.

use crate::{
    arrays::{self, Input},
    compute,
    core::{Core, Data, Derives},
};
use gdel::{
    Clip, Diagram, NONE, Points, Voronoi,
    internals::{derived::DisjointSets, geometry::Euclidean},
};
use numpy::IntoPyArray;
use pyo3::{exceptions::PyValueError, prelude::*, types::PyDict};
use std::collections::HashMap;

/// What cells are clipped to, as the package passes it: nothing (`None`), `"box"`, `"hull"`, a box as its lowest and its
/// highest corner, or the corners of a convex shape.
pub(crate) enum Shape<const D: usize> {
    None,
    Box,
    Hull,
    /// A box that is given.
    Bounds([[f64; D]; 2]),
    Corners(Vec<[f64; D]>),
}

impl<const D: usize> Shape<D> {
    /// Reads the argument.
    pub(crate) fn new(clip: &Bound<'_, PyAny>) -> PyResult<Self> {
        if clip.is_none() {
            return Ok(Shape::None);
        }
        if let Ok(name) = clip.extract::<String>() {
            return match name.as_str() {
                "box" => Ok(Shape::Box),
                "hull" => Ok(Shape::Hull),
                _ => Err(PyValueError::new_err(format!("clip must be 'box', 'hull' or corners, not {name:?}"))),
            };
        }
        let corners: Vec<[f64; D]> = Input::new(clip)?.points::<D>()?.iter().collect();
        Ok(<[[f64; D]; 2]>::try_from(corners).map_or_else(Shape::Corners, Shape::Bounds))
    }

    /// Returns what the cells of points are clipped to.
    pub(crate) fn clip(&self, points: Points<'_, D>) -> Clip<'_, D> {
        match self {
            Shape::None => Clip::None,
            // No points have no box, and an empty hull.
            Shape::Box => points.bounds().map_or(Clip::Hull, Clip::Box),
            Shape::Hull => Clip::Hull,
            Shape::Bounds(bounds) => Clip::Box(*bounds),
            Shape::Corners(corners) => Clip::Convex(corners),
        }
    }
}

/// Returns the diagram, clipped to a shape.
pub(crate) fn diagram<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    clip: &Bound<'py, PyAny>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>>
where
    Euclidean: Derives<D, N>,
{
    let points = input.points::<D>()?;
    let shape = Shape::new(clip)?;
    let clip = shape.clip(points);
    let found = compute::run(py, threads, || Ok(Voronoi::new(&*data.mesh, points, clip)?.diagram()))?;
    let result = PyDict::new(py);
    result.set_item("vertices", arrays::rows(py, found.vertices)?)?;
    result.set_item("facets", arrays::csr(py, found.facets))?;
    result.set_item("neighbors", arrays::list(py, found.neighbors))?;
    result.set_item("areas", found.areas.into_pyarray(py))?;
    result.set_item("cells", arrays::offsets(py, found.cells))?;
    result.set_item("volumes", found.volumes.into_pyarray(py))?;
    result.set_item("centroids", arrays::rows(py, found.centroids)?)?;
    Ok(result)
}

/// Ridges and regions. Circumcentres of simplices on one sphere are one vertex.
struct Ridges<const D: usize> {
    vertices: Vec<[f64; D]>,
    /// The two points of each ridge.
    points: Vec<[u32; 2]>,
    /// Where the vertices of each ridge end.
    ends: Vec<usize>,
    /// The vertices of each ridge, with `NONE` first if it is unbounded.
    of_ridges: Vec<u32>,
    /// Where the vertices of each point's region end.
    region_ends: Vec<usize>,
    /// The vertices of each region, with `NONE` first if it is unbounded.
    of_regions: Vec<u32>,
}

/// Returns ridges and regions as SciPy has them.
pub(crate) fn ridges<'py, M: Core<D, N>, const D: usize, const N: usize>(
    data: &Data<M, D, N>,
    py: Python<'py>,
    input: &Input<'_>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyDict>>
where
    Euclidean: Derives<D, N>,
{
    let points = input.points::<D>()?;
    let found = compute::run(py, threads, || {
        let diagram = Voronoi::new(&*data.mesh, points, Clip::None)?.diagram();
        Ok(ridges_of(&diagram, data.mesh.dimension().into(), &merged::<M, D, N>(&data.mesh, points)))
    })?;
    let result = PyDict::new(py);
    result.set_item("vertices", arrays::rows(py, found.vertices)?)?;
    result.set_item("ridge_points", arrays::index_rows(py, found.points)?)?;
    result.set_item("ridge_ends", arrays::offsets(py, found.ends))?;
    result.set_item("ridge_vertices", arrays::list(py, found.of_ridges))?;
    result.set_item("region_ends", arrays::offsets(py, found.region_ends))?;
    result.set_item("region_vertices", arrays::list(py, found.of_regions))?;
    Ok(result)
}

/// Returns for each simplex the first one on the same sphere.
fn merged<M: Core<D, N>, const D: usize, const N: usize>(mesh: &M, points: gdel::Points<'_, D>) -> Vec<u32> {
    let (simplices, neighbors) = (mesh.simplices(), mesh.opposites());
    let mut spheres = DisjointSets::new(simplices.len());
    for (t, across) in (0..).zip(&*neighbors) {
        let corners = simplices[t as usize].map(|v| points.get(v as usize));
        for &u in across.iter().filter(|&&u| u != NONE && u > t) {
            let opposite = simplices[u as usize].into_iter().find(|v| !simplices[t as usize].contains(v));
            if opposite.is_some_and(|v| M::is_cospherical(corners, points.get(v as usize))) {
                spheres.unite(t, u);
            }
        }
    }
    (0..simplices.len() as u32).map(|t| spheres.find(t)).collect()
}

/// Returns the ridges and regions of points that span `dimension` dimensions.
fn ridges_of<const D: usize>(diagram: &Diagram<D>, dimension: usize, first: &[u32]) -> Ridges<D> {
    let mut number = vec![NONE; first.len()];
    let mut ridges = Ridges {
        vertices: Vec::new(),
        points: Vec::new(),
        ends: Vec::new(),
        of_ridges: Vec::new(),
        region_ends: Vec::new(),
        of_regions: Vec::new(),
    };
    for (t, &root) in first.iter().enumerate() {
        if root as usize == t {
            number[t] = ridges.vertices.len() as u32;
            ridges.vertices.push(diagram.vertices[t]);
        } else {
            number[t] = number[root as usize];
        }
    }
    // Only cells of flat points have vertices that are not circumcentres: each cell its own, with equal bits.
    let mut others = HashMap::new();
    for vertex in &diagram.vertices[first.len()..] {
        number.push(*others.entry(vertex.map(f64::to_bits)).or_insert_with(|| {
            ridges.vertices.push(*vertex);
            ridges.vertices.len() as u32 - 1
        }));
    }
    let mut chain = Vec::new();
    for (point, facets) in (0..).zip(diagram.cells.windows(2)) {
        let start = ridges.of_regions.len();
        let is_bounded = diagram.volumes[point as usize].is_finite();
        for f in facets[0]..facets[1] {
            chain.clear();
            chain.extend(diagram.facets.of(f as u32).iter().map(|&vertex| number[vertex as usize]));
            let is_open = diagram.areas[f].is_infinite();
            ridges.of_regions.extend_from_slice(&chain);
            chain.dedup();
            if !is_open && chain.len() > 1 && chain.first() == chain.last() {
                chain.pop();
            }
            // As many with the vertex at infinity, which SciPy counts.
            let least = if is_open { dimension - 1 } else { dimension };
            if point < diagram.neighbors[f] && diagram.areas[f] > 0.0 && chain.len() >= least {
                ridges.points.push([point, diagram.neighbors[f]]);
                ridges.of_ridges.extend(is_open.then_some(NONE));
                ridges.of_ridges.extend_from_slice(&chain);
                ridges.ends.push(ridges.of_ridges.len());
            }
        }
        let region = unique(ridges.of_regions.split_off(start), D);
        ridges.of_regions.extend((!is_bounded && !region.is_empty()).then_some(NONE));
        ridges.of_regions.extend(region);
        ridges.region_ends.push(ridges.of_regions.len());
    }
    ridges
}

/// Returns the vertices of a region once each, in 2D in their order around it.
fn unique(mut vertices: Vec<u32>, dimension: usize) -> Vec<u32> {
    if dimension == 3 {
        vertices.sort_unstable();
    }
    vertices.dedup();
    if vertices.len() > 1 && vertices.first() == vertices.last() {
        vertices.pop();
    }
    vertices
}
