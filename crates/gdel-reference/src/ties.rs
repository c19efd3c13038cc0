//! Helpers of the references of the predicates.

use num_bigint::BigInt;

use crate::Vertex;
use gdel::Sign;

/// Returns the places of the vertices in the order of their indices.
pub(crate) fn by_index<const D: usize, const N: usize>(vertices: &[Vertex<D>; N]) -> [usize; N] {
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    order.sort_unstable_by_key(|&i| vertices[i].index);
    order
}

/// Returns the sign of a big integer.
pub(crate) fn sign_of(value: &BigInt) -> Sign {
    match value.sign() {
        num_bigint::Sign::Minus => -1,
        num_bigint::Sign::NoSign => 0,
        num_bigint::Sign::Plus => 1,
    }
}
