//! Arithmetic with vectors of `f64`.
//!
//! Loops instead of `map` and `from_fn`, which are not always inlined.

/// Returns a − b.
#[inline(always)]
pub(crate) fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    let mut difference = a;
    for axis in 0..D {
        difference[axis] -= b[axis];
    }
    difference
}

/// Returns a + b.
#[inline(always)]
pub(crate) fn plus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    let mut sum = a;
    for axis in 0..D {
        sum[axis] += b[axis];
    }
    sum
}

/// Returns s·a.
#[inline(always)]
pub(crate) fn times<const D: usize>(s: f64, a: [f64; D]) -> [f64; D] {
    let mut product = a;
    for coordinate in &mut product {
        *coordinate *= s;
    }
    product
}

/// Returns the points relative to an origin.
#[inline(always)]
pub(crate) fn relative<const D: usize, const N: usize>(points: &[[f64; D]; N], origin: [f64; D]) -> [[f64; D]; N] {
    let mut rows = *points;
    for row in &mut rows {
        *row = minus(*row, origin);
    }
    rows
}

/// Returns the dot product.
#[inline(always)]
pub(crate) fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    let mut sum = a[0] * b[0];
    for axis in 1..D {
        sum += a[axis] * b[axis];
    }
    sum
}

/// Returns the squared length.
#[inline(always)]
pub(crate) fn squared_norm<const D: usize>(a: [f64; D]) -> f64 {
    dot(a, a)
}

/// Returns the length.
#[inline(always)]
pub(crate) fn norm<const D: usize>(a: [f64; D]) -> f64 {
    let squared = squared_norm(a);
    if (1e-280..1e280).contains(&squared) {
        return squared.sqrt();
    }
    // Out of the range in which squares neither overflow nor lose bits.
    let largest = a.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    largest * squared_norm(a.map(|x| x / largest)).sqrt()
}

/// Returns the nearest integer, of two the even one, if the number is below 2⁵¹; else about the number.
/// Unlike `libm::rint`, this is two additions.
#[inline(always)]
pub(crate) fn rounded(x: f64) -> f64 {
    // From 2⁵² on, all numbers are integers.
    const INTEGERS: f64 = (3u64 << 51) as f64;
    (x + INTEGERS) - INTEGERS
}

/// Returns the cross product.
#[inline(always)]
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the determinant of two vectors in the plane: twice the area between them, positive if b is to the left of a.
#[inline(always)]
pub(crate) fn cross2d(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Returns a power of two that makes the largest extent of a box neither large nor small: 1 unless
/// it is.
pub(crate) fn scale_of<const D: usize>([low, high]: [[f64; D]; 2]) -> f64 {
    let largest = (0..D).map(|axis| (high[axis] / 2.0 - low[axis] / 2.0).abs()).fold(0.0, f64::max);
    if largest == 0.0 || !largest.is_finite() || (1e-30..1e30).contains(&largest) {
        return 1.0;
    }
    // The exponent of what is subnormal is taken for the lowest one. Both extremes stay powers of
    // two that are normal.
    let exponent = (largest.to_bits() >> 52) as i64 - 1023;
    f64::from_bits(((1023 - exponent).clamp(1, 2046) as u64) << 52)
}
