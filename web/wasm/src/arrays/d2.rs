//! 2D meshes.

use gdel::Mesh2;
use js_sys::{Int32Array, Uint32Array};
use wasm_bindgen::JsValue;

use crate::{objects::object, run::statistics};

/// Copies a mesh. Statistics are left out on request.
pub(crate) fn mesh2(mesh: Mesh2, with_statistics: bool) -> JsValue {
    object([
        ("dimension", mesh.dimension.into()),
        ("stats", if with_statistics { statistics(&mesh.stats) } else { JsValue::NULL }),
        ("triangles", Uint32Array::new_from_slice(mesh.triangles.as_flattened()).into()),
        ("halfedges", Int32Array::new_from_slice(mesh.halfedges.as_flattened()).into()),
        ("hull", Uint32Array::new_from_slice(&mesh.hull).into()),
        ("duplicateOf", Int32Array::new_from_slice(&mesh.duplicate_of).into()),
    ])
}
