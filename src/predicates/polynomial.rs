//! Predicates that are signs of polynomials, each written once and evaluated in up to three rings:
//! floating-point numbers with a running error bound, 128-bit integers, and big integers.
//!
//! The in-sphere tests and orientations have hand-written filters elsewhere; these are the
//! predicates of what is derived from a triangulation, which are evaluated less often.

use crate::{
    input::lattice::decompose,
    predicates::{
        Sign,
        big::{Big, common_exponent},
    },
};
use std::ops::{Add, Mul, Sub};

/// Numbers that polynomials are evaluated in.
pub trait Ring: Clone + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + From<i32> {}

/// A polynomial of the coordinates of `K` points.
pub(crate) trait Polynomial<const K: usize, const D: usize> {
    /// Evaluates the polynomial. It must be homogeneous, since the coordinates may all have been
    /// multiplied by the same power of two.
    fn value<T: Ring>(&self, points: &[[T; D]; K]) -> T;
}

/// A polynomial of the coordinates of `K` points and of their weights.
pub(crate) trait WeightedPolynomial<const K: usize, const D: usize> {
    /// Evaluates the polynomial. It must be homogeneous if a weight has degree 2, since the coordinates may all have
    /// been multiplied by the same power of two, and the weights by its square.
    fn value<T: Ring>(&self, points: &[[T; D]; K], weights: &[T; K]) -> T;
}

/// Returns the sign of a polynomial, exactly, for all finite coordinates.
#[inline]
pub(crate) fn sign<const K: usize, const D: usize>(polynomial: &impl Polynomial<K, D>, points: &[[f64; D]; K]) -> Sign {
    match polynomial.value(&points.map(|p| p.map(Approximate::exact))).sign() {
        Some(sign) => sign,
        None => exact_sign(polynomial, points),
    }
}

/// Returns the sign of a polynomial, exactly, for all finite coordinates, of which floating point
/// is known not to be certain.
#[inline(never)]
pub(crate) fn exact_sign<const K: usize, const D: usize>(
    polynomial: &impl Polynomial<K, D>,
    points: &[[f64; D]; K],
) -> Sign {
    let exponent = common_exponent(points.as_flattened());
    let small = || Some(polynomial.value(&try_map(points, |x| Checked::new(x, exponent))?).0?.signum() as Sign);
    small().unwrap_or_else(|| polynomial.value(&points.map(|p| p.map(|x| Big::new(x, exponent)))).sign())
}

/// Returns the sign of a polynomial, exactly, for all finite coordinates and weights.
#[inline(never)]
pub(crate) fn weighted_sign<const K: usize, const D: usize>(
    polynomial: &impl WeightedPolynomial<K, D>,
    points: &[[f64; D]; K],
    weights: &[f64; K],
) -> Sign {
    let approximate = polynomial.value(&points.map(|p| p.map(Approximate::exact)), &weights.map(Approximate::exact));
    if let Some(sign) = approximate.sign() {
        return sign;
    }
    let exponent = weighted_exponent(points.as_flattened(), weights);
    let small = || {
        let points = try_map(points, |x| Checked::new(x, exponent))?;
        let [weights] = try_map(&[*weights], |w| Checked::new(w, 2 * exponent))?;
        Some(polynomial.value(&points, &weights).0?.signum() as Sign)
    };
    small().unwrap_or_else(|| {
        let points = points.map(|p| p.map(|x| Big::new(x, exponent)));
        polynomial.value(&points, &weights.map(|w| Big::new(w, 2 * exponent))).sign()
    })
}

/// Returns the largest exponent *e* such that all coordinates are integers times 2ᵉ, and all weights integers times
/// 2²ᵉ.
pub(crate) fn weighted_exponent(coordinates: &[f64], weights: &[f64]) -> i32 {
    let of_weights = common_exponent(weights).div_euclid(2);
    // Where all weights are 0, their exponent is 0, as good as any.
    common_exponent(coordinates).min(of_weights)
}

/// Applies `f` to all coordinates, until one has no result.
fn try_map<T: Copy, const K: usize, const D: usize>(
    points: &[[f64; D]; K],
    f: impl Fn(f64) -> Option<T>,
) -> Option<[[T; D]; K]> {
    let first = f(points[0][0])?;
    let mut mapped = [[first; D]; K];
    for (to, &x) in mapped.as_flattened_mut().iter_mut().zip(points.as_flattened()) {
        *to = f(x)?;
    }
    Some(mapped)
}

/// The largest relative error of a rounded operation, 2⁻⁵³.
const EPSILON: f64 = f64::EPSILON / 2.0;

/// The largest absolute error of an operation that underflows, 2⁻¹⁰⁷⁵, several times over.
const TINY: f64 = f64::from_bits(8);

/// A floating-point number and a bound of its error, as far as the bound itself was not rounded
/// (Wilkinson's running error analysis: Higham, *Accuracy and Stability of Numerical Algorithms*,
/// 2002, §3.3).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Approximate {
    value: f64,
    error: f64,
}

impl Approximate {
    /// A number that is not rounded.
    pub(crate) fn exact(value: f64) -> Self {
        Approximate { value, error: 0.0 }
    }

    /// Returns the sign, or `None` if the error may have changed it.
    ///
    /// No predicate has a thousand operations, so the bound's own rounding errors, all of which are
    /// relative to sums of positive terms, are below one part in 2⁴⁰.
    pub(crate) fn sign(self) -> Option<Sign> {
        let bound = self.error * (1.0 + 1.0 / (1u64 << 40) as f64);
        match self.value {
            v if v > bound => Some(1),
            v if v < -bound => Some(-1),
            v if v == 0.0 && bound == 0.0 => Some(0),
            _ => None,
        }
    }
}

impl From<i32> for Approximate {
    fn from(x: i32) -> Self {
        Approximate::exact(x.into())
    }
}

impl Add for Approximate {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let value = self.value + other.value;
        Approximate { value, error: self.error + other.error + EPSILON * value.abs() }
    }
}

impl Sub for Approximate {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let value = self.value - other.value;
        Approximate { value, error: self.error + other.error + EPSILON * value.abs() }
    }
}

impl Mul for Approximate {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.error * (other.value.abs() + other.error) + self.value.abs() * other.error;
        Approximate { value, error: error + EPSILON * value.abs() + TINY }
    }
}

impl Ring for Approximate {}

/// A 128-bit integer, or `None` after an overflow.
#[derive(Debug, Clone, Copy)]
struct Checked(Option<i128>);

impl Checked {
    /// Returns `x`·2⁻ᵉ where that is a small integer.
    fn new(x: f64, exponent: i32) -> Option<Self> {
        let (mantissa, e) = decompose(x);
        if mantissa == 0 {
            return Some(Checked(Some(0)));
        }
        let shift = e - exponent;
        if shift >= 64 {
            return None;
        }
        let magnitude = i128::from(mantissa) << shift;
        Some(Checked(Some(if x < 0.0 { -magnitude } else { magnitude })))
    }
}

impl From<i32> for Checked {
    fn from(x: i32) -> Self {
        Checked(Some(x.into()))
    }
}

/// Implements an operation that overflow ends.
macro_rules! checked {
    ($($trait:ident, $method:ident, $checked:ident);*) => {$(
        impl $trait for Checked {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Checked(self.0.zip(other.0).and_then(|(a, b)| a.$checked(b)))
            }
        }
    )*};
}
checked!(Add, add, checked_add; Sub, sub, checked_sub; Mul, mul, checked_mul);

impl Ring for Checked {}

impl Ring for Big {}

/// The dot product.
pub(crate) fn dot<T: Ring, const D: usize>(u: &[T; D], v: &[T; D]) -> T {
    let terms = u.iter().zip(v).map(|(x, y)| x.clone() * y.clone());
    terms.reduce(|sum, term| sum + term).unwrap_or_else(|| T::from(0))
}

/// The difference of two points.
pub(crate) fn minus<T: Ring, const D: usize>(a: &[T; D], b: &[T; D]) -> [T; D] {
    std::array::from_fn(|axis| a[axis].clone() - b[axis].clone())
}

/// The cross product.
pub(crate) fn cross<T: Ring>(u: &[T; 3], v: &[T; 3]) -> [T; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i].clone() * v[j].clone() - u[j].clone() * v[i].clone())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::exact;
    use proptest::prelude::*;

    /// det(b − a, c − a, d − a).
    struct Orientation;

    impl Polynomial<4, 3> for Orientation {
        fn value<T: Ring>(&self, [a, b, c, d]: &[[T; 3]; 4]) -> T {
            dot(&minus(b, a), &cross(&minus(c, a), &minus(d, a)))
        }
    }

    fn agree(points: [[f64; 3]; 4]) -> Result<(), TestCaseError> {
        let [a, b, c, d] = points;
        let expected = exact::orient3d(a, b, c, d);
        prop_assert_eq!(sign(&Orientation, &points), expected);
        prop_assert_eq!(exact_sign(&Orientation, &points), expected);
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn small_grid(points in prop::array::uniform4(prop::array::uniform3((-3i32..4).prop_map(f64::from)))) {
            agree(points)?;
        }

        #[test]
        fn any_finite(points in prop::array::uniform4(prop::array::uniform3(
            prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO
        ))) {
            agree(points)?;
        }

        #[test]
        fn nudged(points in prop::array::uniform4(prop::array::uniform3((0i32..3, -1i64..2).prop_map(|(x, nudge)| {
            f64::from_bits((f64::from(x) + 0.1).to_bits().wrapping_add_signed(nudge))
        })))) {
            agree(points)?;
        }
    }
}
