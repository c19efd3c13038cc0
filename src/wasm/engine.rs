//! The engines.

use std::{ops::ControlFlow, sync::Arc};

use js_sys::{Array, Function, Int32Array, Uint8Array, Uint32Array};
use send_wrapper::SendWrapper;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use super::{
    objects::{object, set},
    points::Coordinates,
};
use crate::{
    Engine, Engines, Mesh2, Mesh3, Options, Progress,
    engines::LEAST_POINTS,
    options::OnProgress,
    splay::SplayStats,
    stats::{GpuStats, Round, Stats, Trace},
};

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
    LEAST_POINTS as u32
}

/// Both engines, for any number of runs.
#[wasm_bindgen]
#[derive(Default)]
pub struct WasmEngines {
    engines: Engines,
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
        let options = options(engine, outputs.trace, report);
        Ok(mesh3(self.engines.delaunay3d(coordinates.points()?, &options).await?, outputs))
    }

    /// The same in the plane, where all outputs but a trace are given.
    pub async fn delaunay2d(&self, points: JsValue, engine: &str, report: Function) -> Result<JsValue, JsValue> {
        let coordinates = Coordinates::new(&points)?;
        drop(points);
        let options = options(engine, false, report);
        Ok(mesh2(self.engines.delaunay2d(coordinates.points()?, &options).await?))
    }
}

fn options(engine: &str, trace: bool, report: Function) -> Options {
    let engine = match engine {
        "gpu" => Engine::Gpu,
        "cpu" => Engine::Cpu,
        _ => Engine::Auto,
    };
    Options { engine, on_progress: Some(on_progress(report)), trace }
}

fn on_progress(report: Function) -> OnProgress {
    // Nothing moves to another thread: there is none.
    let report = SendWrapper::new(report);
    Arc::new(move |progress: Progress| {
        let stop = report.call2(&JsValue::NULL, &progress.phase.into(), &progress.fraction.into());
        match stop {
            Ok(stop) if stop.is_falsy() => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    })
}

/// Each array is freed as soon as it is copied: a mesh is large, and this memory never shrinks.
fn mesh3(mesh: Mesh3, outputs: Outputs) -> JsValue {
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
    if let Some(trace) = &stats.trace {
        set(&result, "trace", self::trace(trace));
    }
    if outputs.duplicate_of {
        set(&result, "duplicateOf", Int32Array::new_from_slice(&duplicate_of));
    }
    result
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

fn stats(stats: &Stats) -> JsValue {
    let phase =
        |&(name, seconds): &(&str, f64)| object([("name", name.into()), ("milliseconds", (1e3 * seconds).into())]);
    let phases: Array = stats.phases.iter().map(phase).collect();
    let fallback = stats.fallback.as_ref().map(|why| JsValue::from(why.to_string()));
    object([
        ("engine", stats.engine.into()),
        ("why", fallback.unwrap_or(JsValue::NULL)),
        ("phases", phases.into()),
        (
            "exact",
            object([
                ("integer", number(stats.exact.integer)),
                ("expansion", number(stats.exact.expansion)),
                ("symbolic", number(stats.exact.symbolic)),
            ]),
        ),
        ("gpu", stats.gpu.as_ref().map_or(JsValue::NULL, gpu_stats)),
        ("splay", stats.splay.as_ref().map_or(JsValue::NULL, splay_stats)),
    ])
}

fn gpu_stats(stats: &GpuStats) -> JsValue {
    let round = |round: &Round| {
        object([
            ("inserted", round.inserted.into()),
            ("active", round.active.into()),
            ("flips", round.flips.into()),
            ("iterations", round.iterations.into()),
            ("milliseconds", round.milliseconds.into()),
        ])
    };
    let rounds: Array = stats.rounds.iter().map(round).collect();
    object([
        ("rounds", rounds.into()),
        ("flips23", number(stats.flips_23)),
        ("flips32", number(stats.flips_32)),
        ("flipIterations", number(stats.flip_iterations)),
        ("exactTests", number(stats.exact_tests)),
        ("notLocallyDelaunay", number(stats.not_locally_delaunay)),
        ("failedVertices", number(stats.failed_vertices)),
        ("united", number(stats.united)),
        ("readbacks", number(stats.readbacks)),
        ("dispatches", number(stats.dispatches)),
        ("submits", number(stats.submits)),
        ("bytes", number(stats.bytes)),
    ])
}

fn splay_stats(stats: &SplayStats) -> JsValue {
    let count = |n: usize| number(n as u64);
    object([
        ("peeled", count(stats.peeled)),
        ("failed", count(stats.failed)),
        ("built", count(stats.built)),
        ("fromPoints", count(stats.from_points)),
        ("pulled", count(stats.pulled)),
        ("flips", count(stats.flips)),
        ("insertions", count(stats.insertions)),
        ("checks", count(stats.checks)),
        ("removed", count(stats.removed)),
        ("added", count(stats.added)),
        ("inserted", count(stats.inserted)),
        ("signs", number(stats.signs)),
    ])
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

/// Counts as JavaScript has them: exact up to 2⁵³.
fn number(count: u64) -> JsValue {
    (count as f64).into()
}
