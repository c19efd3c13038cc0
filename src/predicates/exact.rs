//! Predicates for `f64` coordinates of any size, without a lattice.
//!
//! Shewchuk's adaptive expansions (the `robust` crate) are exact as long as no intermediate result
//! overflows or underflows. Where the exponents do not rule that out, big integers decide.

use crate::predicates::{
    Sign,
    big::{Big, common_exponent},
    polynomial::{Ring, WeightedPolynomial, dot, minus, weighted_sign},
};
use robust::{Coord, Coord3D};
use std::ops::Add;

/// Returns whether no product of five differences, nor any of its rounding errors, leaves the range
/// of `f64`.
///
/// Every coordinate must be 0 or have a magnitude from 2⁻¹⁴⁰ to 2¹⁸⁷. Then their last bits are at
/// 2⁻¹⁹³ or above, so a product of five has its last bit at 2⁻⁹⁶⁵ or above, and the determinants
/// stay below 2¹⁰⁰⁰.
pub(crate) fn expansions_are_exact<const D: usize>(points: &[[f64; D]]) -> bool {
    const MIN: f64 = 1.0 / (1u128 << 127) as f64 / 8192.0;
    const MAX: f64 = (1u128 << 127) as f64 * (1u64 << 60) as f64;
    points.as_flattened().iter().all(|&x| x == 0.0 || (MIN..=MAX).contains(&x.abs()))
}

/// Returns the sign of a floating-point number.
fn sign(value: f64) -> Sign {
    (value > 0.0) as Sign - (value < 0.0) as Sign
}

/// Returns the sign of the determinant whose rows are the differences to the last point, each after
/// its squared length if they are `lifted`, in big integers.
///
/// The code is large and rarely used, so it is compiled once for all predicates.
fn big_sign(points: &[&[f64]], lifted: bool) -> Sign {
    // All coordinates are multiplied by the same power of two.
    let exponent = common_exponent(points.iter().copied().flatten());
    let Some((last, others)) = points.split_last() else { return 0 };
    let rows: Vec<Vec<Big>> = others
        .iter()
        .map(|p| {
            let difference = |(&x, &y)| Big::new(x, exponent) - Big::new(y, exponent);
            let mut row: Vec<Big> = p.iter().zip(*last).map(difference).collect();
            if lifted {
                row.insert(0, row.iter().map(|x| x * x).fold(Big::default(), Add::add));
            }
            row
        })
        .collect();
    determinant(&rows.iter().map(Vec::as_slice).collect::<Vec<_>>()).sign()
}

/// Returns the sign of the in-sphere or in-circle determinant of weighted points, exactly, for all finite coordinates and
/// weights: positive if the last of D + 2 points, lifted to the height |p|² − w, is below the lifted simplex of the
/// others, which is positively oriented.
pub fn power_sign<const D: usize, const N: usize>(points: [[f64; D]; N], weights: [f64; N]) -> Sign {
    weighted_sign(&PowerDeterminant, &points, &weights)
}

/// The determinant whose rows are the differences to the last point, each after its lifted height.
struct PowerDeterminant;

impl<const D: usize, const N: usize> WeightedPolynomial<N, D> for PowerDeterminant {
    fn value<T: Ring>(&self, points: &[[T; D]; N], weights: &[T; N]) -> T {
        let rows: [[T; D]; N] = std::array::from_fn(|i| minus(&points[i], &points[N - 1]));
        let mut sum = T::from(0);
        // The last difference is 0.
        for i in 0..=D {
            let others: [&[T; D]; D] = std::array::from_fn(|k| &rows[k + usize::from(k >= i)]);
            let lift = dot(&rows[i], &rows[i]) - (weights[i].clone() - weights[N - 1].clone());
            let term = lift * volume(others);
            sum = if i % 2 == 0 { sum + term } else { sum - term };
        }
        sum
    }
}

/// Returns the determinant of two vectors in 2D, or three in 3D.
fn volume<T: Ring, const D: usize>(rows: [&[T; D]; D]) -> T {
    let at = |i: usize, axis: usize| rows[i % D][axis % D].clone();
    let minor = |j: usize, k: usize| at(D - 2, j) * at(D - 1, k) - at(D - 2, k) * at(D - 1, j);
    if D == 2 {
        return minor(0, 1);
    }
    at(0, 0) * minor(1, 2) + at(0, 1) * minor(2, 0) + at(0, 2) * minor(0, 1)
}

/// Returns the determinant, by the cofactors of the first column.
fn determinant(rows: &[&[Big]]) -> Big {
    let [only] = rows else {
        let mut sum = Big::default();
        for (i, row) in rows.iter().enumerate() {
            let others = rows.iter().enumerate().filter(|&(j, _)| j != i);
            let term = &row[0] * &determinant(&others.map(|(_, row)| &row[1..]).collect::<Vec<_>>());
            sum = if i % 2 == 0 { sum + term } else { sum - term };
        }
        return sum;
    };
    only[0].clone()
}

/// Returns the sign of det(b − a, c − a), exactly, for all finite coordinates: positive if a, b, c
/// turn counter-clockwise with *y* up, zero if they lie on a line.
///
/// # Examples
///
/// ```
/// assert_eq!(gdel::orient2d([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]), 1);
/// // Rounded arithmetic would see a triangle here.
/// assert_eq!(gdel::orient2d([0.1, 0.1], [0.3, 0.3], [0.7, 0.7]), 0);
/// ```
pub fn orient2d(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    if expansions_are_exact(&[a, b, c]) { orient2d_by_expansions(a, b, c) } else { big_sign(&[&b, &c, &a], false) }
}

/// Returns [`orient2d`] of points whose [expansions are exact](expansions_are_exact).
pub(crate) fn orient2d_by_expansions(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    let [a, b, c] = [a, b, c].map(|[x, y]| Coord { x, y });
    sign(robust::orient2d(a, b, c))
}

/// Returns 1 if d is inside the circle through the counter-clockwise a, b, c, 0 if it is on it, −1
/// if it is outside; exactly, for all finite coordinates. The sign changes with the orientation of
/// a, b, c.
///
/// # Examples
///
/// ```
/// let [a, b, c] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
/// assert_eq!(gdel::incircle(a, b, c, [0.5, 0.5]), 1);
/// assert_eq!(gdel::incircle(a, b, c, [0.0, 1.0]), 0);
/// assert_eq!(gdel::incircle(a, b, c, [0.0, 1.0f64.next_up()]), -1);
/// ```
pub fn incircle(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> Sign {
    if expansions_are_exact(&[a, b, c, d]) {
        return incircle_by_expansions(a, b, c, d);
    }
    big_sign(&[&a, &b, &c, &d], true)
}

/// Returns [`incircle`] of points whose [expansions are exact](expansions_are_exact).
pub(crate) fn incircle_by_expansions(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> Sign {
    let [a, b, c, d] = [a, b, c, d].map(|[x, y]| Coord { x, y });
    sign(robust::incircle(a, b, c, d))
}

/// Returns the sign of det(b − a, c − a, d − a), exactly, for all finite coordinates: positive if
/// a, b, c turn counter-clockwise as seen from d, zero if all lie on a plane. (Shewchuk's
/// `orient3d` has the opposite sign.)
///
/// # Examples
///
/// ```
/// let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// assert_eq!(gdel::orient3d(a, b, c, [0.0, 0.0, 1.0]), 1);
/// assert_eq!(gdel::orient3d(a, b, c, [5.0, 5.0, 0.0]), 0);
/// assert_eq!(gdel::orient3d(a, b, c, [5.0, 5.0, -1e-300]), -1);
/// ```
pub fn orient3d(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Sign {
    if expansions_are_exact(&[a, b, c, d]) {
        let [a, b, c, d] = [a, b, c, d].map(|[x, y, z]| Coord3D { x, y, z });
        return -sign(robust::orient3d(a, b, c, d));
    }
    big_sign(&[&b, &c, &d, &a], false)
}

/// Returns 1 if e is inside the sphere through the positively oriented a, b, c, d, 0 if it is on
/// it, −1 if it is outside; exactly, for all finite coordinates. The sign changes with the
/// orientation of a, b, c, d: see [`orient3d`].
///
/// # Examples
///
/// ```
/// let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// assert_eq!(gdel::insphere(a, b, c, d, [0.5, 0.5, 0.5]), 1);
/// assert_eq!(gdel::insphere(a, b, c, d, [1.0, 1.0, 1.0]), 0);
/// assert_eq!(gdel::insphere(a, b, c, d, [1.0, 1.0, 1.0f64.next_up()]), -1);
/// ```
pub fn insphere(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3], e: [f64; 3]) -> Sign {
    if expansions_are_exact(&[a, b, c, d, e]) {
        let [a, b, c, d, e] = [a, b, c, d, e].map(|[x, y, z]| Coord3D { x, y, z });
        return -sign(robust::insphere(a, b, c, d, e));
    }
    big_sign(&[&a, &b, &c, &d, &e], true)
}

/// Returns whether three points lie on a line, exactly, for all finite coordinates.
pub fn collinear(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> bool {
    [(0, 1), (1, 2), (2, 0)].iter().all(|&(i, j)| orient2d([a[i], a[j]], [b[i], b[j]], [c[i], c[j]]) == 0)
}
