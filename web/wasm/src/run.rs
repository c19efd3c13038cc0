//! What all runs share: progress reports and statistics.

use std::ops::ControlFlow;

use gdel::{
    Progress,
    internals::fields::{Field, Value},
};
use js_sys::{Array, Function, Object};
use send_wrapper::SendWrapper;
use wasm_bindgen::JsValue;

use crate::objects::set;

/// Returns a function for progress that calls `report(phase, fraction)`, and cancels the run when that
/// returns true.
pub(crate) fn reporting(report: Function) -> impl Fn(Progress) -> ControlFlow<()> + Send + Sync + 'static {
    // Nothing moves to another thread, since there is none.
    let report = SendWrapper::new(report);
    move |progress: Progress| {
        let stop = report.call2(&JsValue::NULL, &progress.phase.name().into(), &progress.fraction.into());
        match stop {
            Ok(stop) if stop.is_falsy() => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        }
    }
}

/// Returns the statistics as the object that `web/src/stats.ts` describes.
#[cfg_attr(not(any(feature = "d2", feature = "d3", feature = "edit")), expect(dead_code, reason = "there is no mesh"))]
pub(crate) fn statistics(stats: &impl Field) -> JsValue {
    copy(stats.value())
}

fn copy(value: Value<'_>) -> JsValue {
    match value {
        Value::Omitted | Value::Null => JsValue::NULL,
        Value::Number(number) => number.into(),
        Value::Bool(is_true) => is_true.into(),
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
