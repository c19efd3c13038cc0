//! Files, verification and synthetic points in 2D. Meshes have delaunator's orientation.

use gdel::{
    Constrained2, Mesh2, MeshView2, NONE,
    internals::d2::generate::{Distribution2, generate2d as generate},
    verify2d as verify,
};
use js_sys::{Float64Array, Uint8Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    mesh::{CallerMesh, property},
    objects::{Thrown, error},
    points::points_of_mesh,
    tools::{files, generated, report_object},
};

/// Returns `count` points of a distribution, interleaved.
#[wasm_bindgen]
pub fn generate2d(kind: &str, count: u32, seed: u64) -> Result<Float64Array, Thrown> {
    generated(&Distribution2::ALL, Distribution2::name, generate, kind, count, seed)
}

fn caller_mesh(mesh: &JsValue) -> Result<CallerMesh<3, 1>, Thrown> {
    CallerMesh::new(mesh, "triangles", "halfedges")
}

/// Returns a mesh as files of a format: `{ extension: bytes }`, several for Triangle.
#[wasm_bindgen]
pub fn write2d(points: &JsValue, mesh: &JsValue, format: &str) -> Result<JsValue, Thrown> {
    let coordinates = points_of_mesh::<2>(points)?;
    let points = coordinates.points::<2>()?;
    let mut caller = caller_mesh(mesh)?;
    caller.check_vertices(points)?;
    let (weights, hidden) = caller.take_weights(points.len())?;
    let inside = property::<Uint8Array>(mesh, "inside")?;
    if let Some(inside) = &inside
        && (caller.simplices.len() != inside.length() as usize || caller.neighbors.is_none())
    {
        return Err(error("BAD_INPUT", "inside does not have one entry per triangle").into());
    }
    let mut mesh = Mesh2::from(caller);
    (mesh.weights, mesh.hidden) = (weights, hidden);
    if let Some(inside) = inside {
        let mut found = Constrained2::default();
        found.inside = inside.to_vec().into_iter().map(|inside| inside != 0).collect();
        found.mesh = mesh;
        mesh = found.inside_mesh();
    }
    for [_, b, c] in &mut mesh.triangles {
        std::mem::swap(b, c);
    }
    let reversed = |halfedge: u32| if halfedge == NONE { NONE } else { halfedge / 3 * 3 + 2 - halfedge % 3 };
    for halfedges in &mut mesh.halfedges {
        halfedges.reverse();
        *halfedges = halfedges.map(reversed);
    }
    files(points, &mesh, format, "triangle")
}

/// Returns what the verifier finds.
#[wasm_bindgen]
pub fn verify2d(points: &JsValue, mesh: &JsValue) -> Result<JsValue, Thrown> {
    let mut coordinates = points_of_mesh::<2>(points)?;
    let mesh = caller_mesh(mesh)?;
    let mut view = MeshView2::of_triangles(&mesh.simplices);
    view.halfedges = mesh.neighbors.as_deref();
    view.hull = mesh.hull.as_ref().map(|hull| hull.as_flattened());
    view.duplicate_of = mesh.duplicate_of.as_deref();
    view.dimension = mesh.dimension;
    view.weights = mesh.weights.as_deref();
    view.hidden = mesh.hidden.as_deref();
    view.constraints = Some(&mesh.constraints.edges);
    view.segments = mesh.constraints.segments.as_deref();
    // Delaunator's triangles are counter-clockwise where y points down. Without triangles, `hull`
    // is the collinear points in order, which has no orientation.
    if !mesh.simplices.is_empty() {
        coordinates.flip_y();
    }
    let report = verify(coordinates.points::<2>()?, view)?;
    let counts = report.counts;
    Ok(report_object(
        &report,
        [
            ("points", counts.points),
            ("distinctPoints", counts.distinct_points),
            ("unusedPoints", counts.unused_points),
            ("vertices", counts.vertices),
            ("edges", counts.edges),
            ("triangles", counts.facets),
            ("hullEdges", counts.hull_edges),
        ],
    ))
}
