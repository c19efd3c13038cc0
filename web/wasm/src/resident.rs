//! Meshes on the device.

use gdel::{DeviceMesh, Error, stats::Stats};
use js_sys::{Array, Function, Int32Array, Uint8Array, Uint32Array};
use wasm_bindgen::{JsCast, JsValue};

use crate::{
    objects::{Thrown, object, set, signed},
    run::statistics,
};

/// Hands a mesh on the device over. `wrap` makes the object that reads its arrays.
pub(crate) fn hand_over<const D: usize>(mesh: DeviceMesh<D>, wrap: impl FnOnce(DeviceMesh<D>) -> JsValue) -> JsValue {
    let buffers = [mesh.simplices(), mesh.neighbors(), mesh.hull(), mesh.vertex_simplex()];
    let buffers: Array = buffers.into_iter().filter_map(|buffer| buffer.as_webgpu()).collect();
    let counts = Array::of2(&mesh.simplex_count().into(), &mesh.hull_count().into());
    let stats = statistics(mesh.stats());
    let resident = object([
        ("dimension", mesh.dimension().into()),
        ("duplicateOf", signed(mesh.duplicate_of()).into()),
        ("buffers", buffers.into()),
        ("counts", counts.into()),
        ("mesh", wrap(mesh)),
    ]);
    object([("stats", stats), ("resident", resident)])
}

/// Returns memory for a number of bytes from a function of JavaScript, if it does not throw.
fn from(memory: &Function) -> impl Fn(u32) -> Option<Uint8Array> {
    |bytes| Some(memory.call1(&JsValue::NULL, &bytes.into()).ok()?.unchecked_into())
}

/// Reads an array of a mesh, by its number, into what `memory` returns for its bytes. Returns these.
pub(crate) async fn read_one<const D: usize>(
    mesh: &DeviceMesh<D>,
    array: usize,
    memory: &Function,
) -> Result<JsValue, Thrown> {
    Ok(mesh.read_to_js(&[array], from(memory)).await?.0.swap_remove(0).into())
}

/// Reads some arrays of a mesh, by their numbers, under these names, straight into what `memory`
/// returns for their bytes, and frees the mesh. Returns the object that has them, and the statistics
/// with what that took.
pub(crate) async fn read<const D: usize>(
    mesh: &DeviceMesh<D>,
    arrays: &[(usize, &str)],
    memory: &Function,
) -> Result<(JsValue, Stats), Error> {
    let numbers: Vec<usize> = arrays.iter().map(|&(number, _)| number).collect();
    let (read, stats) = mesh.read_to_js(&numbers, from(memory)).await?;
    mesh.destroy();
    let result = object([("dimension", mesh.dimension().into()), ("stats", statistics(&stats))]);
    for (&(number, name), bytes) in arrays.iter().zip(read) {
        let (buffer, start, length) = (bytes.buffer(), bytes.byte_offset(), bytes.length() / 4);
        // Neighbours are signed.
        match number {
            1 => set(&result, name, Int32Array::new_with_byte_offset_and_length(&buffer, start, length)),
            _ => set(&result, name, Uint32Array::new_with_byte_offset_and_length(&buffer, start, length)),
        }
    }
    Ok((result, stats))
}
