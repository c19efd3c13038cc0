//! Files, verification and synthetic points in 2D. Meshes have delaunator's orientation.

use gdel::{
    Mesh2, MeshView2, NONE,
    internals::{
        d2::generate::{Distribution2, generate2d as generate},
        io::{SurfaceFormat, write_ele, write_neigh, write_node, write_npz, write_vtu},
    },
    verify2d as verify,
};
use js_sys::Float64Array;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    objects::{Thrown, object},
    tools::{
        file, generated,
        mesh::{CallerMesh, points_of_mesh},
        report_object, unknown_format,
    },
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
    let caller = caller_mesh(mesh)?;
    caller.check_vertices(points)?;
    let mut mesh = Mesh2::default();
    mesh.triangles = caller.simplices;
    for [_, b, c] in &mut mesh.triangles {
        std::mem::swap(b, c);
    }
    let reversed = |halfedge: i32| if halfedge == NONE { NONE } else { halfedge / 3 * 3 + 2 - halfedge % 3 };
    mesh.halfedges = caller.neighbors.unwrap_or_default();
    for halfedges in &mut mesh.halfedges {
        halfedges.reverse();
        *halfedges = halfedges.map(reversed);
    }
    let mesh = &mesh;
    match format {
        "vtu" => Ok(object([file("vtu", |to| write_vtu(to, points, mesh))?])),
        "npz" => Ok(object([file("npz", |to| write_npz(to, points, mesh))?])),
        "triangle" => Ok(object([
            file("node", |to| write_node(to, points))?,
            file("ele", |to| write_ele(to, mesh))?,
            file("neigh", |to| write_neigh(to, mesh))?,
        ])),
        _ => {
            let format = SurfaceFormat::from_extension(format).ok_or_else(|| unknown_format(format))?;
            Ok(object([file(format.extensions()[0], |to| format.write(to, points, mesh))?]))
        }
    }
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
    // Delaunator's triangles are counter-clockwise where y points down. Without triangles, `hull` is
    // the collinear points in order, which has no orientation.
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
            ("vertices", counts.vertices),
            ("edges", counts.edges),
            ("triangles", counts.facets),
            ("hullEdges", counts.hull_edges),
        ],
    ))
}
