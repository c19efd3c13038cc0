//! Numbers of two precisions, for sums in which terms cancel.

use super::{Euclidean, Geometry, circumcenter_offset, exact_offset};
use crate::{
    input::lattice::decompose,
    predicates::{
        big::{Big, quotient},
        polynomial::Ring,
    },
};
use std::ops::{Add, Mul, Sub};

/// A floating-point number.
pub trait Real: Ring + Copy {
    /// The largest relative error of an operation, and of a coordinate of a circumcentre by its
    /// circumradius as far as it is not along the normal of a flat simplex.
    const EPSILON: f64;

    /// Returns a − b, without error where that is possible.
    fn difference(a: f64, b: f64) -> Self;

    /// Returns the nearest `f64`.
    fn to_f64(self) -> f64;

    /// Returns the circumcentre of a simplex relative to its first vertex.
    fn circumcenter_offset<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> [Self; D]
    where
        Euclidean: Geometry<D, N>;
}

impl Ring for f64 {}

impl Real for f64 {
    const EPSILON: f64 = 8.0 * f64::EPSILON;

    fn difference(a: f64, b: f64) -> Self {
        a - b
    }

    fn to_f64(self) -> f64 {
        self
    }

    fn circumcenter_offset<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> [Self; D]
    where
        Euclidean: Geometry<D, N>,
    {
        circumcenter_offset(simplex)
    }
}

/// A number as the sum of two that do not overlap: twice the precision (Dekker, *A floating-point
/// technique for extending the available precision*, 1971).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// Returns a + b without error.
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Double { high, low: (a - (high - part)) + (b - part) }
    }

    /// Returns a + b without error, where |a| ≥ |b|.
    fn ordered_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        Double { high, low: b - (high - a) }
    }

    pub(crate) fn infinity() -> Self {
        Double { high: f64::INFINITY, low: 0.0 }
    }

    /// Returns a·b without error.
    fn product(a: f64, b: f64) -> Self {
        // In halves of 26 bits. A fused multiply-add would do it in one step, but is emulated
        // slowly where there is none.
        let split = |x: f64| {
            let scaled = x * 134_217_729.0;
            let high = scaled - (scaled - x);
            (high, x - high)
        };
        let high = a * b;
        let ((ah, al), (bh, bl)) = (split(a), split(b));
        Double { high, low: ((ah * bh - high) + ah * bl + al * bh) + al * bl }
    }

    /// Returns the quotient, with a relative error below 2⁻⁹⁷.
    fn over(self, divisor: Self) -> Self {
        let high = self.high / divisor.high;
        let rest = self - divisor * Double { high, low: 0.0 };
        Double::ordered_sum(high, rest.high / divisor.high)
    }

    /// Returns `numerator` / `denominator` · 2ᵉ; the denominator must be positive.
    pub(crate) fn quotient(numerator: &Big, denominator: &Big, exponent: i32) -> Self {
        let high = quotient(numerator, denominator, exponent);
        if !high.is_finite() {
            return Double { high, low: 0.0 };
        }
        // What the first half leaves.
        let (mantissa, e) = decompose(high);
        let mantissa = Big::from(if high < 0.0 { -(mantissa as i64) } else { mantissa as i64 });
        let lowest = e.min(exponent);
        let shift = |e: i32| (e - lowest) as u32;
        let rest = (numerator.clone() << shift(exponent)) - ((&mantissa * denominator) << shift(e));
        Double { high, low: quotient(&rest, denominator, lowest) }
    }
}

impl From<i32> for Double {
    fn from(x: i32) -> Self {
        Double { high: x.into(), low: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (Double::sum(self.high, other.high), Double::sum(self.low, other.low));
        let carried = Double::ordered_sum(high.high, high.low + low.high);
        Double::ordered_sum(carried.high, carried.low + low.low)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Double { high: -other.high, low: -other.low }
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = Double::product(self.high, other.high);
        Double::ordered_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Ring for Double {}

impl Real for Double {
    // 2⁻¹⁰⁰.
    const EPSILON: f64 = f64::from_bits((1023 - 100) << 52);

    fn difference(a: f64, b: f64) -> Self {
        Double::sum(a, -b)
    }

    fn to_f64(self) -> f64 {
        self.high
    }

    fn circumcenter_offset<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> [Self; D]
    where
        Euclidean: Geometry<D, N>,
    {
        exact_offset::<D, N, D>(simplex, Euclidean::circumcenter_fraction)
            .map_or([Double::infinity(); D], |(numerator, denominator, exponent)| {
                numerator.map(|x| Double::quotient(&x, &denominator, exponent))
            })
    }
}

/// Returns the circumcentre of a simplex relative to its first vertex, correctly rounded, if twice the
/// precision tells to which number.
///
/// With ε = 2⁻¹⁰⁰, the product P of the lengths of the edges from the first vertex and their sum S, the
/// numerators have errors below 16·ε·P·S: their terms add up to at most P·S, and none has more than
/// eight roundings. The denominator has one below 32·ε·P, as six roundings and at most 2·√3·P show. So
/// the quotient q has one below ε·P·(16·S + 32·|q|)/|denominator|, and twice that if q is the one that was
/// computed; the division adds 2⁻⁹⁷·|q|.
pub(super) fn rounded_circumcenter_offset<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> Option<[f64; D]>
where
    Euclidean: Geometry<D, N>,
{
    let edges: [[Double; D]; D] =
        std::array::from_fn(|i| std::array::from_fn(|axis| Double::difference(simplex[i + 1][axis], simplex[0][axis])));
    let lengths = edges.map(|edge| edge.iter().map(|x| x.high * x.high).sum::<f64>().sqrt());
    // No product, and no error of one, comes near the limits of `f64`.
    if !lengths.iter().all(|length| (1e-30..1e30).contains(length)) {
        return None;
    }
    let (product, sum) = (lengths.iter().product::<f64>(), lengths.iter().sum::<f64>());
    let (numerators, denominator) = Euclidean::circumcenter_fraction(&edges);
    let unit = Double::EPSILON * product / denominator.high.abs();
    // Also if the denominator is 0.
    if unit.is_nan() || unit > 1.0 / 64.0 {
        return None;
    }
    let mut center = [0.0; D];
    for (x, numerator) in center.iter_mut().zip(numerators) {
        let quotient = numerator.over(denominator);
        let size = quotient.high.abs();
        let error = 2.0 * unit * (16.0 * sum + 32.0 * size) + 8.0 * Double::EPSILON * size;
        let is_certain = |low: f64| quotient.high + low == quotient.high;
        // Twice the error, since the sums are rounded.
        if !is_certain(quotient.low - 2.0 * error) || !is_certain(quotient.low + 2.0 * error) {
            return None;
        }
        *x = quotient.high;
    }
    Some(center)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::big::tests::oracle;
    use num_bigint::BigInt;
    use proptest::prelude::*;

    /// Returns the number times 2⁴⁰⁰.
    fn exact(x: Double) -> BigInt {
        [x.high, x.low].map(|x| oracle(&Big::new(x, -400))).iter().sum()
    }

    /// A number of about 100 bits.
    fn double() -> impl Strategy<Value = Double> {
        (-(1i64 << 53)..1 << 53, -(1i64 << 52)..1 << 52, -60i32..60).prop_map(|(high, low, e)| {
            let scale = 2f64.powi(e);
            Double::sum(high as f64 * scale, low as f64 * scale * 2f64.powi(-53))
        })
    }

    proptest! {
        #[test]
        fn operations_have_twice_the_precision(a in double(), b in double()) {
            let near = |found: Double, expected: BigInt, largest: BigInt| {
                (exact(found) - expected).magnitude() << 100u32 <= *largest.magnitude()
            };
            let (x, y) = (exact(a), exact(b));
            prop_assert!(near(a + b, &x + &y, &x + &y));
            prop_assert!(near(a - b, &x - &y, &x - &y));
            let product = (&x * &y) >> 400u32;
            prop_assert!(near(a * b, product.clone(), product));
        }

        #[test]
        fn circumcentres_are_rounded_as_exact_ones(
            corners in prop::array::uniform4(prop::array::uniform3(-(1i32 << 24)..1 << 24)),
            heights in prop::array::uniform4(-4i32..4),
            scale in -20i32..20,
        ) {
            // Four points that are nearly in a plane.
            let unit = 2f64.powi(scale);
            let mut corners = corners.map(|p| p.map(|x| f64::from(x) * unit));
            for (p, height) in corners.iter_mut().zip(heights) {
                p[2] = 0.25 * p[0] - 0.5 * p[1] + f64::from(height) * unit;
            }
            let exact = exact_offset::<3, 4, 3>(&corners, Euclidean::circumcenter_fraction);
            if let Some(center) = rounded_circumcenter_offset(&corners) {
                prop_assert_eq!(center, crate::geometry::rounded(exact));
            }
            let [a, b, c, _] = corners.map(|[x, y, _]| [x, y]);
            let exact = exact_offset::<2, 3, 2>(&[a, b, c], Euclidean::circumcenter_fraction);
            if let Some(center) = rounded_circumcenter_offset(&[a, b, c]) {
                prop_assert_eq!(center, crate::geometry::rounded(exact));
            }
        }

        #[test]
        fn quotients_have_twice_the_precision(a in -(1i64 << 60)..1 << 60, b in 1i64..1 << 60, e in -40i32..40) {
            let found = exact(Double::quotient(&a.into(), &b.into(), e));
            let expected = (BigInt::from(a) << (400 + e)) / b;
            prop_assert!((found - &expected).magnitude() << 100u32 <= *expected.magnitude());
        }
    }
}
