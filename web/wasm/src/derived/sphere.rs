//! Points on a sphere, whose places are longitudes and latitudes in degrees.

use super::{Task, numbers_of, offsets, queries_of};
use crate::{
    objects::{Thrown, object, signed},
    points::{Coordinates, points_of_mesh, zeros},
};
use gdel::{Error, Points, Sphere, lon_lat, on_sphere};
use js_sys::{Float64Array, Function, Int32Array, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

/// The triangles of a sphere, and the duplicates.
struct Hull {
    triangles: Vec<[u32; 3]>,
    duplicate_of: Vec<u32>,
}

impl Task<Hull> {
    /// Copies points, the triangles of their hull or of a sphere, and the duplicates.
    fn of_sphere(
        points: &JsValue,
        triangles: &Uint32Array,
        duplicate_of: &Int32Array,
        report: Function,
    ) -> Result<Self, Thrown> {
        let mut hull = Hull { triangles: Vec::new(), duplicate_of: zeros(duplicate_of.length())? };
        hull.triangles.resize(triangles.length() as usize / 3, [0; 3]);
        triangles.copy_to(hull.triangles.as_flattened_mut());
        duplicate_of.copy_to(bytemuck::cast_slice_mut(&mut hull.duplicate_of));
        let task = Task { points: points_of_mesh::<3>(points)?, mesh: hull, report, phase: "sphere" };
        task.report(0.1)?;
        Ok(task)
    }

    /// Returns the sphere. To be called once.
    fn sphere(&mut self) -> Result<Sphere<'_>, Thrown> {
        let Hull { triangles, duplicate_of } = &mut self.mesh;
        let (triangles, duplicate_of) = (std::mem::take(triangles), std::mem::take(duplicate_of));
        Ok(Sphere::from_hull(triangles, duplicate_of, self.points.points::<3>()?)?)
    }
}

/// Returns the points of the sphere for queries, which are places.
fn directions(queries: &JsValue) -> Result<Vec<[f64; 3]>, Thrown> {
    let mut queries = queries_of::<2>(queries)?;
    // Those of meshes have the other orientation.
    queries.flip_y();
    Ok(on_sphere(queries.points::<2>()?)?)
}

/// Returns the points of the sphere for places.
#[wasm_bindgen(js_name = onSphere)]
pub fn places_on_sphere(places: &JsValue) -> Result<Float64Array, Thrown> {
    let places = Coordinates::new(places)?;
    Ok(Float64Array::new_from_slice(on_sphere(places.points::<2>()?)?.as_flattened()))
}

/// Returns the arrays of a sphere, given the hull of the mesh of its points.
#[wasm_bindgen]
pub fn sphere(
    points: &JsValue,
    hull: &Uint32Array,
    duplicate_of: &Int32Array,
    report: Function,
) -> Result<JsValue, Thrown> {
    let mut task = Task::of_sphere(points, hull, duplicate_of, report)?;
    let sphere = task.sphere()?;
    let triangles = sphere.triangles();
    let halfedge = |t: usize, k: usize| {
        // From vertex k to the next one, opposite the one after that.
        let across = sphere.neighbors()[t][(k + 2) % 3];
        let start = triangles[t][(k + 1) % 3];
        let own = triangles[across as usize].iter().position(|&v| v == start).unwrap_or(0);
        3 * across + own as u32
    };
    let halfedges: Vec<u32> = (0..3 * triangles.len()).map(|e| halfedge(e / 3, e % 3)).collect();
    let outer: Vec<u8> = (0..triangles.len()).map(|t| sphere.is_outer(t).into()).collect();
    Ok(object([
        ("triangles", Uint32Array::new_from_slice(triangles.as_flattened()).into()),
        ("halfedges", signed(&halfedges).into()),
        ("outer", Uint8Array::new_from_slice(&outer).into()),
        ("hull", Uint32Array::new_from_slice(&sphere.hull()).into()),
        ("duplicateOf", signed(sphere.duplicate_of()).into()),
    ]))
}

/// Returns the point that is nearest to each query, −1 if there are none.
#[wasm_bindgen(js_name = sphereNearest)]
pub fn sphere_nearest(
    points: &JsValue,
    triangles: &Uint32Array,
    duplicate_of: &Int32Array,
    queries: &JsValue,
    report: Function,
) -> Result<Int32Array, Thrown> {
    let mut task = Task::of_sphere(points, triangles, duplicate_of, report)?;
    let found = task.sphere()?.nearest_many(&directions(queries)?)?;
    Ok(signed(&found.iter().map(|v| v.unwrap_or(gdel::NONE)).collect::<Vec<u32>>()))
}

/// Returns the triangle that contains each query, −1 outside, and how many are outside.
#[wasm_bindgen(js_name = sphereLocate)]
pub fn sphere_locate(
    points: &JsValue,
    triangles: &Uint32Array,
    duplicate_of: &Int32Array,
    queries: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    let mut task = Task::of_sphere(points, triangles, duplicate_of, report)?;
    let found = task.sphere()?.locate_many(&directions(queries)?)?;
    let found: Vec<u32> = found.iter().map(|t| t.map_or(gdel::NONE, |t| t as u32)).collect();
    let outside = found.iter().filter(|&&t| t == gdel::NONE).count();
    Ok(object([("triangles", signed(&found).into()), ("outside", (outside as f64).into())]))
}

/// Returns the interpolated value at each query, and how many are outside.
#[wasm_bindgen(js_name = sphereInterpolate)]
pub fn sphere_interpolate(
    points: &JsValue,
    triangles: &Uint32Array,
    duplicate_of: &Int32Array,
    queries: &JsValue,
    values: &Float64Array,
    report: Function,
) -> Result<JsValue, Thrown> {
    let mut task = Task::of_sphere(points, triangles, duplicate_of, report)?;
    let found = task.sphere()?.interpolate_many(&numbers_of(values)?, &directions(queries)?)?;
    Ok(object([
        ("values", Float64Array::new_from_slice(&found.values).into()),
        ("outside", (found.outside as f64).into()),
    ]))
}

/// Returns the Voronoi cells: the places of their corners, those of each cell, and the areas.
#[wasm_bindgen(js_name = sphereVoronoi)]
pub fn sphere_voronoi(
    points: &JsValue,
    triangles: &Uint32Array,
    duplicate_of: &Int32Array,
    report: Function,
) -> Result<JsValue, Thrown> {
    let mut task = Task::of_sphere(points, triangles, duplicate_of, report)?;
    let sphere = task.sphere()?;
    let (corners, cells) = sphere.polygons();
    let vertices = lon_lat(Points::F64(&corners)).map_err(|error: Error| Thrown::from(error))?;
    Ok(object([
        ("vertices", Float64Array::new_from_slice(vertices.as_flattened()).into()),
        ("cells", offsets(&cells.offsets)),
        ("corners", Uint32Array::new_from_slice(&cells.indices).into()),
        ("areas", Float64Array::new_from_slice(&sphere.areas()).into()),
    ]))
}
