//! The triangulator of 3D and 2D runs.

use gdel::{Backend, Triangulator};
use js_sys::Function;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::run::reporting;

/// A triangulator for any number of runs.
#[wasm_bindgen]
pub struct WasmTriangulator {
    pub(crate) triangulator: Triangulator,
}

#[wasm_bindgen]
impl WasmTriangulator {
    /// Creates a triangulator. If it `compiles_meanwhile`, the backend `auto` has the CPU triangulate while
    /// kernels are compiled, if that is sooner. Where nothing is said of `self_test`, hardware is tested before it
    /// is used.
    #[wasm_bindgen(constructor)]
    pub fn new(compiles_meanwhile: bool, self_test: Option<bool>) -> Self {
        let triangulator = Triangulator::compiling_meanwhile(compiles_meanwhile);
        let triangulator = match self_test {
            Some(self_test) => triangulator.self_test(self_test),
            None => triangulator,
        };
        WasmTriangulator { triangulator }
    }

    /// Releases the device.
    pub async fn close(&self) {
        self.triangulator.close().await;
    }
}

impl WasmTriangulator {
    /// Returns a triangulator for one run, with the backend `auto`, `gpu` or `cpu`. The run calls
    /// `report(phase, fraction)` and is cancelled when that returns true.
    pub(crate) fn for_run(&self, backend: &str, report: Function) -> Triangulator {
        let backend = match backend {
            "gpu" => Backend::Gpu,
            "cpu" => Backend::Cpu,
            _ => Backend::Auto,
        };
        self.triangulator.clone().backend(backend).on_progress(reporting(report))
    }
}
