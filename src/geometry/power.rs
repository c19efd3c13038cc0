//! Weighted points: power distances |q − p|² − w, and power centres, which have the same one to all vertices of a
//! simplex.

use super::{
    ABSOLUTE_MARGIN, Euclidean, Fraction, Geometry, RELATIVE_MARGIN, compare_distances, edges, positive, vector,
};
use crate::predicates::{
    Sign,
    big::Big,
    polynomial::{Ring, WeightedPolynomial, dot, minus, weighted_exponent, weighted_sign},
};

/// A point, its weight, and its power distance to another point, rounded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Power<const D: usize> {
    point: [f64; D],
    weight: f64,
    distance: f64,
    /// The sum of the terms' magnitudes.
    magnitude: f64,
}

impl<const D: usize> Power<D> {
    #[inline(always)]
    pub(crate) fn new(q: [f64; D], point: [f64; D], weight: f64) -> Self {
        let squared = vector::squared_norm(vector::minus(q, point));
        Power { point, weight, distance: squared - weight, magnitude: squared + weight.abs() }
    }

    /// Returns the sign of the difference of two power distances to the same point, exactly.
    #[inline(always)]
    pub(crate) fn compare(&self, other: &Self, q: [f64; D]) -> Sign {
        // As for distances, with one rounding more, by what is subtracted. Where anything is infinite, or NaN, neither
        // is certain.
        let margin = RELATIVE_MARGIN * (self.magnitude + other.magnitude) + ABSOLUTE_MARGIN;
        let difference = self.distance - other.distance;
        match (difference > margin) as Sign - (difference < -margin) as Sign {
            0 if self.weight == other.weight => compare_distances(q, self.point, other.point),
            0 => {
                let points = [q, self.point, other.point];
                weighted_sign(&PowerDifference, &points, &[0.0, self.weight, other.weight])
            }
            sign => sign,
        }
    }
}

/// For the points q, a and b: |q − a|² − wₐ − (|q − b|² − w_b).
struct PowerDifference;

impl<const D: usize> WeightedPolynomial<3, D> for PowerDifference {
    fn value<T: Ring>(&self, [q, a, b]: &[[T; D]; 3], [_, of_a, of_b]: &[T; 3]) -> T {
        let (to_a, to_b) = (minus(q, a), minus(q, b));
        (dot(&to_a, &to_a) - of_a.clone()) - (dot(&to_b, &to_b) - of_b.clone())
    }
}

/// For the points a, b and c of a line, of which b is between the others along an axis: negative if b, lifted to the
/// height |b|² − w, is above the segment from a to c.
struct HeightOnLine {
    axis: usize,
}

impl WeightedPolynomial<3, 3> for HeightOnLine {
    fn value<T: Ring>(&self, [a, b, c]: &[[T; 3]; 3], [of_a, of_b, of_c]: &[T; 3]) -> T {
        // Relative to b. A function that is linear along the line has been subtracted from the heights.
        let (u, v) = (minus(a, b), minus(c, b));
        let height = |u: &[T; 3], weight: &T| dot(u, u) - (weight.clone() - of_b.clone());
        height(&u, of_a) * v[self.axis].clone() - height(&v, of_c) * u[self.axis].clone()
    }
}

/// Returns 1 if the second of three points, in the order of their coordinate along an axis, is below the segment
/// between the others when all are lifted, 0 if it is on it, −1 if it is above; exactly. The points must be on a line.
pub(crate) fn below_on_line(points: [[f64; 3]; 3], weights: [f64; 3], axis: usize) -> Sign {
    weighted_sign(&HeightOnLine { axis }, &points, &weights)
}

/// Returns the power centre of a simplex relative to its first vertex. `differences` are those of the other vertices'
/// weights to the first one's, rounded; `exactly` returns the result without them.
///
/// The error is at most 2⁻³⁷ times the sum of the distance and the longest edge from the first vertex, however flat the
/// simplex is. Coordinates beyond the range of `f64` are infinite.
///
/// With ε = 2⁻⁵³, the lengths of the edges and their product P, the squares have errors below 8·ε·(|u|² + |Δw|), and
/// the normals that they are multiplied by three roundings, and are no longer than the product of the other lengths. So
/// the numerators have errors below 20·ε·P·M, where M is the sum of (|u|² + |Δw|)/|u|, and the denominator, which is
/// twice the determinant, below 40·ε·P. The centre c has one below 32·ε·P·(M + 2·|c|)/|det|.
pub(crate) fn power_center_offset<const D: usize, const N: usize>(
    simplex: &[[f64; D]; N],
    differences: [f64; D],
    exactly: impl FnOnce() -> [f64; D],
) -> [f64; D]
where
    Euclidean: Geometry<D, N>,
{
    let edges = edges(simplex);
    let squares = edges.map(vector::squared_norm);
    let is_safe = |x: f64| (1e-80..1e80).contains(&x);
    if !squares.iter().all(|&square| is_safe(square)) || !differences.iter().all(|&w| w == 0.0 || is_safe(w.abs())) {
        return exactly();
    }
    let mut lifted = squares;
    let (mut product, mut sum, mut longest) = (1.0, 0.0, 0.0f64);
    for k in 0..D {
        let length = squares[k].sqrt();
        lifted[k] -= differences[k];
        product *= length;
        sum += (squares[k] + differences[k].abs()) / length;
        longest = longest.max(length);
    }
    let (numerator, denominator) = Euclidean::center_fraction(&edges, &lifted);
    let center = numerator.map(|x| x / denominator);
    let distance = vector::norm(center);
    // Not if the determinant is 0, or too small.
    if product * (sum + 2.0 * distance) <= 1024.0 * denominator.abs() * (longest + distance) {
        return center;
    }
    exactly()
}

/// Returns the power centre of a simplex relative to its first vertex, times 2ᵉ, correctly rounded unless a coordinate
/// is subnormal.
#[inline(never)]
pub(crate) fn exact_power_center_offset<const D: usize, const N: usize>(
    simplex: &[[f64; D]; N],
    weights: &[f64; N],
    e: i32,
) -> [f64; D]
where
    Euclidean: Geometry<D, N>,
{
    let exponent = weighted_exponent(simplex.as_flattened(), weights);
    let integers = simplex.map(|p| p.map(|x| Big::new(x, exponent)));
    let weights = weights.map(|w| Big::new(w, 2 * exponent));
    let edges: [[Big; D]; D] = std::array::from_fn(|i| minus(&integers[i + 1], &integers[0]));
    let squares = std::array::from_fn(|i| dot(&edges[i], &edges[i]) - (weights[i + 1].clone() - weights[0].clone()));
    let (numerator, denominator) = Euclidean::center_fraction(&edges, &squares);
    let fraction: Option<Fraction<D>> = positive(numerator, denominator, exponent + e);
    super::rounded(fraction)
}
