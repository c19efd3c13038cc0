//! The engines of space.

use js_sys::{Array, Function, Int32Array, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::wasm::{
    objects::{object, set},
    points::Coordinates,
    run::{self, for_run},
};
use crate::{Mesh3, Triangulator, stats::Trace, triangulator::MIN_POINTS};

/// What to copy out of this module's memory, besides the tetrahedra.
#[wasm_bindgen]
#[derive(Clone, Copy)]
pub struct Outputs {
    neighbors: bool,
    hull: bool,
    duplicate_of: bool,
    trace: bool,
}

#[wasm_bindgen]
impl Outputs {
    #[wasm_bindgen(constructor)]
    pub fn new(neighbors: bool, hull: bool, duplicate_of: bool, trace: bool) -> Self {
        Outputs { neighbors, hull, duplicate_of, trace }
    }
}

/// The number of points from which on the engine `auto` thinks of the GPU.
#[wasm_bindgen]
pub fn least_gpu_points() -> u32 {
    MIN_POINTS as u32
}

/// Both engines, for any number of runs.
#[wasm_bindgen]
#[derive(Default)]
pub struct WasmEngines {
    engines: Triangulator,
}

#[wasm_bindgen]
impl WasmEngines {
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        WasmEngines::default()
    }

    /// Opens the adapter that `navigator.gpu` recommends for speed, and compiles the kernels.
    pub async fn open(&self) -> Result<(), JsValue> {
        self.engines.gpu().await?;
        Ok(())
    }

    /// Gives the device back.
    pub async fn close(&self) {
        self.engines.close().await;
    }

    /// Triangulates with the engine `auto`, `gpu` or `cpu`. `report(phase, fraction)` breaks off by returning true.
    pub async fn delaunay3d(
        &self,
        points: JsValue,
        engine: &str,
        outputs: Outputs,
        report: Function,
    ) -> Result<JsValue, JsValue> {
        let coordinates = Coordinates::new(&points)?;
        drop(points);
        let triangulator = for_run(&self.engines, engine, report).trace(outputs.trace);
        Ok(mesh3(triangulator.delaunay3d_async(coordinates.points()?).await?, outputs))
    }
}

/// Each array is freed as soon as it is copied: a mesh is large, and this memory never shrinks.
fn mesh3(mesh: Mesh3, outputs: Outputs) -> JsValue {
    let Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension, stats, .. } = mesh;
    let result = object([("dimension", dimension.into()), ("stats", run::stats(&stats))]);
    set(&result, "tetrahedra", Uint32Array::new_from_slice(tetrahedra.as_flattened()));
    drop(tetrahedra);
    if outputs.neighbors {
        set(&result, "neighbors", Int32Array::new_from_slice(neighbors.as_flattened()));
    }
    drop(neighbors);
    if outputs.hull {
        set(&result, "hull", Uint32Array::new_from_slice(hull.as_flattened()));
    }
    if let Some(trace) = &stats.trace {
        set(&result, "trace", self::trace(trace));
    }
    if outputs.duplicate_of {
        set(&result, "duplicateOf", Int32Array::new_from_slice(&duplicate_of));
    }
    result
}

fn trace(trace: &Trace) -> JsValue {
    let round =
        |round: &Vec<[u32; 4]>| object([("tetrahedra", Uint32Array::new_from_slice(round.as_flattened()).into())]);
    let rounds: Array = trace.rounds.iter().map(round).collect();
    let facets = Uint32Array::new_from_slice(trace.not_locally_delaunay.as_flattened());
    let created: Vec<u8> = trace.splayed.iter().map(|&splayed| u8::from(splayed)).collect();
    object([
        ("rounds", rounds.into()),
        ("nonDelaunayFacets", facets.into()),
        ("created", Uint8Array::new_from_slice(&created).into()),
    ])
}
