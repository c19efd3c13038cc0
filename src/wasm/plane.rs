//! The engines of the plane.

use js_sys::{Function, Int32Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::wasm::{
    objects::object,
    points::Coordinates,
    run::{options, stats},
};
use crate::{Backend, Mesh2, Options, Triangulator, triangulator::MIN_POINTS_2};

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
        let options = options(engine, false, report);
        Ok(mesh2(self.engines.delaunay2d(coordinates.points()?, &options).await?))
    }
}

/// Triangulates with the CPU engine before it returns.
#[wasm_bindgen]
pub fn delaunay2d_at_once(points: JsValue) -> Result<JsValue, JsValue> {
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    let options = Options { backend: Backend::Cpu, ..Options::default() };
    Ok(mesh2(crate::delaunay2d(coordinates.points()?, &options)?))
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
