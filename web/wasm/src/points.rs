//! Points from JavaScript.

use gdel::{Error, Points};
use js_sys::{Float32Array, Float64Array};
use wasm_bindgen::{JsCast, JsValue};

use crate::objects::{Thrown, error};

/// Interleaved coordinates, copied into this module's memory.
pub(crate) enum Coordinates {
    F32(Vec<f32>),
    F64(Vec<f64>),
}

impl Coordinates {
    /// Copies a `Float32Array` or a `Float64Array`.
    pub(crate) fn new(array: &JsValue) -> Result<Self, Thrown> {
        if let Some(array) = array.dyn_ref::<Float32Array>() {
            return Ok(Coordinates::F32(copied(array.length(), || array.to_vec())?));
        }
        let array: &Float64Array =
            array.dyn_ref().ok_or_else(|| error("BAD_INPUT", "points must be a Float32Array or a Float64Array"))?;
        Ok(Coordinates::F64(copied(array.length(), || array.to_vec())?))
    }

    /// Negates the *y* coordinates of 2D points.
    #[cfg(any(feature = "tools", feature = "derived", feature = "surface", feature = "edit", feature = "transport"))]
    pub(crate) fn flip_y(&mut self) {
        match self {
            Coordinates::F32(values) => values.iter_mut().skip(1).step_by(2).for_each(|y| *y = -*y),
            Coordinates::F64(values) => values.iter_mut().skip(1).step_by(2).for_each(|y| *y = -*y),
        }
    }

    /// Converts an array to the precision of these coordinates.
    #[cfg(any(feature = "surface", feature = "edit"))]
    pub(crate) fn in_same_precision(&self, array: Float64Array) -> JsValue {
        match self {
            Coordinates::F32(_) => Float32Array::new(&array).into(),
            Coordinates::F64(_) => array.into(),
        }
    }

    /// Returns some of the coordinates as points, counted in points.
    #[cfg(feature = "derived")]
    pub(crate) fn part<const D: usize>(&self, range: std::ops::Range<usize>) -> Result<Points<'_, D>, Error> {
        let range = D * range.start..D * range.end;
        match self {
            Coordinates::F32(values) => Points::from_interleaved_f32(&values[range]),
            Coordinates::F64(values) => Points::from_interleaved_f64(&values[range]),
        }
    }

    /// Appends more, in double precision if either is.
    #[cfg(feature = "edit")]
    pub(crate) fn append(&mut self, more: Coordinates) {
        match (&mut *self, more) {
            (Coordinates::F32(values), Coordinates::F32(more)) => values.extend(more),
            (Coordinates::F64(values), Coordinates::F64(more)) => values.extend(more),
            (Coordinates::F64(values), Coordinates::F32(more)) => values.extend(more.into_iter().map(f64::from)),
            (Coordinates::F32(_), Coordinates::F64(more)) if more.is_empty() => {}
            (Coordinates::F32(values), Coordinates::F64(more)) => {
                *self = Coordinates::F64(values.iter().map(|&x| f64::from(x)).chain(more).collect());
            }
        }
    }

    /// Returns the points with these indices.
    #[cfg(feature = "edit")]
    pub(crate) fn select<const D: usize>(&self, indices: &[u32]) -> Coordinates {
        let all = indices.iter().flat_map(|&i| D * i as usize..D * (i as usize + 1));
        match self {
            Coordinates::F32(values) => Coordinates::F32(all.map(|i| values[i]).collect()),
            Coordinates::F64(values) => Coordinates::F64(all.map(|i| values[i]).collect()),
        }
    }

    /// Returns the coordinates as the array of JavaScript that has their precision.
    #[cfg(feature = "edit")]
    pub(crate) fn into_js(self) -> JsValue {
        match self {
            Coordinates::F32(values) => Float32Array::new_from_slice(&values).into(),
            Coordinates::F64(values) => Float64Array::new_from_slice(&values).into(),
        }
    }

    /// Returns the coordinates as points.
    pub(crate) fn points<const D: usize>(&self) -> Result<Points<'_, D>, Error> {
        match self {
            Coordinates::F32(values) => Points::from_interleaved_f32(values),
            Coordinates::F64(values) => Points::from_interleaved_f64(values),
        }
    }
}

/// Returns what `copy` returns, an array of `length` elements, or an error if memory does not suffice.
fn copied<T>(length: u32, copy: impl FnOnce() -> Vec<T>) -> Result<Vec<T>, Thrown> {
    // `copy` takes the same memory again, and does not fill it with zeros before.
    drop(room::<T>(length as usize)?);
    Ok(copy())
}

/// Returns an empty array with room for `length` elements, or an error if memory does not suffice.
pub(crate) fn room<T>(length: usize) -> Result<Vec<T>, Thrown> {
    let mut values = Vec::new();
    values.try_reserve_exact(length).map_err(|_| {
        error("OUT_OF_MEMORY", &format!("WebAssembly's memory has no room for an array of length {length}"))
    })?;
    Ok(values)
}

/// Copies the points of a mesh, and checks them.
#[cfg(any(feature = "tools", feature = "derived", feature = "surface", feature = "transport"))]
pub(crate) fn points_of_mesh<const D: usize>(points: &JsValue) -> Result<Coordinates, Thrown> {
    let coordinates = Coordinates::new(points)?;
    coordinates.points::<D>()?.validate()?;
    Ok(coordinates)
}

/// Returns an array of zeros, or an error if memory does not suffice.
#[cfg(any(feature = "tools", feature = "derived", feature = "surface", feature = "edit", feature = "transport"))]
pub(crate) fn zeros<T: Clone + Default>(length: u32) -> Result<Vec<T>, Thrown> {
    let mut values = room(length as usize)?;
    values.resize(length as usize, T::default());
    Ok(values)
}
