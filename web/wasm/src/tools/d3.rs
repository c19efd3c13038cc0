//! Files, verification and synthetic points in 3D.

use gdel::{
    Mesh3, MeshView3,
    internals::d3::generate::{Distribution3, generate3d as generate},
    verify3d as verify,
};
use js_sys::Float64Array;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    mesh::CallerMesh,
    objects::Thrown,
    points::points_of_mesh,
    tools::{files, generated, report_object},
};

/// Returns `count` points of a distribution, interleaved.
#[wasm_bindgen]
pub fn generate3d(kind: &str, count: u32, seed: u64) -> Result<Float64Array, Thrown> {
    generated(&Distribution3::ALL, Distribution3::name, generate, kind, count, seed)
}

fn caller_mesh(mesh: &JsValue) -> Result<CallerMesh<4, 3>, Thrown> {
    CallerMesh::new(mesh, "tetrahedra", "neighbors")
}

/// Returns a mesh or its hull as files of a format: `{ extension: bytes }`, several for TetGen.
#[wasm_bindgen]
pub fn write3d(points: &JsValue, mesh: &JsValue, format: &str) -> Result<JsValue, Thrown> {
    let coordinates = points_of_mesh::<3>(points)?;
    let points = coordinates.points::<3>()?;
    let mut caller = caller_mesh(mesh)?;
    caller.check_vertices(points)?;
    let (weights, hidden) = caller.take_weights(points.len())?;
    let mut mesh = Mesh3::from(caller);
    (mesh.weights, mesh.hidden) = (weights, hidden);
    files(points, &mesh, format, "tetgen")
}

/// Returns what the verifier finds.
#[wasm_bindgen]
pub fn verify3d(points: &JsValue, mesh: &JsValue) -> Result<JsValue, Thrown> {
    let coordinates = points_of_mesh::<3>(points)?;
    let mesh = caller_mesh(mesh)?;
    let mut view = MeshView3::of_tetrahedra(&mesh.simplices);
    view.neighbors = mesh.neighbors.as_deref();
    view.hull = mesh.hull.as_deref();
    view.duplicate_of = mesh.duplicate_of.as_deref();
    view.dimension = mesh.dimension;
    view.weights = mesh.weights.as_deref();
    view.hidden = mesh.hidden.as_deref();
    let report = verify(coordinates.points::<3>()?, view)?;
    let counts = report.counts;
    Ok(report_object(
        &report,
        [
            ("points", counts.points),
            ("distinctPoints", counts.distinct_points),
            ("unusedPoints", counts.unused_points),
            ("vertices", counts.vertices),
            ("edges", counts.edges),
            ("facets", counts.facets),
            ("tetrahedra", counts.tetrahedra),
            ("hullTriangles", counts.hull_triangles),
        ],
    ))
}
