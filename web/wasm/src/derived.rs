//! What is derived from a mesh.

mod sphere;

use crate::{
    clips::{clip_of, corners_of, numbers_of},
    mesh::inside_of,
    objects::{Thrown, error, get, object, set, signed},
    points::{Coordinates, room},
    task::{OfCaller, Task, coordinates, in_dimension, option},
};
use gdel::{
    AlphaShape, Constrained2, Contours, Csr, Diagram, Duplicates, Error, Grid, Interpolation, Interpolator, Location,
    Locator, Mesh2, Mesh3, Outside, Points, SpanningTree, Voronoi,
    internals::{
        cpu::edit::Used,
        derived::{SingularEdges, StolenMeasures, VoronoiShapes, singular},
        geometry::{Euclidean, Geometry},
    },
};
use js_sys::{Array, Float64Array, Function, Int32Array, Uint32Array};
use std::cell::Cell;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

/// The largest number of reports while queries are answered.
const PARTS: usize = 16;
/// The smallest number of queries between two reports: where few are answered at a time, they are
/// far from each other.
const MIN_PART: usize = 1 << 16;

/// A mesh of which all parts can be told.
trait Described<const D: usize, const N: usize>: OfCaller<D, N> {
    /// Returns the edges.
    fn edges(&self) -> Vec<[u32; 2]>;

    /// Returns the facets, which in 2D are the edges.
    fn facets(&self) -> Vec<[u32; D]>;

    /// Returns the neighbours of each vertex.
    fn vertex_neighbors(&self) -> Csr;

    /// Returns a simplex of each vertex.
    fn vertex_simplex(&self) -> Vec<u32>;

    /// Returns the centres and the radii of the circumspheres, the volumes, the ratios of the radii
    /// and the angles.
    fn shapes(&self, points: Points<'_, D>) -> Shapes<D>;

    /// Leaves out the simplices outside boundaries, which exist in 2D only.
    fn keep(&mut self, _inside: Vec<bool>) {}

    /// Returns the bounded Voronoi diagram of a mesh with constraints, which exists in 2D only.
    fn bounded_voronoi(self, _inside: Vec<bool>, _points: Points<'_, D>) -> Result<Diagram<D>, Error> {
        Err(Error::ConstrainedMesh)
    }
}

/// What the simplices of a mesh are like.
struct Shapes<const D: usize> {
    circumcenters: Vec<[f64; D]>,
    circumradii: Vec<f64>,
    volumes: Vec<f64>,
    radius_ratios: Vec<f64>,
    angles: Vec<f64>,
}

impl Described<3, 4> for Mesh3 {
    fn edges(&self) -> Vec<[u32; 2]> {
        self.edges().collect()
    }

    fn facets(&self) -> Vec<[u32; 3]> {
        self.facets().collect()
    }

    fn vertex_neighbors(&self) -> Csr {
        self.vertex_neighbors()
    }

    fn vertex_simplex(&self) -> Vec<u32> {
        self.vertex_tetrahedron()
    }

    fn shapes(&self, points: Points<'_, 3>) -> Shapes<3> {
        Shapes {
            circumcenters: self.circumcenters(points).collect(),
            circumradii: self.circumradii(points).collect(),
            volumes: self.volumes(points).collect(),
            radius_ratios: self.radius_ratios(points).collect(),
            angles: self.dihedral_angles(points).flatten().collect(),
        }
    }
}

impl Described<2, 3> for Mesh2 {
    fn edges(&self) -> Vec<[u32; 2]> {
        self.edges().collect()
    }

    fn facets(&self) -> Vec<[u32; 2]> {
        self.edges().collect()
    }

    fn vertex_neighbors(&self) -> Csr {
        self.vertex_neighbors()
    }

    fn vertex_simplex(&self) -> Vec<u32> {
        self.vertex_triangle()
    }

    fn keep(&mut self, inside: Vec<bool>) {
        let mut found = Constrained2::default();
        (found.mesh, found.inside) = (std::mem::take(self), inside);
        *self = found.inside_mesh();
    }

    fn bounded_voronoi(self, inside: Vec<bool>, points: Points<'_, 2>) -> Result<Diagram<2>, Error> {
        let mut found = Constrained2::default();
        (found.mesh, found.inside) = (self, inside);
        found.bounded_voronoi(points)
    }

    fn shapes(&self, points: Points<'_, 2>) -> Shapes<2> {
        Shapes {
            circumcenters: self.circumcenters(points).collect(),
            circumradii: self.circumradii(points).collect(),
            volumes: self.areas(points).collect(),
            radius_ratios: self.radius_ratios(points).collect(),
            angles: self.angles(points).flatten().collect(),
        }
    }
}

impl<M> Task<M> {
    /// Calls `answer` with one part of the queries after the other, to each of which it adds so many
    /// answers. There is room for all of them.
    fn in_parts<const D: usize, R>(
        &self,
        queries: &Coordinates,
        each: usize,
        answer: impl Fn(Points<'_, D>, &mut Vec<R>) -> Result<(), Error>,
    ) -> Result<Vec<R>, Thrown> {
        let count = queries.points::<D>()?.len();
        let mut answers = room(count.saturating_mul(each))?;
        let part = count.div_ceil(PARTS).max(MIN_PART);
        for start in (0..count).step_by(part) {
            let end = (start + part).min(count);
            answer(queries.part(start..end)?, &mut answers)?;
            self.report(0.1 + 0.8 * end as f64 / count as f64)?;
        }
        Ok(answers)
    }
}

/// Copies query points.
fn queries_of<const D: usize>(queries: &JsValue) -> Result<Coordinates, Thrown> {
    let mut queries = Coordinates::new(queries)?;
    queries.points::<D>()?.validate().map_err(|e| match e {
        Error::NotFinite { index, axis, value } => {
            let message = format!("query {index}: the {axis} coordinate is {value}, which is not a finite number");
            let object = error("NOT_FINITE", &message);
            set(&object, "index", index as f64);
            object.into()
        }
        e => Thrown::from(e),
    })?;
    if D == 2 {
        queries.flip_y();
    }
    Ok(queries)
}

fn offsets(offsets: &[usize]) -> JsValue {
    let offsets: Vec<u32> = offsets.iter().map(|&offset| offset as u32).collect();
    Uint32Array::new_from_slice(&offsets).into()
}

/// Returns the simplex that contains each query, and the facet of the hull that sees it: `N` per
/// simplex are counted.
#[wasm_bindgen]
pub fn locate(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, locate_in(points, mesh, queries, options, report))
}

fn locate_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "locate")?;
    let queries = queries_of::<D>(queries)?;
    let locator = locator_of(&task, options)?;
    let located = task.in_parts(&queries, 1, |part, located| {
        located.extend(locator.locate_many(part)?);
        Ok(())
    })?;
    let [mut simplices, mut facets] = [room(located.len())?, room(located.len())?];
    let outside = located.iter().filter(|location| location.simplex().is_none()).count();
    for location in located {
        let (simplex, facet) = match location {
            Location::Inside(simplex) => (simplex as i32, -1),
            Location::Outside { simplex, facet } => (-1, (N * simplex + facet) as i32),
            _ => (-1, -1),
        };
        simplices.push(simplex);
        facets.push(facet);
    }
    Ok(object([
        ("simplices", Int32Array::new_from_slice(&simplices).into()),
        ("facets", Int32Array::new_from_slice(&facets).into()),
        ("outside", (outside as f64).into()),
    ]))
}

/// Returns the locator, without a tolerance if it is to be exact.
fn locator_of<'a, M: OfCaller<D, N>, const D: usize, const N: usize>(
    task: &'a Task<M>,
    options: &JsValue,
) -> Result<Locator<'a, D, N>, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let locator = Locator::new(&task.mesh, task.points.points::<D>()?)?;
    Ok(if get(options, "exact").is_truthy() { locator.exact() } else { locator })
}

/// Returns the `k` vertices that are nearest to each query, nearest first, and −1 where there are
/// not so many.
#[wasm_bindgen]
pub fn nearest(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    k: usize,
    report: Function,
) -> Result<Int32Array, Thrown> {
    in_dimension!(dimension, nearest_in(points, mesh, queries, k, report))
}

fn nearest_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    k: usize,
    report: Function,
) -> Result<Int32Array, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "nearest")?;
    let queries = queries_of::<D>(queries)?;
    let locator = Locator::new(&task.mesh, task.points.points::<D>()?)?;
    let nearest = task.in_parts(&queries, k, |part, nearest| {
        if k == 1 {
            nearest.extend(locator.nearest_many(part)?.into_iter().map(|vertex| vertex.map_or(-1, |v| v as i32)));
            return Ok(());
        }
        for query in part.iter() {
            let end = nearest.len() + k;
            nearest.extend(locator.nearest_k(query, k)?.into_iter().map(|v| v as i32));
            nearest.resize(end, -1);
        }
        Ok(())
    })?;
    Ok(Int32Array::new_from_slice(&nearest))
}

/// Returns the interpolated value at each query, and how many of these are outside the hull.
#[wasm_bindgen]
pub fn interpolate(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    values: &Float64Array,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, interpolate_in(points, mesh, queries, values, options, report))
}

fn interpolate_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    values: &Float64Array,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: StolenMeasures<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "interpolate")?;
    let queries = queries_of::<D>(queries)?;
    let values = numbers_of(values)?;
    let locator = locator_of(&task, options)?;
    let inside = inside_of(mesh)?;
    let (interpolator, method) = interpolator_of(&locator, (&values, &inside), options)?;
    let count = Cell::new(0);
    let found = task.in_parts(&queries, 1, |part, found| {
        let part = interpolator.interpolate_many(method, part)?;
        found.extend(part.values);
        count.set(count.get() + part.outside);
        Ok(())
    })?;
    let values = Float64Array::new_from_slice(&found).into();
    Ok(object([("values", values), ("outside", (count.get() as f64).into())]))
}

/// Returns an interpolator and its method. If there are boundaries, `inside` says which triangles are inside.
fn interpolator_of<'a, const D: usize, const N: usize>(
    locator: &'a Locator<'a, D, N>,
    (values, inside): (&'a [f64], &'a [bool]),
    options: &JsValue,
) -> Result<(Interpolator<'a, D, N>, Interpolation), Thrown>
where
    Euclidean: StolenMeasures<D, N>,
{
    let word = |name: &str| get(options, name).as_string().unwrap_or_default();
    let method = match word("method").as_str() {
        "sibson" => Interpolation::Sibson,
        "laplace" => Interpolation::Laplace,
        "sibson-c1" => Interpolation::SibsonC1,
        "clough-tocher" => Interpolation::CloughTocher,
        _ => Interpolation::Linear,
    };
    let duplicates = match word("duplicates").as_str() {
        "mean" => Duplicates::Mean,
        "error" => Duplicates::Error,
        _ => Duplicates::First,
    };
    let outside = match word("outside").as_str() {
        "nearest" => Outside::Nearest,
        "linear" => Outside::Linear,
        // A number, or `nan`.
        _ => Outside::Value(get(options, "outside").as_f64().unwrap_or(f64::NAN)),
    };
    let interpolator = Interpolator::new(locator, values)?.duplicates(duplicates)?.outside(outside);
    let interpolator = if inside.contains(&false) { interpolator.inside(inside)? } else { interpolator };
    Ok((interpolator, method))
}

/// Returns the interpolated value at the centre of each cell of a grid, with *y* growing from row to row, and how many
/// of these are outside the hull.
#[wasm_bindgen(js_name = interpolateGrid)]
pub fn interpolate_grid(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    values: &Float64Array,
    grid: &Float64Array,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, interpolate_grid_in(points, mesh, values, grid, options, report))
}

fn interpolate_grid_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    values: &Float64Array,
    grid: &Float64Array,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: StolenMeasures<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "interpolate")?;
    let values = numbers_of(values)?;
    let numbers = numbers_of(grid)?;
    let [size, mut low, mut high]: [[f64; D]; 3] =
        std::array::from_fn(|row| std::array::from_fn(|axis| numbers.get(D * row + axis).copied().unwrap_or(0.0)));
    // The negation also turns the rows of a 2D grid around.
    if D == 2 {
        [low[1], high[1]] = [-high[1], -low[1]];
    }
    let grid = Grid { size: size.map(|count| count as usize), bounds: [low, high] };
    let locator = locator_of(&task, options)?;
    let inside = inside_of(mesh)?;
    let (interpolator, method) = interpolator_of(&locator, (&values, &inside), options)?;
    let found = interpolator.interpolate_grid(method, &grid)?;
    let values = Float64Array::new_from_slice(&found.values).into();
    Ok(object([("values", values), ("outside", (found.outside as f64).into())]))
}

/// Returns the weights of the points at each query, as a sparse matrix.
#[wasm_bindgen(js_name = interpolationWeights)]
pub fn interpolation_weights(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, weights_in(points, mesh, queries, options, report))
}

fn weights_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    queries: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: StolenMeasures<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "interpolate")?;
    let queries = queries_of::<D>(queries)?;
    let locator = locator_of(&task, options)?;
    let values = vec![0.0; task.points.points::<D>()?.len()];
    let inside = inside_of(mesh)?;
    let (interpolator, method) = interpolator_of(&locator, (&values, &inside), options)?;
    let table = interpolator.weights_many(method, queries.points::<D>()?)?;
    let offsets: Vec<u32> = table.offsets.iter().map(|&offset| offset as u32).collect();
    Ok(object([
        ("offsets", Uint32Array::new_from_slice(&offsets).into()),
        ("points", Uint32Array::new_from_slice(&table.points).into()),
        ("weights", Float64Array::new_from_slice(&table.weights).into()),
        ("outside", (table.outside as f64).into()),
    ]))
}

/// Returns the gradient of the values at each point.
#[wasm_bindgen]
pub fn gradients(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    values: &Float64Array,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, gradients_in(points, mesh, values, options, report))
}

fn gradients_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    values: &Float64Array,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: StolenMeasures<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "interpolate")?;
    let values = numbers_of(values)?;
    let locator = locator_of(&task, options)?;
    let inside = inside_of(mesh)?;
    let (interpolator, _) = interpolator_of(&locator, (&values, &inside), options)?;
    Ok(coordinates(interpolator.gradients()).into())
}

/// Returns for each level the contour, or the isosurface in 3D; closed along the hull, and along boundaries, if that is
/// wanted.
#[wasm_bindgen]
pub fn contours(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    values: &Float64Array,
    levels: &Float64Array,
    closed: bool,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, contours_in(points, mesh, values, levels, closed, report))
}

fn contours_in<M: Described<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    values: &Float64Array,
    levels: &Float64Array,
    closed: bool,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let mut task = Task::<M>::new::<D, N>(points, mesh, report, "contours")?;
    let inside = inside_of(mesh)?;
    if inside.contains(&false) {
        if inside.len() != task.mesh.simplices().len() {
            return Err(error("BAD_INPUT", "constraints.inside must have one entry per triangle").into());
        }
        task.mesh.keep(inside);
    }
    let (values, levels) = (numbers_of(values)?, numbers_of(levels)?);
    let contours = Contours::new(&task.mesh, task.points.points::<D>()?, &values)?;
    let found = Array::new();
    for (i, &level) in levels.iter().enumerate() {
        let contour = if closed { contours.closed_at(level) } else { contours.at(level) };
        let vertices = ("vertices", coordinates(&contour.vertices).into());
        found.push(&if D == 2 {
            let lines = contour.lines();
            object([
                ("level", level.into()),
                vertices,
                ("lineOffsets", offsets(&lines.offsets)),
                ("lines", Uint32Array::new_from_slice(&lines.indices).into()),
            ])
        } else {
            let triangles = Uint32Array::new_from_slice(contour.facets.as_flattened()).into();
            object([("level", level.into()), vertices, ("triangles", triangles)])
        });
        task.report(0.1 + 0.8 * (i + 1) as f64 / levels.len() as f64)?;
    }
    Ok(found.into())
}

/// Returns the Voronoi diagram, clipped as [`clip_of`] says; with constraints, the bounded one.
#[wasm_bindgen]
pub fn voronoi(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    clip: &str,
    bounds: &Float64Array,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, voronoi_in(points, mesh, clip, bounds, report))
}

fn voronoi_in<M: Described<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    clip: &str,
    bounds: &Float64Array,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: VoronoiShapes<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "voronoi")?;
    let points = task.points.points::<D>()?;
    let inside = inside_of(mesh)?;
    let diagram = if inside.is_empty() && task.mesh.constraints().is_empty() {
        let used = Used::of(points, task.mesh.duplicate_of());
        let corners = corners_of::<D>(bounds)?;
        let clip = clip_of(clip, &corners, used.as_ref().map_or(points, Used::points));
        let voronoi = Voronoi::new(&task.mesh, points, clip)?;
        task.report(0.3)?;
        let diagram = voronoi.diagram();
        task.report(0.9)?;
        diagram
    } else if matches!(clip, "none" | "hull") {
        task.mesh.bounded_voronoi(inside, points)?
    } else {
        let message = "the cells of a mesh with constraints end at its boundaries: leave out the option clip";
        return Err(error("BAD_INPUT", message).into());
    };
    Ok(object([
        ("vertices", coordinates(&diagram.vertices).into()),
        ("facetOffsets", offsets(&diagram.facets.offsets)),
        ("facets", Uint32Array::new_from_slice(&diagram.facets.indices).into()),
        ("neighbors", signed(&diagram.neighbors).into()),
        ("areas", Float64Array::new_from_slice(&diagram.areas).into()),
        ("cells", offsets(&diagram.cells)),
        ("volumes", Float64Array::new_from_slice(&diagram.volumes).into()),
        ("centroids", coordinates(&diagram.centroids).into()),
    ]))
}

/// Returns the alpha shape for a radius, or without one for the smallest that has all points in at
/// most so many components; on request with critical values and singular faces.
#[wasm_bindgen(js_name = alphaShape)]
pub fn alpha_shape(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, alpha_shape_in(points, mesh, options, report))
}

fn alpha_shape_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: SingularEdges<D, N>,
{
    let (mut components, mut are_critical_wanted, mut are_singular_wanted) = (1, false, false);
    let count = |value: &JsValue| value.as_f64().map(|count| count as usize);
    option(options, "components", "a number", count, &mut components)?;
    option(options, "criticalValues", "true or false", JsValue::as_bool, &mut are_critical_wanted)?;
    option(options, "singular", "true or false", JsValue::as_bool, &mut are_singular_wanted)?;
    let task = Task::<M>::new::<D, N>(points, mesh, report, "alpha")?;
    let shape = AlphaShape::new(&task.mesh, task.points.points::<D>()?)?;
    task.report(0.6)?;
    // A single point has no radius.
    let alpha = match get(options, "alpha").as_f64() {
        Some(alpha) => shape.up_to_rounding(alpha),
        None => shape.auto_alpha(components).unwrap_or(0.0),
    };
    let complex = shape.at(alpha)?;
    let critical = if are_critical_wanted { shape.critical_values() } else { Vec::new() };
    let (mut facets, mut edges, mut vertices) = (Vec::new(), Vec::new(), Vec::new());
    if are_singular_wanted {
        facets = singular(complex.facets());
        edges = Euclidean::singular_edges(&complex);
        vertices = singular(complex.vertices());
    }
    task.report(0.9)?;
    let solid: Vec<u32> = complex.solid().map(|t| t as u32).collect();
    let surface: Vec<[u32; D]> = complex.surface().collect();
    let radii: Vec<f64> = shape.simplices().collect();
    let (labels, count) = complex.components();
    Ok(object([
        ("alpha", alpha.into()),
        ("solid", Uint32Array::new_from_slice(&solid).into()),
        ("surface", Uint32Array::new_from_slice(surface.as_flattened()).into()),
        ("components", count.into()),
        ("componentOf", signed(&labels).into()),
        ("radii", Float64Array::new_from_slice(&radii).into()),
        ("criticalValues", Float64Array::new_from_slice(&critical).into()),
        ("singularFacets", Uint32Array::new_from_slice(facets.as_flattened()).into()),
        ("singularEdges", Uint32Array::new_from_slice(edges.as_flattened()).into()),
        ("singularVertices", Uint32Array::new_from_slice(&vertices).into()),
    ]))
}

/// Returns the minimum spanning tree.
#[wasm_bindgen(js_name = spanningTree)]
pub fn spanning_tree(dimension: u32, points: &JsValue, mesh: &JsValue, report: Function) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, spanning_tree_in(points, mesh, report))
}

fn spanning_tree_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "tree")?;
    let tree = SpanningTree::new(&task.mesh, task.points.points::<D>()?)?;
    task.report(0.9)?;
    Ok(object([
        ("edges", Uint32Array::new_from_slice(tree.edges.as_flattened()).into()),
        ("lengths", Float64Array::new_from_slice(&tree.lengths).into()),
    ]))
}

/// Returns what is connected with what.
#[wasm_bindgen]
pub fn topology(dimension: u32, points: &JsValue, mesh: &JsValue, report: Function) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, topology_in(points, mesh, report))
}

fn topology_in<M: Described<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "topology")?;
    // Only to check the mesh.
    Locator::new(&task.mesh, task.points.points::<D>()?)?;
    let edges = Described::edges(&task.mesh);
    task.report(0.4)?;
    let facets = Described::facets(&task.mesh);
    task.report(0.6)?;
    let neighbors = Described::vertex_neighbors(&task.mesh);
    task.report(0.9)?;
    Ok(object([
        ("edges", Uint32Array::new_from_slice(edges.as_flattened()).into()),
        ("facets", Uint32Array::new_from_slice(facets.as_flattened()).into()),
        ("neighborOffsets", offsets(&neighbors.offsets)),
        ("neighbors", Uint32Array::new_from_slice(&neighbors.indices).into()),
        ("vertexSimplex", signed(&task.mesh.vertex_simplex()).into()),
    ]))
}

/// Returns what the simplices are like.
#[wasm_bindgen]
pub fn geometry(dimension: u32, points: &JsValue, mesh: &JsValue, report: Function) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, geometry_in(points, mesh, report))
}

fn geometry_in<M: Described<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "geometry")?;
    let points = task.points.points::<D>()?;
    // Only to check the mesh.
    Locator::new(&task.mesh, points)?;
    let Shapes { circumcenters, circumradii, volumes, radius_ratios, angles } = task.mesh.shapes(points);
    task.report(0.9)?;
    Ok(object([
        ("circumcenters", coordinates(&circumcenters).into()),
        ("circumradii", Float64Array::new_from_slice(&circumradii).into()),
        ("volumes", Float64Array::new_from_slice(&volumes).into()),
        ("radiusRatios", Float64Array::new_from_slice(&radius_ratios).into()),
        ("angles", Float64Array::new_from_slice(&angles).into()),
    ]))
}
