//! JavaScript objects from Rust values.

use js_sys::{Object, Reflect};
use wasm_bindgen::JsValue;

use crate::Error;

/// Sets a property of an object that was made here.
pub(super) fn set(object: &JsValue, key: &str, value: impl Into<JsValue>) {
    Reflect::set(object, &key.into(), &value.into()).expect("a plain object takes any property");
}

/// A plain object.
pub(super) fn object<const N: usize>(entries: [(&str, JsValue); N]) -> JsValue {
    let object = Object::new().into();
    for (key, value) in entries {
        set(&object, key, value);
    }
    object
}

/// An `Error` with a `code`.
pub(super) fn error(code: &str, message: &str) -> js_sys::Error {
    let error = js_sys::Error::new(message);
    set(&error, "code", code);
    error
}

impl From<Error> for JsValue {
    fn from(error: Error) -> JsValue {
        let code = match error {
            Error::NotFinite { .. } => "NOT_FINITE",
            Error::NotWholePoints { .. } | Error::ArrayShape { .. } | Error::ArrayLayout => "BAD_INPUT",
            Error::TooManyPoints { .. } => "TOO_MANY_POINTS",
            Error::GpuUnavailable { .. } | Error::NoAdapter { .. } | Error::AdapterNotFound { .. } => "NO_ADAPTER",
            Error::DeviceLost { .. } => "DEVICE_LOST",
            Error::OutOfDeviceMemory { .. } => "OUT_OF_DEVICE_MEMORY",
            Error::BufferTooLarge { .. } => "BUFFER_TOO_LARGE",
            Error::Gpu { .. } => "GPU",
            Error::TooManySimplices { .. } => "TOO_MANY_TETRAHEDRA",
            Error::OutOfMemory { .. } => "OUT_OF_MEMORY",
            Error::Cancelled => "ABORTED",
        };
        let object = self::error(code, &error.to_string());
        if let Error::NotFinite { index, .. } = error {
            set(&object, "index", index as f64);
        }
        object.into()
    }
}
