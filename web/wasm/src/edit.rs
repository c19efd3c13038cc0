//! Meshes in the memory of the CPU that gain and lose points, those of weighted points, and those with constraints.

use gdel::{
    Constrained2, Constraints, Error, Fill, Mesh2, Mesh3, RefineOptions, Size, TinOptions,
    internals::{
        Options, Winding,
        constrained::{constrained, tin},
        cpu::{
            Insert, MeshOf,
            edit::{Edit, Sparse, Used, delaunay_of_used, edit},
            regular,
        },
        dimension::Dimension,
        mesh::MeshInfo,
    },
    stats::{Restart, UpdateStats},
};
use js_sys::{Float64Array, Function, Int32Array, Uint8Array, Uint32Array};
use std::sync::Arc;
use wasm_bindgen::{
    JsCast,
    prelude::{JsValue, wasm_bindgen},
};

use crate::{
    arrays::{
        d2::mesh2,
        d3::{Outputs, mesh3},
    },
    mesh::{CallerMesh, inside_of, property},
    objects::{Thrown, error, get, object, set, signed},
    points::Coordinates,
    run::reporting,
};

/// Changes a mesh of 2 or 3 dimensions; in 2D in delaunator's orientation.
///
/// * With the points `before`, which are those of the mesh, and an array `removed` of indices: inserts
///   `points` after them, and removes those with these indices.
/// * With `before` only: drops the points that were removed. The result then has the former indices of
///   the others, as `kept`.
/// * Without both: moves the points of the mesh to `points`. Removed ones stay so.
///
/// In the first two cases the result has the points as well.
#[wasm_bindgen]
pub fn change(
    dimension: u32,
    points: JsValue,
    before: JsValue,
    mesh: JsValue,
    removed: JsValue,
    outputs: Outputs,
    report: Function,
) -> Result<JsValue, Thrown> {
    let options = Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() };
    if dimension == 3 {
        let mut mesh = Mesh3::from(CallerMesh::new(&mesh, "tetrahedra", "neighbors")?);
        let changed = changed::<3, 4>(&mut mesh, &points, &before, &removed, &options, Mesh3::compact)?;
        return Ok(changed.of(|| mesh3(mesh, outputs)));
    }
    let options = Options { winding: Winding::Clockwise, ..options };
    let mut mesh = Mesh2::from(CallerMesh::new(&mesh, "triangles", "halfedges")?);
    let changed = changed::<2, 3>(&mut mesh, &points, &before, &removed, &options, Mesh2::compact)?;
    Ok(changed.of(|| mesh2(mesh, true)))
}

/// Triangulates weighted points in 2 or 3 dimensions; in 2D in delaunator's orientation.
#[wasm_bindgen]
pub fn regular_triangulation(
    dimension: u32,
    points: JsValue,
    weights: Vec<f64>,
    outputs: Outputs,
    report: Function,
) -> Result<JsValue, Thrown> {
    let options = Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() };
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    if dimension == 3 {
        return Ok(mesh3(regular::<3>(coordinates.points()?, &weights, &options)?, outputs));
    }
    let options = Options { winding: Winding::Clockwise, ..options };
    Ok(mesh2(regular::<2>(coordinates.points()?, &weights, &options)?, true))
}

/// Triangulates points in 2D with constraints, in delaunator's orientation. `edges` and `boundary` have two indices per
/// segment, and `holes` two coordinates per place. The result has the points as well, if some were added.
#[wasm_bindgen]
pub fn constrained_triangulation(
    points: JsValue,
    edges: Vec<u32>,
    boundary: Vec<u32>,
    holes: Vec<f64>,
    fill: &str,
    is_split: bool,
    report: Function,
) -> Result<JsValue, Thrown> {
    let options = Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() };
    let mut coordinates = Coordinates::new(&points)?;
    drop(points);
    coordinates.flip_y();
    let holes = holes.as_chunks().0.iter().map(|&[x, y]| [x, -y]);
    let constraints = constraints_of(&edges, &boundary, holes, fill, is_split);
    let found = constrained(coordinates.points()?, &constraints, &options)?;
    Ok(constrained_mesh(found, coordinates).0)
}

/// Returns constraints of two indices per segment.
fn constraints_of(
    edges: &[u32],
    boundary: &[u32],
    holes: impl Iterator<Item = [f64; 2]>,
    fill: &str,
    is_split: bool,
) -> Constraints {
    let fill = match fill {
        "evenodd" => Fill::EvenOdd,
        "nonzero" => Fill::NonZero,
        "enclosed" => Fill::Enclosed,
        _ => Fill::All,
    };
    let constraints = Constraints::new().edges(edges.as_chunks().0).boundary(boundary.as_chunks().0).fill(fill);
    let constraints = if is_split { constraints.split_crossings() } else { constraints };
    holes.fold(constraints, Constraints::hole)
}

/// Makes terrain of 3D points, with the arguments of [`constrained_triangulation`] as `segments`. *y* stays as it is: the
/// triangles are counter-clockwise as seen from above with *y* up.
#[wasm_bindgen(js_name = tin)]
pub fn tin_of(points: JsValue, segments: &JsValue, options: &JsValue, report: Function) -> Result<JsValue, Thrown> {
    let run = Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() };
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    let indices =
        |name| Ok::<_, Thrown>(property::<Uint32Array>(segments, name)?.map(|list| list.to_vec()).unwrap_or_default());
    let holes = property::<Float64Array>(segments, "holes")?.map(|places| places.to_vec()).unwrap_or_default();
    let fill = get(segments, "fill").as_string().unwrap_or_default();
    let is_split = get(segments, "isSplit").is_truthy();
    let places = holes.as_chunks().0.iter().copied();
    let constraints = constraints_of(&indices("edges")?, &indices("boundary")?, places, &fill, is_split);
    let mut wanted = TinOptions::default();
    wanted.max_error = get(options, "maxError").as_f64().unwrap_or(0.0);
    wanted.max_points = get(options, "maxPoints").as_f64().map(|count| count as usize);
    let found = tin(coordinates.points()?, &constraints, &wanted, &run)?;
    let triangles: Vec<[u32; 3]> = found.triangles().collect();
    let vertices = Float64Array::new_from_slice(found.vertices.as_flattened());
    // Crossings have all digits.
    let is_of_points = found.constrained.added.is_empty();
    let vertices = if is_of_points { coordinates.in_same_precision(vertices) } else { vertices.into() };
    let count = |count: usize| JsValue::from(count as f64);
    Ok(object([
        ("vertices", vertices),
        ("triangles", Uint32Array::new_from_slice(triangles.as_flattened()).into()),
        ("sources", signed(&found.sources).into()),
        ("edges", Uint32Array::new_from_slice(found.constrained.mesh.constraints.as_flattened()).into()),
        ("maxError", found.max_error.into()),
        ("duplicates", count(found.stats.duplicates)),
        ("otherHeights", count(found.stats.other_heights)),
        ("outside", count(found.stats.outside)),
        ("limited", found.stats.limited.into()),
    ]))
}

/// Returns a mesh with what became of its constraints, and that alone. `coordinates` are those of the points that it was made
/// of, *y* up.
fn constrained_mesh(found: Constrained2, mut coordinates: Coordinates) -> (JsValue, JsValue) {
    let inside: Vec<u8> = found.inside.iter().map(|&inside| u8::from(inside)).collect();
    let constraints = object([
        ("edges", Uint32Array::new_from_slice(found.mesh.constraints.as_flattened()).into()),
        ("segments", Uint32Array::new_from_slice(found.segments.as_flattened()).into()),
        ("inside", Uint8Array::new_from_slice(&inside).into()),
        ("regions", Uint32Array::new_from_slice(&found.triangle_regions()).into()),
        ("zeroLength", (found.zero_length as f64).into()),
        ("added", (found.added.len() as f64).into()),
        ("moved", found.moved.into()),
    ]);
    let mesh = mesh2(found.mesh, true);
    set(&mesh, "constraints", constraints.clone());
    if !found.added.is_empty() {
        coordinates.append(Coordinates::F64(found.added.into_flattened()));
        coordinates.flip_y();
        set(&mesh, "points", coordinates.into_js());
    }
    (mesh, constraints)
}

/// Refines a mesh with constraints, in delaunator's orientation. `options` are those of JavaScript, with a number as `size`, or
/// one for each point as `sizes`. The result has the points as well, if some were added.
#[wasm_bindgen]
pub fn refine(points: JsValue, mesh: &JsValue, options: &JsValue) -> Result<JsValue, Thrown> {
    let mut coordinates = Coordinates::new(&points)?;
    drop(points);
    coordinates.flip_y();
    let mut caller = CallerMesh::<3, 1>::new(mesh, "triangles", "halfedges")?;
    let mut found = Constrained2::default();
    found.segments = caller.constraints.segments.take().unwrap_or_default();
    found.inside = inside_of(mesh)?;
    found.mesh = Mesh2::from(caller);
    let number = |name: &str| get(options, name).as_f64();
    let sizes = property::<Float64Array>(options, "sizes")?.map(|sizes| sizes.to_vec());
    let mut wanted = RefineOptions::default();
    wanted.min_angle = number("minAngle").unwrap_or(wanted.min_angle);
    (wanted.max_area, wanted.max_points) = (number("maxArea"), number("maxPoints").map(|count| count as usize));
    wanted.size = match (&sizes, number("size")) {
        (Some(sizes), _) => Size::PerPoint(sizes),
        (None, Some(size)) => Size::Uniform(size),
        (None, None) => Size::Any,
    };
    let refined = found.refine(coordinates.points()?, &wanted)?;
    let (mesh, constraints) = constrained_mesh(refined.constrained, coordinates);
    let count = |count: usize| JsValue::from(count as f64);
    let (stats, left) = (refined.stats, refined.stats.left);
    let refinement = object([
        ("pointsOnSegments", count(stats.points_on_segments)),
        ("pointsInside", count(stats.points_inside)),
        ("minAngle", stats.min_angle.into()),
        ("atInputAngles", count(left.input_angle)),
        ("tooFine", count(left.resolution)),
        ("beyondLimit", count(left.limit)),
        ("tooLarge", count(left.too_large)),
        ("limited", stats.limited.into()),
    ]);
    set(&constraints, "refinement", refinement);
    set(&constraints, "segmentOf", Int32Array::new_from_slice(bytemuck::cast_slice(&refined.segment_of)));
    Ok(mesh)
}

/// What has become of a mesh.
enum Changed {
    /// Its points have moved.
    Moved,
    /// It has these points. If some were dropped, the others had these indices.
    Edited(Coordinates, Option<Vec<u32>>),
}

impl Changed {
    /// Returns it with the mesh.
    fn of(self, mesh: impl FnOnce() -> JsValue) -> JsValue {
        match self {
            Changed::Moved => mesh(),
            Changed::Edited(points, kept) => {
                let mesh = mesh();
                set(&mesh, "points", points.into_js());
                if let Some(kept) = kept {
                    set(&mesh, "kept", Uint32Array::new_from_slice(&kept));
                }
                mesh
            }
        }
    }
}

/// Changes a mesh as its caller wants.
fn changed<const D: usize, const N: usize>(
    mesh: &mut MeshOf<D>,
    points: &JsValue,
    before: &JsValue,
    removed: &JsValue,
    options: &Options,
    compact: fn(&mut MeshOf<D>) -> Vec<u32>,
) -> Result<Changed, Thrown>
where
    Dimension<D>: Edit<D, N>,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    let new = Coordinates::new(points)?;
    if before.is_undefined() {
        let points = new.points::<D>()?;
        let used = Used::of(points, mesh.duplicate_of());
        *mesh = delaunay_of_used(points, used.as_ref(), Restart::NotResident, options)?;
        return Ok(Changed::Moved);
    }
    // The index in an error is that among the new ones.
    new.points::<D>()?.validate()?;
    let mut coordinates = Coordinates::new(before)?;
    let (known, expected) = (coordinates.points::<D>()?.len(), mesh.duplicate_of().len());
    if known != expected {
        return Err(Error::PointCount { points: known, expected }.into());
    }
    let Some(removed) = removed.dyn_ref::<Float64Array>() else {
        let kept = compact(mesh);
        mesh.stats_mut().update = Some(UpdateStats::default());
        return Ok(Changed::Edited(coordinates.select::<D>(&kept), Some(kept)));
    };
    let index = |i: f64| match i as u32 {
        index if f64::from(index) == i => Ok(index),
        _ => Err(error("BAD_INPUT", &format!("{i} is not the index of a point"))),
    };
    let removed: Vec<u32> = removed.to_vec().into_iter().map(index).collect::<Result<_, _>>()?;
    coordinates.append(new);
    let points = coordinates.points::<D>()?;
    if let Some(again) = edit::<D, N>(mesh, points, &removed, options, Dimension::<D>::MAX_SHARE)? {
        *mesh = delaunay_of_used(points, again.used(points).as_ref(), again.why, options)?;
    }
    Ok(Changed::Edited(coordinates, None))
}
