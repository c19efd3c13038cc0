//! 2D triangulation, in delaunator's orientation.

use gdel::{
    Backend, DeviceMesh2, Mesh2, Triangulator,
    internals::{Winding, gpu::engine::Made, triangulator::MIN_POINTS_2D},
};
use js_sys::{Function, Int32Array, Uint32Array};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    objects::{Thrown, object, set},
    points::Coordinates,
    resident,
    triangulator::{WasmTriangulator, statistics},
};

/// Returns the number of points from which on the backend `auto` considers the GPU in 2D.
#[wasm_bindgen]
pub fn min_gpu_points_2d() -> u32 {
    MIN_POINTS_2D as u32
}

#[wasm_bindgen]
impl WasmTriangulator {
    /// Triangulates in 2D. With `on_device`, the mesh stays on the device.
    pub async fn delaunay2d(
        &self,
        points: JsValue,
        backend: &str,
        on_device: bool,
        report: Function,
    ) -> Result<JsValue, Thrown> {
        let coordinates = Coordinates::new(&points)?;
        drop(points);
        let triangulator = self.for_run(backend, report).winding(Winding::Clockwise);
        let deliver = async |mesh: Made<2>| match mesh {
            Made::Host(mesh) => Ok(mesh2(mesh, true)),
            Made::Device(mesh) if on_device => Ok(resident::hand_over(*mesh, |mesh| WasmMesh2(mesh).into())),
            Made::Device(mesh) => {
                let (result, _) = resident::read(&mesh, &[(0, "triangles"), (1, "halfedges"), (2, "hull")]).await?;
                set(&result, "duplicateOf", Int32Array::new_from_slice(mesh.duplicate_of()));
                Ok(result)
            }
        };
        Ok(triangulator.deliver2d(coordinates.points()?, on_device, deliver).await?)
    }
}

/// A mesh on the device.
#[wasm_bindgen]
pub struct WasmMesh2(DeviceMesh2);

#[wasm_bindgen]
impl WasmMesh2 {
    /// Returns the bytes of an array: the triangles, their half-edges, the hull, or a triangle of each
    /// point, by these numbers.
    pub async fn read(&self, array: usize) -> Result<JsValue, Thrown> {
        Ok(self.0.read_to_js(&[array]).await?.0.swap_remove(0).into())
    }
}

/// Triangulates in 2D with the CPU backend, without returning to the event loop. Statistics are
/// left out on request: for few points they take longer than the triangulation.
#[wasm_bindgen]
pub fn delaunay2d_blocking(points: JsValue, with_statistics: bool) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    let triangulator = Triangulator::new().backend(Backend::Cpu).winding(Winding::Clockwise);
    Ok(mesh2(triangulator.delaunay2d(coordinates.points()?)?, with_statistics))
}

fn mesh2(mesh: Mesh2, with_statistics: bool) -> JsValue {
    object([
        ("dimension", mesh.dimension.into()),
        ("stats", if with_statistics { statistics(&mesh.stats) } else { JsValue::NULL }),
        ("triangles", Uint32Array::new_from_slice(mesh.triangles.as_flattened()).into()),
        ("halfedges", Int32Array::new_from_slice(mesh.halfedges.as_flattened()).into()),
        ("hull", Uint32Array::new_from_slice(&mesh.hull).into()),
        ("duplicateOf", Int32Array::new_from_slice(&mesh.duplicate_of).into()),
    ])
}
