//! Meshes on the device.

use gdel::{DeviceMesh, Error, stats::Stats};
use js_sys::{Array, Int32Array, Uint32Array};
use wasm_bindgen::JsValue;

use crate::{
    objects::{object, set},
    triangulator::statistics,
};

/// Hands a mesh on the device over. `wrap` makes the object that reads its arrays.
pub(crate) fn hand_over<const D: usize>(mesh: DeviceMesh<D>, wrap: impl FnOnce(DeviceMesh<D>) -> JsValue) -> JsValue {
    let buffers = [mesh.simplices(), mesh.neighbors(), mesh.hull(), mesh.vertex_simplex()];
    let buffers: Array = buffers.into_iter().filter_map(|buffer| buffer.as_webgpu()).collect();
    let counts = Array::of2(&mesh.simplex_count().into(), &mesh.hull_count().into());
    let stats = statistics(mesh.stats());
    let resident = object([
        ("dimension", mesh.dimension().into()),
        ("duplicateOf", Int32Array::new_from_slice(mesh.duplicate_of()).into()),
        ("buffers", buffers.into()),
        ("counts", counts.into()),
        ("mesh", wrap(mesh)),
    ]);
    object([("stats", stats), ("resident", resident)])
}

/// Reads some arrays of a mesh, by their numbers, under these names, straight into memory of
/// JavaScript, and frees the mesh. Returns the object that has them, and the statistics with what
/// that took.
pub(crate) async fn read<const D: usize>(
    mesh: &DeviceMesh<D>,
    arrays: &[(usize, &str)],
) -> Result<(JsValue, Stats), Error> {
    let numbers: Vec<usize> = arrays.iter().map(|&(number, _)| number).collect();
    let (read, stats) = mesh.read_to_js(&numbers).await?;
    mesh.destroy();
    let result = object([("dimension", mesh.dimension().into()), ("stats", statistics(&stats))]);
    for (&(number, name), bytes) in arrays.iter().zip(read) {
        let buffer = bytes.buffer();
        // Neighbours are signed.
        match number {
            1 => set(&result, name, Int32Array::new(&buffer)),
            _ => set(&result, name, Uint32Array::new(&buffer)),
        }
    }
    Ok((result, stats))
}
