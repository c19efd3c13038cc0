//! The alpha complex of balls. It is in the module for weights, which few pages load: it would make what every other answer
//! loads 8 % larger.

use crate::{
    clips::numbers_of,
    objects::{Thrown, object, signed},
    task::{OfCaller, Task, in_dimension},
};
use gdel::{
    BallComplex, FaceClass, Mesh2, Mesh3,
    internals::{
        derived::singular,
        geometry::{Euclidean, Geometry},
    },
};
use js_sys::{Float64Array, Function, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

/// Returns the alpha complex of balls: all its faces, those that belong to nothing larger, and its components. No weights
/// are zeros.
#[wasm_bindgen(js_name = ballComplex)]
pub fn ball_complex(
    dimension: u32,
    points: &JsValue,
    mesh: &JsValue,
    weights: &Float64Array,
    alpha: f64,
    report: Function,
) -> Result<JsValue, Thrown> {
    in_dimension!(dimension, ball_complex_in(points, mesh, weights, alpha, report))
}

fn ball_complex_in<M: OfCaller<D, N>, const D: usize, const N: usize>(
    points: &JsValue,
    mesh: &JsValue,
    weights: &Float64Array,
    alpha: f64,
    report: Function,
) -> Result<JsValue, Thrown>
where
    Euclidean: Geometry<D, N>,
{
    let task = Task::<M>::new::<D, N>(points, mesh, report, "alpha")?;
    let weights = numbers_of(weights)?;
    let complex = BallComplex::new(&task.mesh, task.points.points::<D>()?, &weights, alpha)?;
    task.report(0.9)?;
    let solid: Vec<u32> = complex.solid().map(|t| t as u32).collect();
    let [facets, singular_facets] = parts(complex.facets());
    let [edges, singular_edges] = parts(complex.edges());
    let [vertices, singular_vertices] = parts(complex.vertices());
    let (labels, count) = complex.components();
    Ok(object([
        ("alpha", alpha.into()),
        ("solid", Uint32Array::new_from_slice(&solid).into()),
        ("surface", Uint32Array::new_from_slice(complex.surface().as_flattened()).into()),
        ("facets", Uint32Array::new_from_slice(facets.as_flattened()).into()),
        ("edges", Uint32Array::new_from_slice(edges.as_flattened()).into()),
        ("vertices", Uint32Array::new_from_slice(&vertices).into()),
        ("singularFacets", Uint32Array::new_from_slice(singular_facets.as_flattened()).into()),
        ("singularEdges", Uint32Array::new_from_slice(singular_edges.as_flattened()).into()),
        ("singularVertices", Uint32Array::new_from_slice(&singular_vertices).into()),
        ("components", count.into()),
        ("componentOf", signed(&labels).into()),
    ]))
}

/// Returns those of some faces that are part of a complex, and those that are singular.
fn parts<F: Copy>(faces: &[(F, FaceClass)]) -> [Vec<F>; 2] {
    let parts = faces.iter().filter(|(_, class)| class.is_part()).map(|&(face, _)| face).collect();
    [parts, singular(faces.iter().copied())]
}
