//! 2D meshes.

use gdel::Mesh2;
use js_sys::Uint32Array;
use wasm_bindgen::JsValue;

use crate::{
    objects::{object, set, signed},
    run::statistics,
};

/// Copies a mesh. Statistics are left out on request.
pub(crate) fn mesh2(mesh: Mesh2, with_statistics: bool) -> JsValue {
    let result = object([
        ("dimension", mesh.dimension.into()),
        ("stats", if with_statistics { statistics(&mesh.stats) } else { JsValue::NULL }),
        ("triangles", Uint32Array::new_from_slice(mesh.triangles.as_flattened()).into()),
        ("halfedges", signed(mesh.halfedges.as_flattened()).into()),
        ("hull", Uint32Array::new_from_slice(&mesh.hull).into()),
        ("duplicateOf", signed(&mesh.duplicate_of).into()),
    ]);
    if !mesh.weights.is_empty() {
        set(&result, "hidden", Uint32Array::new_from_slice(&mesh.hidden));
    }
    result
}
