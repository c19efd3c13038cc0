//! 3D meshes.

use gdel::{
    Mesh3,
    stats::{Stats, Trace},
};
use js_sys::{Array, Uint8Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    objects::{object, set, signed},
    run::statistics,
};

/// What to copy out of this module's memory besides the tetrahedra.
#[wasm_bindgen]
#[derive(Clone, Copy)]
pub struct Outputs {
    pub(crate) neighbors: bool,
    pub(crate) hull: bool,
    duplicate_of: bool,
    #[cfg_attr(not(feature = "d3"), expect(dead_code, reason = "the CPU traces nothing"))]
    pub(crate) trace: bool,
    vertex_simplex: bool,
}

#[wasm_bindgen]
impl Outputs {
    #[wasm_bindgen(constructor)]
    pub fn new(neighbors: bool, hull: bool, duplicate_of: bool, trace: bool, vertex_simplex: bool) -> Self {
        Outputs { neighbors, hull, duplicate_of, trace, vertex_simplex }
    }
}

/// Copies a mesh. Each array is freed as soon as it is copied: a mesh is large, and WebAssembly's
/// memory never shrinks.
pub(crate) fn mesh3(mesh: Mesh3, outputs: Outputs) -> JsValue {
    let vertex_simplex = outputs.vertex_simplex.then(|| signed(&mesh.vertex_tetrahedron()));
    let Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension, stats, hidden, weights, .. } = mesh;
    let result = object([("dimension", dimension.into()), ("stats", statistics(&stats))]);
    if let Some(array) = vertex_simplex {
        set(&result, "vertexSimplex", array);
    }
    if !weights.is_empty() {
        set(&result, "hidden", Uint32Array::new_from_slice(&hidden));
    }
    drop((hidden, weights));
    set(&result, "tetrahedra", Uint32Array::new_from_slice(tetrahedra.as_flattened()));
    drop(tetrahedra);
    if outputs.neighbors {
        set(&result, "neighbors", signed(neighbors.as_flattened()));
    }
    drop(neighbors);
    if outputs.hull {
        set(&result, "hull", Uint32Array::new_from_slice(hull.as_flattened()));
    }
    set_extras(&result, &stats, &duplicate_of, outputs);
    result
}

/// Adds what the host has of every mesh.
pub(crate) fn set_extras(result: &JsValue, stats: &Stats, duplicate_of: &[u32], outputs: Outputs) {
    if let Some(trace) = &stats.trace {
        set(result, "trace", self::trace(trace));
    }
    if outputs.duplicate_of {
        set(result, "duplicateOf", signed(duplicate_of));
    }
}

/// Returns the steps in which a mesh came about.
pub(crate) fn trace(trace: &Trace) -> JsValue {
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
