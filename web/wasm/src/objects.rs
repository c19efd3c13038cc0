//! JavaScript objects from Rust values.

use js_sys::{Array, Object, Reflect};
use wasm_bindgen::JsValue;

use gdel::Error;

/// Sets a property of an object that was created here.
pub(crate) fn set(object: &JsValue, key: &str, value: impl Into<JsValue>) {
    Reflect::set(object, &key.into(), &value.into()).expect("a plain object takes any property");
}

/// Creates a plain object.
pub(crate) fn object<const N: usize>(entries: [(&str, JsValue); N]) -> JsValue {
    let object = Object::new().into();
    for (key, value) in entries {
        set(&object, key, value);
    }
    object
}

/// Returns a property, undefined where there is none.
#[cfg(any(feature = "tools", feature = "derived", feature = "surface", feature = "edit", feature = "transport"))]
pub(crate) fn get(object: &JsValue, name: &str) -> JsValue {
    Reflect::get(object, &name.into()).unwrap_or(JsValue::UNDEFINED)
}

/// Copies indices into a signed array, where [`NONE`](gdel::NONE) is −1.
#[cfg(any(
    feature = "d2",
    feature = "d3",
    feature = "edit",
    feature = "derived",
    feature = "surface",
    feature = "transport"
))]
pub(crate) fn signed(indices: &[u32]) -> js_sys::Int32Array {
    js_sys::Int32Array::new_from_slice(bytemuck::cast_slice(indices))
}

/// Creates an `Error` with a `code`.
pub(crate) fn error(code: &str, message: &str) -> js_sys::Error {
    let error = js_sys::Error::new(message);
    set(&error, "code", code);
    error
}

/// What a function throws: an `Error` with a `code`.
pub struct Thrown(js_sys::Error);

impl From<Thrown> for JsValue {
    fn from(thrown: Thrown) -> JsValue {
        thrown.0.into()
    }
}

impl From<js_sys::Error> for Thrown {
    fn from(error: js_sys::Error) -> Self {
        Thrown(error)
    }
}

impl From<Error> for Thrown {
    fn from(error: Error) -> Self {
        let code = match error {
            Error::NotFinite { .. } => "NOT_FINITE",
            Error::NotWholePoints { .. } | Error::ArrayShape { .. } | Error::ArrayLayout => "BAD_INPUT",
            Error::PointCount { .. } | Error::ValueCount { .. } | Error::EmptyBox { .. } => "BAD_INPUT",
            Error::DuplicateValues { .. } | Error::BadWeight { .. } | Error::WeightedMesh => "BAD_INPUT",
            Error::BadConstraint { .. } | Error::OpenBoundary { .. } | Error::ConstrainedMesh => "BAD_INPUT",
            Error::BadMass { .. } | Error::MassSum { .. } | Error::TransportStopped { .. } => "BAD_INPUT",
            Error::CrossingConstraints { .. } => "CROSSING_CONSTRAINTS",
            Error::BadAlpha | Error::BadOption { .. } | Error::BadIndex { .. } | Error::BrokenMesh { .. } => {
                "BAD_INPUT"
            }
            Error::TooManyPoints { .. } => "TOO_MANY_POINTS",
            Error::GpuUnavailable { .. } | Error::NoAdapter { .. } | Error::AdapterNotFound { .. } => "NO_ADAPTER",
            Error::DeviceLost { .. } => "DEVICE_LOST",
            Error::OutOfDeviceMemory { .. } => "OUT_OF_DEVICE_MEMORY",
            Error::BufferTooLarge { .. } => "BUFFER_TOO_LARGE",
            Error::Gpu { .. } => "GPU",
            Error::WrongResults { .. } => "GPU_WRONG",
            Error::TooManySimplices { .. } => "TOO_MANY_TETRAHEDRA",
            Error::OutOfMemory { .. } => "OUT_OF_MEMORY",
            Error::Cancelled => "ABORTED",
            // A new kind of error that was not given a code here.
            _ => "INTERNAL",
        };
        let object = self::error(code, &error.to_string());
        match error {
            Error::NotFinite { index, .. } | Error::BadWeight { index } | Error::BadMass { index } => {
                set(&object, "index", index as f64);
            }
            Error::CrossingConstraints { pairs, .. } => {
                let pair = |edge: [u32; 2]| Array::of2(&edge[0].into(), &edge[1].into());
                let both = |[a, b]: [[u32; 2]; 2]| Array::of2(&pair(a), &pair(b));
                set(&object, "pairs", pairs.into_iter().map(both).collect::<Array>());
            }
            _ => {}
        }
        Thrown(object)
    }
}
