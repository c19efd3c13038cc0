//! 2D triangulation, in delaunator's orientation.

use gdel::{
    Backend, DeviceMesh2, Mesh2, Triangulator,
    internals::{
        Winding,
        gpu::{engine::MadeMesh, host::AnyHost},
    },
};
use js_sys::Function;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    arrays::d2::mesh2,
    host::{JsCarrier, for_device, left_to_cpu},
    objects::{Thrown, set, signed},
    points::Coordinates,
    resident,
    triangulator::WasmTriangulator,
};

#[wasm_bindgen]
impl WasmTriangulator {
    /// Returns the number of points from which on the backend `auto` considers the GPU in 2D.
    pub fn least2d(&self) -> u32 {
        self.triangulator.least::<2>().try_into().unwrap_or(u32::MAX)
    }

    /// Returns what is known of the speed of the device in 2D.
    pub fn known2d(&self) -> Vec<u32> {
        self.triangulator.known::<2>()
    }

    /// Takes over what was known of it on an earlier visit.
    pub fn recall2d(&self, known: &[u32]) {
        self.triangulator.recall::<2>(known);
    }

    /// Says why the backend `auto` has the CPU triangulate so many points in 2D, if it does.
    pub fn why_cpu2d(&self, points: u32) -> Option<String> {
        self.triangulator.why_cpu::<2>(points as usize).map(|why| why.to_string())
    }

    /// Opens the adapter that `navigator.gpu` recommends for speed, and compiles the kernels for
    /// 2D, or, if that goes on `meanwhile`, begins to.
    pub async fn open2d(&self, meanwhile: bool) -> Result<(), Thrown> {
        Ok(self.triangulator.open_for::<2>(meanwhile).await?)
    }

    /// Triangulates in 2D. With `resident`, the mesh stays on the device; else its arrays are read
    /// into what `memory` returns for a number of bytes. A mesh of the CPU has a triangle of each point if
    /// `vertex_simplex`.
    pub async fn delaunay2d(
        &self,
        points: JsValue,
        backend: &str,
        vertex_simplex: bool,
        resident: bool,
        memory: Function,
        report: Function,
    ) -> Result<JsValue, Thrown> {
        run(self.for_run(backend, report), points, (!resident).then_some(memory), None, vertex_simplex).await
    }
}

#[wasm_bindgen]
impl WasmTriangulator {
    /// Triangulates in 2D the points that another thread has. The mesh stays on the device.
    pub async fn drive2d(&self, carrier: JsCarrier, report: Function) -> Result<JsValue, Thrown> {
        drive(&for_device(&self.triangulator, report), carrier, None).await
    }

    /// Creates the buffers of a mesh that the caller fills.
    pub async fn room2d(
        &self,
        triangles: usize,
        hull: usize,
        duplicate_of: Vec<i32>,
        dimension: u8,
    ) -> Result<JsValue, Thrown> {
        let mut info = Mesh2::default();
        (info.duplicate_of, info.dimension) = (bytemuck::cast_vec(duplicate_of), dimension);
        let mesh = self.triangulator.room2d([triangles, hull], info).await?;
        Ok(resident::hand_over(mesh, |mesh| WasmMesh2(mesh).into()))
    }
}

/// Triangulates the points that another thread has.
async fn drive(
    triangulator: &Triangulator,
    carrier: JsCarrier,
    moved: Option<&DeviceMesh2>,
) -> Result<JsValue, Thrown> {
    let triangulator = triangulator.clone().winding(Winding::Clockwise);
    Ok(match triangulator.drive2d(&mut AnyHost::elsewhere(carrier), moved).await? {
        Ok(mesh) => resident::hand_over(mesh, |mesh| WasmMesh2(mesh).into()),
        Err(before) => left_to_cpu(&before),
    })
}

/// Triangulates. The mesh stays on the device if no memory for its arrays is given, and then goes on
/// from `moved`.
async fn run(
    triangulator: Triangulator,
    points: JsValue,
    memory: Option<Function>,
    moved: Option<&DeviceMesh2>,
    vertex_simplex: bool,
) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    let triangulator = triangulator.winding(Winding::Clockwise);
    let deliver = async |mesh: MadeMesh<2>| match (mesh, &memory) {
        (MadeMesh::Host(mesh), _) => {
            let vertex_simplex = vertex_simplex.then(|| signed(&mesh.vertex_triangle()));
            let result = mesh2(mesh, true);
            if let Some(array) = vertex_simplex {
                set(&result, "vertexSimplex", array);
            }
            Ok(result)
        }
        (MadeMesh::Device(mesh), Some(memory)) => {
            let arrays = [(0, "triangles"), (1, "halfedges"), (2, "hull")];
            let (result, _) = resident::read(&mesh, &arrays, memory).await?;
            set(&result, "duplicateOf", signed(mesh.duplicate_of()));
            Ok(result)
        }
        (MadeMesh::Device(mesh), None) => Ok(resident::hand_over(*mesh, |mesh| WasmMesh2(mesh).into())),
    };
    Ok(triangulator.deliver2d(coordinates.points()?, memory.is_none(), moved, deliver).await?)
}

/// A mesh on the device.
#[wasm_bindgen]
pub struct WasmMesh2(DeviceMesh2);

#[wasm_bindgen]
impl WasmMesh2 {
    /// Returns the bytes of an array: the triangles, their half-edges, the hull, or a triangle of each
    /// point, by these numbers, in what `memory` returns for a number of them.
    pub async fn read(&self, array: usize, memory: Function) -> Result<JsValue, Thrown> {
        resident::read_one(&self.0, array, &memory).await
    }

    /// Returns the mesh of the points after they have moved, which another thread has.
    pub async fn drive(
        &self,
        triangulator: &WasmTriangulator,
        carrier: JsCarrier,
        report: Function,
    ) -> Result<JsValue, Thrown> {
        drive(&for_device(&triangulator.triangulator, report), carrier, Some(&self.0)).await
    }

    /// Returns the mesh of the points after they have moved, which stays on the device, too.
    pub async fn update(
        &self,
        triangulator: &WasmTriangulator,
        points: JsValue,
        backend: &str,
        report: Function,
    ) -> Result<JsValue, Thrown> {
        run(triangulator.for_run(backend, report), points, None, Some(&self.0), false).await
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
