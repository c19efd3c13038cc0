//! What 3D and 2D runs share: the triangulator, progress reports, statistics.

use std::ops::ControlFlow;

use gdel::{
    Backend, Progress, Triangulator,
    internals::fields::{Field, Value},
    stats::Stats,
};
use js_sys::{Array, Function, Object};
use send_wrapper::SendWrapper;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::objects::set;

/// A triangulator for any number of runs.
#[wasm_bindgen]
#[derive(Default)]
pub struct WasmTriangulator {
    pub(crate) triangulator: Triangulator,
}

#[wasm_bindgen]
impl WasmTriangulator {
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        WasmTriangulator::default()
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
        // Nothing moves to another thread, since there is none.
        let report = SendWrapper::new(report);
        self.triangulator.clone().backend(backend).on_progress(move |progress: Progress| {
            let stop = report.call2(&JsValue::NULL, &progress.phase.name().into(), &progress.fraction.into());
            match stop {
                Ok(stop) if stop.is_falsy() => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            }
        })
    }
}

/// Returns the statistics as the object that `web/src/stats.ts` describes.
pub(crate) fn statistics(stats: &Stats) -> JsValue {
    copy(stats.value())
}

fn copy(value: Value<'_>) -> JsValue {
    match value {
        Value::Omitted | Value::Null => JsValue::NULL,
        Value::Number(number) => number.into(),
        Value::Text(text) => (&*text).into(),
        Value::List(values) => values.into_iter().map(copy).collect::<Array>().into(),
        Value::Object(fields) => {
            let object = Object::new().into();
            for (name, value) in fields {
                if !matches!(value, Value::Omitted) {
                    set(&object, &name, copy(value));
                }
            }
            object
        }
    }
}
