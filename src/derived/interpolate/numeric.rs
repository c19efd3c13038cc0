//! Arithmetic of the weights: vectors of [`Real`] numbers, and the error that is allowed.

use crate::{
    geometry::{real::Real, vector},
    predicates::polynomial,
};

/// No weight may have a larger error.
pub(super) const MAX_ERROR: f64 = 5e-11;

/// Returns a − b.
pub(super) fn difference<T: Real, const D: usize>(a: [f64; D], b: [f64; D]) -> [T; D] {
    std::array::from_fn(|axis| T::difference(a[axis], b[axis]))
}

/// Returns the length of a vector, rounded.
pub(super) fn length<T: Real, const D: usize>(u: [T; D]) -> f64 {
    vector::norm(u.map(T::to_f64))
}

/// Returns the dot product.
pub(super) fn dot<T: Real, const D: usize>(u: [T; D], v: [T; D]) -> T {
    polynomial::dot(&u, &v)
}
