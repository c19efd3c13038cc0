//! Weights with which cells have given volumes, and the cells of weights in a polygon.

use crate::{
    clips::{clip_of, corners_of, numbers_of},
    objects::{Thrown, get, object},
    points::points_of_mesh,
    run::reporting,
};
use gdel::{
    Clip, Mesh2, Mesh3, TransportOptions, Voronoi,
    internals::{
        Options,
        cpu::{Incremental, MeshOf, regular},
        derived::{VoronoiShapes, sites_by_halves, transport as find},
        dimension::Dimension,
        geometry::Euclidean,
    },
};
use js_sys::{Float64Array, Function, Uint32Array};
use std::sync::Arc;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

/// Returns the weights with which the cells of points, clipped as for `voronoi`, have the masses, or equal volumes if
/// there are none.
#[wasm_bindgen]
pub fn transport(
    dimension: u32,
    points: &JsValue,
    clip: &str,
    bounds: &Float64Array,
    masses: Option<Vec<f64>>,
    options: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown> {
    match dimension {
        2 => transport_in::<Mesh2, 2, 3>(points, (clip, bounds), masses.as_deref(), options, report),
        _ => transport_in::<Mesh3, 3, 4>(points, (clip, bounds), masses.as_deref(), options, report),
    }
}

fn transport_in<M: gdel::Mesh<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    (clip, bounds): (&str, &Float64Array),
    masses: Option<&[f64]>,
    given: &JsValue,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Dimension<D>: Incremental<D, Mesh = M>,
    MeshOf<D>: gdel::Mesh<D, N>,
    Euclidean: VoronoiShapes<D, N>,
{
    let mut points = points_of_mesh::<D>(points)?;
    if D == 2 {
        points.flip_y();
    }
    let points = points.points::<D>()?;
    let mut options = TransportOptions::default();
    options.masses = masses;
    options.normalize = get(given, "normalize").is_truthy();
    options.tolerance = get(given, "tolerance").as_f64().unwrap_or(options.tolerance);
    let run = Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() };
    let corners = corners_of::<D>(bounds)?;
    let found = find(points, clip_of(clip, &corners, points), &options, &run)?;
    Ok(object([
        ("weights", Float64Array::new_from_slice(&found.weights).into()),
        ("volumes", Float64Array::new_from_slice(&found.volumes).into()),
        ("error", found.error.into()),
        ("steps", (found.steps as f64).into()),
    ]))
}

/// Returns the corners of the convex hull of points in the plane, in the orientation of the triangles of 2D meshes; none
/// if that has no inside.
#[wasm_bindgen(js_name = hullOf)]
pub fn hull_of(points: &JsValue) -> Result<Vec<f64>, Thrown> {
    let mut points = points_of_mesh::<2>(points)?;
    points.flip_y();
    let points = points.points::<2>()?;
    let mesh = regular::<2>(points, &vec![0.0; points.len()], &Options::default())?;
    let corners: &[u32] = if mesh.triangles.is_empty() { &[] } else { mesh.hull.as_slice() };
    Ok(corners.iter().map(|&v| points.get(v as usize)).flat_map(|[x, y]| [x, -y]).collect())
}

/// Returns a site for each mass in the convex polygon with these corners: see [`sites_by_halves`].
#[wasm_bindgen(js_name = sitesByHalves)]
pub fn sites_in_polygon(corners: &Float64Array, masses: &[f64]) -> Result<Vec<f64>, Thrown> {
    let corners = numbers_of(corners)?;
    let corners: Vec<[f64; 2]> = corners.chunks_exact(2).map(|corner| [corner[0], corner[1]]).collect();
    Ok(sites_by_halves(&corners, masses).into_flattened())
}

/// Returns the power diagram of weighted points in the plane, within the convex polygon with these corners: the corners
/// of all cells, where those of each begin, areas and centres of mass. The corners are in the orientation of the
/// triangles of 2D meshes.
#[wasm_bindgen(js_name = powerCells)]
pub fn power_cells(points: &JsValue, weights: &[f64], corners: &Float64Array) -> Result<JsValue, Thrown> {
    let mut points = points_of_mesh::<2>(points)?;
    points.flip_y();
    let points = points.points::<2>()?;
    let mesh = regular::<2>(points, weights, &Options::default())?;
    let corners = corners_of::<2>(corners)?;
    let voronoi = Voronoi::new(&mesh, points, Clip::Convex(&corners))?;
    let cells = voronoi.map_cells(|_, cell| {
        // Each edge begins where the one before ends.
        let ends = (0..cell.facets.len()).map(|f| cell.vertices[cell.facets.of(f as u32)[0] as usize]);
        let mut outline: Vec<[f64; 2]> = ends.collect();
        outline.dedup();
        if outline.len() > 1 && outline.first() == outline.last() {
            outline.pop();
        }
        (outline, cell.volume, cell.centroid)
    });
    let (mut offsets, mut outlines, mut centroids) = (vec![0], Vec::new(), Vec::new());
    for (outline, _, [x, y]) in &cells {
        outlines.extend(outline.iter().flat_map(|&[x, y]| [x, -y]));
        offsets.push(outlines.len() as u32 / 2);
        centroids.extend([*x, -y]);
    }
    let areas: Vec<f64> = cells.iter().map(|&(_, area, _)| area).collect();
    Ok(object([
        ("offsets", Uint32Array::new_from_slice(&offsets).into()),
        ("outlines", Float64Array::new_from_slice(&outlines).into()),
        ("areas", Float64Array::new_from_slice(&areas).into()),
        ("centroids", Float64Array::new_from_slice(&centroids).into()),
    ]))
}
