//! Signs for `f64` coordinates of any size, without a lattice.
//!
//! Shewchuk's adaptive expansions (the `robust` crate) are exact as long as no intermediate result over- or underflows.
//! Where the exponents do not rule that out, big integers decide.

use super::Sign;
use crate::lattice::decompose;
use num_bigint::BigInt;
use robust::{Coord, Coord3D};

/// The coordinates for which no product of five differences, nor any of its rounding errors, leaves the range of `f64`:
/// their last bits are at 2⁻¹⁹³ or above, so a product of five has its last bit at 2⁻⁹⁶⁵ or above, and the determinants
/// stay below 2¹⁰⁰⁰.
fn expansions_are_exact<const D: usize>(points: &[[f64; D]]) -> bool {
    const LEAST: f64 = 1.0 / (1u128 << 127) as f64 / 8192.0;
    const MOST: f64 = (1u128 << 127) as f64 * (1u64 << 60) as f64;
    points.as_flattened().iter().all(|&x| x == 0.0 || (LEAST..=MOST).contains(&x.abs()))
}

fn sign(value: f64) -> Sign {
    (value > 0.0) as Sign - (value < 0.0) as Sign
}

/// The coordinates as integers, all multiplied by the same power of two.
fn big<const D: usize, const N: usize>(points: [[f64; D]; N]) -> [[BigInt; D]; N] {
    let nonzero = points.as_flattened().iter().filter(|x| **x != 0.0);
    let least = nonzero.map(|&x| decompose(x).1).min().unwrap_or(0);
    points.map(|p| {
        p.map(|x| {
            let (mantissa, exponent) = decompose(x);
            if mantissa == 0 {
                return BigInt::ZERO;
            }
            let magnitude = BigInt::from(mantissa) << (exponent - least);
            if x < 0.0 { -magnitude } else { magnitude }
        })
    })
}

fn big_sign(value: &BigInt) -> Sign {
    match value.sign() {
        num_bigint::Sign::Minus => -1,
        num_bigint::Sign::NoSign => 0,
        num_bigint::Sign::Plus => 1,
    }
}

fn minus<const D: usize>(a: &[BigInt; D], b: &[BigInt; D]) -> [BigInt; D] {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn dot<const D: usize>(a: &[BigInt; D]) -> BigInt {
    a.iter().map(|x| x * x).sum()
}

fn det2(a: &[BigInt; 2], b: &[BigInt; 2]) -> BigInt {
    &a[0] * &b[1] - &a[1] * &b[0]
}

fn det3(a: &[BigInt; 3], b: &[BigInt; 3], c: &[BigInt; 3]) -> BigInt {
    &a[0] * (&b[1] * &c[2] - &b[2] * &c[1]) - &a[1] * (&b[0] * &c[2] - &b[2] * &c[0])
        + &a[2] * (&b[0] * &c[1] - &b[1] * &c[0])
}

/// The sign of det(b − a, c − a), exactly, for all finite coordinates: positive when a, b, c turn counter-clockwise.
pub fn orient2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    if expansions_are_exact(&[a, b, c]) {
        let [a, b, c] = [a, b, c].map(|[x, y]| Coord { x, y });
        return sign(robust::orient2d(a, b, c));
    }
    let [a, b, c] = big([a, b, c]);
    big_sign(&det2(&minus(&b, &a), &minus(&c, &a)))
}

/// Positive when d is inside the circle through the counter-clockwise a, b, c; exactly, for all finite coordinates.
pub fn incircle(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> Sign {
    if expansions_are_exact(&[a, b, c, d]) {
        let [a, b, c, d] = [a, b, c, d].map(|[x, y]| Coord { x, y });
        return sign(robust::incircle(a, b, c, d));
    }
    let [a, b, c, d] = big([a, b, c, d]);
    let [a, b, c] = [minus(&a, &d), minus(&b, &d), minus(&c, &d)];
    big_sign(&(dot(&a) * det2(&b, &c) - dot(&b) * det2(&a, &c) + dot(&c) * det2(&a, &b)))
}

/// The sign of det(b − a, c − a, d − a), exactly, for all finite coordinates.
pub fn orient3d(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Sign {
    if expansions_are_exact(&[a, b, c, d]) {
        let [a, b, c, d] = [a, b, c, d].map(|[x, y, z]| Coord3D { x, y, z });
        return -sign(robust::orient3d(a, b, c, d));
    }
    let [a, b, c, d] = big([a, b, c, d]);
    big_sign(&det3(&minus(&b, &a), &minus(&c, &a), &minus(&d, &a)))
}

/// Positive when e is inside the sphere through the positively oriented a, b, c, d; exactly, for all finite coordinates.
pub fn insphere(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3], e: [f64; 3]) -> Sign {
    if expansions_are_exact(&[a, b, c, d, e]) {
        let [a, b, c, d, e] = [a, b, c, d, e].map(|[x, y, z]| Coord3D { x, y, z });
        return -sign(robust::insphere(a, b, c, d, e));
    }
    let [a, b, c, d, e] = big([a, b, c, d, e]);
    let [a, b, c, d] = [a, b, c, d].map(|p| minus(&p, &e));
    let value = dot(&a) * det3(&b, &c, &d) - dot(&b) * det3(&a, &c, &d) + dot(&c) * det3(&a, &b, &d)
        - dot(&d) * det3(&a, &b, &c);
    big_sign(&value)
}

/// Whether three points lie on a line, exactly, for all finite coordinates.
pub fn collinear(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    [(0, 1), (1, 2), (2, 0)].iter().all(|&(i, j)| orient2d([a[i], a[j]], [b[i], b[j]], [c[i], c[j]]) == 0)
}
