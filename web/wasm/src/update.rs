//! Meshes in the memory of the CPU whose points move.

use gdel::{
    Mesh2, Mesh3,
    internals::{
        Options, Winding,
        cpu::update::{Limits, update},
    },
    stats::UpdateStats,
};
use js_sys::Function;
use std::sync::Arc;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    arrays::{
        d2::mesh2,
        d3::{Outputs, mesh3},
    },
    mesh::CallerMesh,
    objects::{Thrown, object},
    points::Coordinates,
    run::{reporting, statistics},
};

/// Returns the 3D mesh of points, given the one of the points where they were. If these have to be
/// triangulated from scratch, the result has only the statistics of the attempt, as `update`.
#[wasm_bindgen]
pub fn update3d(points: JsValue, moved: JsValue, outputs: Outputs, report: Function) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    let before = Mesh3::from(CallerMesh::new(&moved, "tetrahedra", "neighbors")?);
    let (mesh, stats) = update::<3>(&before, coordinates.points()?, &options(report), Limits::measured(3))?;
    drop(before);
    Ok(mesh.map_or_else(|| restarted(&stats), |mesh| mesh3(mesh, outputs)))
}

/// Does the same in 2D, in delaunator's orientation.
#[wasm_bindgen]
pub fn update2d(points: JsValue, moved: JsValue, report: Function) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    let before = Mesh2::from(CallerMesh::new(&moved, "triangles", "halfedges")?);
    let options = Options { winding: Winding::Clockwise, ..options(report) };
    let (mesh, stats) = update::<2>(&before, coordinates.points()?, &options, Limits::measured(2))?;
    drop(before);
    Ok(mesh.map_or_else(|| restarted(&stats), |mesh| mesh2(mesh, true)))
}

fn options(report: Function) -> Options {
    Options { on_progress: Some(Arc::new(reporting(report))), ..Options::default() }
}

fn restarted(stats: &UpdateStats) -> JsValue {
    object([("update", statistics(stats))])
}
