//! The engines of the plane.

use js_sys::{Function, Int32Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::wasm::{
    objects::object,
    points::Coordinates,
    run::{for_run, stats},
};
use crate::{Backend, Mesh2, Triangulator, options::Winding, triangulator::MIN_POINTS_2};

/// The number of points from which on the engine `auto` thinks of the GPU.
#[wasm_bindgen]
pub fn least_gpu_points() -> u32 {
    MIN_POINTS_2 as u32
}

/// Both engines, for any number of runs.
#[wasm_bindgen]
#[derive(Default)]
pub struct PlaneEngines {
    engines: Triangulator,
}

#[wasm_bindgen]
impl PlaneEngines {
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        PlaneEngines::default()
    }

    /// Gives the device back.
    pub async fn close(&self) {
        self.engines.close().await;
    }

    /// Triangulates with the engine `auto`, `gpu` or `cpu`. `report(phase, fraction)` breaks off by returning true.
    pub async fn delaunay2d(&self, points: JsValue, engine: &str, report: Function) -> Result<JsValue, JsValue> {
        let coordinates = Coordinates::new(&points)?;
        drop(points);
        // Delaunator's orientation.
        let triangulator = for_run(&self.engines, engine, report).winding(Winding::Clockwise);
        Ok(mesh2(triangulator.delaunay2d_async(coordinates.points()?).await?))
    }
}

/// Triangulates with the CPU engine before it returns.
#[wasm_bindgen]
pub fn delaunay2d_at_once(points: JsValue) -> Result<JsValue, JsValue> {
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    let triangulator = Triangulator::new().backend(Backend::Cpu).winding(Winding::Clockwise);
    Ok(mesh2(triangulator.delaunay2d(coordinates.points()?)?))
}

fn mesh2(mesh: Mesh2) -> JsValue {
    object([
        ("dimension", mesh.dimension.into()),
        ("stats", stats(&mesh.stats)),
        ("triangles", Uint32Array::new_from_slice(mesh.triangles.as_flattened()).into()),
        ("halfedges", Int32Array::new_from_slice(mesh.halfedges.as_flattened()).into()),
        ("hull", Uint32Array::new_from_slice(&mesh.hull).into()),
        ("duplicateOf", Int32Array::new_from_slice(&mesh.duplicate_of).into()),
    ])
}
