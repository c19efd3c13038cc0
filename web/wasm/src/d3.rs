//! 3D triangulation.

use gdel::{
    Backend, DeviceMesh3, Error, Mesh3, Triangulator,
    internals::gpu::{engine::MadeMesh, host::AnyHost},
};
use js_sys::Function;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::{
    arrays::d3::{Outputs, mesh3, set_extras, trace},
    host::{JsCarrier, for_device, left_to_cpu},
    objects::{Thrown, set},
    points::Coordinates,
    resident,
    triangulator::WasmTriangulator,
};

#[wasm_bindgen]
impl WasmTriangulator {
    /// Returns the number of points from which on the backend `auto` considers the GPU in 3D.
    pub fn least3d(&self) -> u32 {
        self.triangulator.least::<3>().try_into().unwrap_or(u32::MAX)
    }

    /// Returns what is known of the speed of the device in 3D.
    pub fn known3d(&self) -> Vec<u32> {
        self.triangulator.known::<3>()
    }

    /// Takes over what was known of it on an earlier visit.
    pub fn recall3d(&self, known: &[u32]) {
        self.triangulator.recall::<3>(known);
    }

    /// Says why the backend `auto` has the CPU triangulate so many points in 3D, if it does.
    pub fn why_cpu3d(&self, points: u32) -> Option<String> {
        self.triangulator.why_cpu::<3>(points as usize).map(|why| why.to_string())
    }

    /// Opens the adapter that `navigator.gpu` recommends for speed, and compiles the kernels for
    /// 3D, or, if that goes on `meanwhile`, begins to.
    pub async fn open3d(&self, meanwhile: bool) -> Result<(), Thrown> {
        Ok(self.triangulator.open_for::<3>(meanwhile).await?)
    }

    /// Triangulates in 3D. With `resident`, the mesh stays on the device, and `outputs` has no
    /// meaning; else its arrays are read into what `memory` returns for a number of bytes.
    pub async fn delaunay3d(
        &self,
        points: JsValue,
        backend: &str,
        outputs: Outputs,
        resident: bool,
        memory: Function,
        report: Function,
    ) -> Result<JsValue, Thrown> {
        let triangulator = self.for_run(backend, report).trace(outputs.trace);
        run(&triangulator, points, (!resident).then_some((outputs, memory)), None).await
    }
}

#[wasm_bindgen]
impl WasmTriangulator {
    /// Triangulates in 3D the points that another thread has. The mesh stays on the device.
    pub async fn drive3d(&self, carrier: JsCarrier, trace: bool, report: Function) -> Result<JsValue, Thrown> {
        drive(&for_device(&self.triangulator, report).trace(trace), carrier, None).await
    }

    /// Creates the buffers of a mesh that the caller fills.
    pub async fn room3d(
        &self,
        tetrahedra: usize,
        hull: usize,
        duplicate_of: Vec<i32>,
        dimension: u8,
    ) -> Result<JsValue, Thrown> {
        let mut info = Mesh3::default();
        (info.duplicate_of, info.dimension) = (bytemuck::cast_vec(duplicate_of), dimension);
        let mesh = self.triangulator.room3d([tetrahedra, 3 * hull], info).await?;
        Ok(resident::hand_over(mesh, |mesh| WasmMesh3(mesh).into()))
    }
}

/// Triangulates the points that another thread has.
async fn drive(
    triangulator: &Triangulator,
    carrier: JsCarrier,
    moved: Option<&DeviceMesh3>,
) -> Result<JsValue, Thrown> {
    Ok(match triangulator.drive3d(&mut AnyHost::elsewhere(carrier), moved).await? {
        Ok(mesh) => {
            let trace = mesh.stats().trace.as_ref().map(trace);
            let made = resident::hand_over(mesh, |mesh| WasmMesh3(mesh).into());
            if let Some(trace) = trace {
                set(&made, "trace", trace);
            }
            made
        }
        Err(before) => left_to_cpu(&before),
    })
}

/// Triangulates. The mesh stays on the device if no arrays of it are read into memory, and then goes on
/// from `moved`.
async fn run(
    triangulator: &Triangulator,
    points: JsValue,
    read: Option<(Outputs, Function)>,
    moved: Option<&DeviceMesh3>,
) -> Result<JsValue, Thrown> {
    let coordinates = Coordinates::new(&points)?;
    drop(points);
    let deliver = async |mesh: MadeMesh<3>| match (mesh, &read) {
        (MadeMesh::Host(mesh), read) => {
            let (outputs, _) = read.as_ref().expect("what stays on the device is there");
            Ok(mesh3(mesh, *outputs))
        }
        (MadeMesh::Device(mesh), Some((outputs, memory))) => read3(&mesh, *outputs, memory).await,
        (MadeMesh::Device(mesh), None) => Ok(resident::hand_over(*mesh, |mesh| WasmMesh3(mesh).into())),
    };
    Ok(triangulator.deliver3d(coordinates.points()?, read.is_none(), moved, deliver).await?)
}

/// A mesh on the device.
#[wasm_bindgen]
pub struct WasmMesh3(DeviceMesh3);

#[wasm_bindgen]
impl WasmMesh3 {
    /// Returns the bytes of an array: the tetrahedra, their neighbours, the hull, or a tetrahedron
    /// of each point, by these numbers, in what `memory` returns for a number of them.
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
        run(&triangulator.for_run(backend, report), points, None, Some(&self.0)).await
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
async fn read3(mesh: &DeviceMesh3, outputs: Outputs, memory: &Function) -> Result<JsValue, Error> {
    let arrays = [(0, "tetrahedra", true), (1, "neighbors", outputs.neighbors), (2, "hull", outputs.hull)];
    let wanted: Vec<(usize, &str)> =
        arrays.into_iter().filter(|&(.., wanted)| wanted).map(|(number, name, _)| (number, name)).collect();
    let (result, stats) = resident::read(mesh, &wanted, memory).await?;
    set_extras(&result, &stats, mesh.duplicate_of(), outputs);
    Ok(result)
}
