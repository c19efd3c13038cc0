//! 3D triangulation.

use gdel::{
    Backend, DeviceMesh3, Error, Mesh3, Triangulator,
    internals::{gpu::engine::Made, triangulator::MIN_POINTS_3D},
    stats::{Stats, Trace},
};
use js_sys::{Array, Function, Int32Array, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    objects::{Thrown, object, set},
    points::Coordinates,
    resident,
    triangulator::{WasmTriangulator, statistics},
};

/// What to copy out of this module's memory besides the tetrahedra.
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

/// Returns the number of points from which on the backend `auto` considers the GPU in 3D.
#[wasm_bindgen]
pub fn min_gpu_points_3d() -> u32 {
    MIN_POINTS_3D as u32
}

#[wasm_bindgen]
impl WasmTriangulator {
    /// Opens the adapter that `navigator.gpu` recommends for speed, and compiles the kernels for
    /// 3D.
    pub async fn open(&self) -> Result<(), Thrown> {
        self.triangulator.gpu().await?;
        Ok(())
    }

    /// Triangulates in 3D. With `on_device`, the mesh stays on the device, and `outputs` has no
    /// meaning.
    pub async fn delaunay3d(
        &self,
        points: JsValue,
        backend: &str,
        outputs: Outputs,
        on_device: bool,
        report: Function,
    ) -> Result<JsValue, Thrown> {
        let coordinates = Coordinates::new(&points)?;
        drop(points);
        let triangulator = self.for_run(backend, report).trace(outputs.trace);
        let deliver = async |mesh: Made<3>| match mesh {
            Made::Host(mesh) => Ok(mesh3(mesh, outputs)),
            Made::Device(mesh) if on_device => Ok(resident::hand_over(*mesh, |mesh| WasmMesh3(mesh).into())),
            Made::Device(mesh) => read3(&mesh, outputs).await,
        };
        Ok(triangulator.deliver3d(coordinates.points()?, on_device, deliver).await?)
    }
}

/// A mesh on the device.
#[wasm_bindgen]
pub struct WasmMesh3(DeviceMesh3);

#[wasm_bindgen]
impl WasmMesh3 {
    /// Returns the bytes of an array: the tetrahedra, their neighbours, the hull, or a tetrahedron
    /// of each point, by these numbers.
    pub async fn read(&self, array: usize) -> Result<JsValue, Thrown> {
        Ok(self.0.read_to_js(&[array]).await?.0.swap_remove(0).into())
    }
}

/// Triangulates in 3D with the CPU backend, without returning to the event loop.
#[wasm_bindgen]
pub fn delaunay3d_blocking(points: JsValue, outputs: Outputs) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    let triangulator = Triangulator::new().backend(Backend::Cpu);
    Ok(mesh3(triangulator.delaunay3d(coordinates.points()?)?, outputs))
}

/// Copies a mesh from the device.
async fn read3(mesh: &DeviceMesh3, outputs: Outputs) -> Result<JsValue, Error> {
    let arrays = [(0, "tetrahedra", true), (1, "neighbors", outputs.neighbors), (2, "hull", outputs.hull)];
    let wanted: Vec<(usize, &str)> =
        arrays.into_iter().filter(|&(.., wanted)| wanted).map(|(number, name, _)| (number, name)).collect();
    let (result, stats) = resident::read(mesh, &wanted).await?;
    set_extras(&result, &stats, mesh.duplicate_of(), outputs);
    Ok(result)
}

/// Copies a mesh. Each array is freed as soon as it is copied: a mesh is large, and WebAssembly's
/// memory never shrinks.
fn mesh3(mesh: Mesh3, outputs: Outputs) -> JsValue {
    let Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension, stats, .. } = mesh;
    let result = object([("dimension", dimension.into()), ("stats", statistics(&stats))]);
    set(&result, "tetrahedra", Uint32Array::new_from_slice(tetrahedra.as_flattened()));
    drop(tetrahedra);
    if outputs.neighbors {
        set(&result, "neighbors", Int32Array::new_from_slice(neighbors.as_flattened()));
    }
    drop(neighbors);
    if outputs.hull {
        set(&result, "hull", Uint32Array::new_from_slice(hull.as_flattened()));
    }
    set_extras(&result, &stats, &duplicate_of, outputs);
    result
}

/// Adds what the host has of every mesh.
fn set_extras(result: &JsValue, stats: &Stats, duplicate_of: &[i32], outputs: Outputs) {
    if let Some(trace) = &stats.trace {
        set(result, "trace", self::trace(trace));
    }
    if outputs.duplicate_of {
        set(result, "duplicateOf", Int32Array::new_from_slice(duplicate_of));
    }
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
