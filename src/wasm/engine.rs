//! The engines.

use std::{ops::ControlFlow, sync::Arc};

use js_sys::{Array, Function, Int32Array, Uint32Array};
use send_wrapper::SendWrapper;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use super::{
    objects::{object, set},
    points::Coordinates,
};
use crate::{
    Mesh3, Options, cpu,
    gpu::{AdapterChoice, Gpu},
    hybrid::Hybrid,
    stats::Stats,
};

/// Which arrays of a mesh to copy out of this module's memory, besides the tetrahedra.
#[wasm_bindgen]
#[derive(Clone, Copy)]
pub struct Outputs {
    neighbors: bool,
    hull: bool,
    duplicate_of: bool,
}

#[wasm_bindgen]
impl Outputs {
    #[wasm_bindgen(constructor)]
    pub fn new(neighbors: bool, hull: bool, duplicate_of: bool) -> Self {
        Outputs { neighbors, hull, duplicate_of }
    }
}

/// Triangulates with the CPU engine. `report(phase, fraction)` breaks off by returning true.
#[wasm_bindgen]
pub fn delaunay3d_cpu(points: &JsValue, outputs: Outputs, report: Function) -> Result<JsValue, JsValue> {
    let coordinates = Coordinates::new(points)?;
    Ok(mesh(cpu::delaunay3d(coordinates.points()?, &options(report))?, outputs))
}

/// A device with all kernels compiled.
#[wasm_bindgen]
pub struct GpuEngine {
    hybrid: Hybrid,
}

#[wasm_bindgen]
impl GpuEngine {
    /// Opens the adapter that `navigator.gpu` recommends for speed.
    pub async fn open() -> Result<GpuEngine, JsValue> {
        let gpu = Gpu::open(&AdapterChoice::Default).await?;
        Ok(GpuEngine { hybrid: Hybrid::new(gpu).await? })
    }

    /// Triangulates. `report(phase, fraction)` breaks off by returning true.
    pub async fn delaunay3d(&mut self, points: JsValue, outputs: Outputs, report: Function) -> Result<JsValue, JsValue> {
        let coordinates = Coordinates::new(&points)?;
        drop(points);
        let options = options(report);
        Ok(mesh(self.hybrid.delaunay3d(coordinates.points()?, &options).await?, outputs))
    }

    /// Gives the device back at once, not when the garbage is collected.
    pub fn destroy(self) {
        self.hybrid.gpu().device().destroy();
    }
}

fn options(report: Function) -> Options {
    // Nothing moves to another thread: there is none.
    let report = SendWrapper::new(report);
    let on_progress = move |progress: crate::Progress| {
        let stop = report.call2(&JsValue::NULL, &progress.phase.into(), &progress.fraction.into());
        match stop {
            Ok(stop) if stop.is_falsy() => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    };
    Options { on_progress: Some(Arc::new(on_progress)), ..Options::default() }
}

/// Each array is freed as soon as it is copied: a mesh is large, and this memory never shrinks.
fn mesh(mesh: Mesh3, outputs: Outputs) -> JsValue {
    let Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension, stats } = mesh;
    let result = object([("dimension", dimension.into()), ("stats", self::stats(&stats))]);
    set(&result, "tetrahedra", Uint32Array::new_from_slice(tetrahedra.as_flattened()));
    drop(tetrahedra);
    if outputs.neighbors {
        set(&result, "neighbors", Int32Array::new_from_slice(neighbors.as_flattened()));
    }
    drop(neighbors);
    if outputs.hull {
        set(&result, "hull", Uint32Array::new_from_slice(hull.as_flattened()));
    }
    if outputs.duplicate_of {
        set(&result, "duplicateOf", Int32Array::new_from_slice(&duplicate_of));
    }
    result
}

fn stats(stats: &Stats) -> JsValue {
    let phase =
        |&(name, seconds): &(&str, f64)| object([("name", name.into()), ("milliseconds", (1e3 * seconds).into())]);
    let phases: Array = stats.phases.iter().map(phase).collect();
    let exact = object([
        ("integer", (stats.exact.integer as f64).into()),
        ("expansion", (stats.exact.expansion as f64).into()),
        ("symbolic", (stats.exact.symbolic as f64).into()),
    ]);
    object([
        ("engine", stats.engine.into()),
        ("why", stats.fallback.map_or(JsValue::NULL, JsValue::from)),
        ("phases", phases.into()),
        ("exact", exact),
    ])
}
