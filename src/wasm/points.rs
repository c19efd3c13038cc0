//! Points from JavaScript.

use js_sys::{Float32Array, Float64Array};
use wasm_bindgen::{JsCast, JsValue};

use crate::wasm::objects::error;
use crate::{Error, Points};

/// Interleaved coordinates, copied into this module's memory.
pub(super) enum Coordinates {
    F32(Vec<f32>),
    F64(Vec<f64>),
}

impl Coordinates {
    /// From a `Float32Array` or a `Float64Array`.
    pub(super) fn new(array: &JsValue) -> Result<Self, JsValue> {
        if let Some(array) = array.dyn_ref::<Float32Array>() {
            let mut values = zeros(array.length())?;
            array.copy_to(&mut values);
            return Ok(Coordinates::F32(values));
        }
        let array: &Float64Array =
            array.dyn_ref().ok_or_else(|| error("BAD_INPUT", "points are a Float32Array or a Float64Array"))?;
        let mut values = zeros(array.length())?;
        array.copy_to(&mut values);
        Ok(Coordinates::F64(values))
    }

    /// Points of the plane with y negated.
    pub(super) fn upside_down(&self) -> Self {
        fn negated<T: Copy + std::ops::Neg<Output = T>>(values: &[T]) -> Vec<T> {
            values.iter().enumerate().map(|(i, &value)| if i % 2 == 1 { -value } else { value }).collect()
        }
        match self {
            Coordinates::F32(values) => Coordinates::F32(negated(values)),
            Coordinates::F64(values) => Coordinates::F64(negated(values)),
        }
    }

    pub(super) fn points<const D: usize>(&self) -> Result<Points<'_, D>, Error> {
        match self {
            Coordinates::F32(values) => Points::from_interleaved_f32(values),
            Coordinates::F64(values) => Points::from_interleaved_f64(values),
        }
    }
}

/// Room for an array, if there is.
pub(super) fn zeros<T: Clone + Default>(length: u32) -> Result<Vec<T>, JsValue> {
    let mut values = Vec::new();
    values
        .try_reserve_exact(length as usize)
        .map_err(|_| error("OUT_OF_MEMORY", &format!("there is no room for an array of {length} numbers")))?;
    values.resize(length as usize, T::default());
    Ok(values)
}
