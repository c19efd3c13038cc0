//! Weights with which cells have given volumes.

use crate::{
    clips::{clip_of, corners_of},
    objects::{Thrown, get, object},
    points::points_of_mesh,
    run::reporting,
};
use gdel::{
    Mesh2, Mesh3, TransportOptions,
    internals::{
        Options,
        cpu::{Incremental, MeshOf},
        derived::{VoronoiShapes, transport as find},
        dimension::Dimension,
        geometry::Euclidean,
    },
};
use js_sys::{Float64Array, Function};
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
