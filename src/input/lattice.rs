//! Coordinates as integers on a common power-of-two lattice.
//!
//! A point's lattice coordinate is `round(x·2ᵏ) − origin`, with one *k* for all axes: the largest
//! for which all coordinates fit. Scaling by 2ᵏ is exact, so nothing is lost except what the
//! rounding drops, and whether it dropped anything is known for each point. 31 bits represent
//! grids, voxels and LAS files exactly; 62 bits represent nearly all `f32` and most `f64` data
//! exactly.
//!
//! Where the axes have very different ranges, a *stretched* lattice with a *k* of its own for each
//! axis rounds fewer points. The CPU's predicates use it in that case.

use crate::{
    error::Error,
    input::points::Points,
    parallel::{self, Threads},
};

/// The number of points that one thread looks at before others share the rest. As a rule they decide.
const FEW: usize = 16;

/// Number of bits that the lattice coordinates of an input need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// Every coordinate is exact in 31 bits: 0 ≤ q < 2³¹.
    Narrow,
    /// Coordinates take 62 bits, 0 ≤ q < 2⁶², and may be rounded.
    Wide,
}

impl Width {
    /// Returns the number of bits per coordinate.
    pub const fn bits(self) -> u32 {
        match self {
            Width::Narrow => 31,
            Width::Wide => 62,
        }
    }
}

/// The lattice of one input of dimension `D`.
#[derive(Debug, Clone)]
pub struct Lattice<const D: usize> {
    width: Width,
    /// *k* of each axis: coordinates are multiplied by 2ᵏ. All are equal, unless the lattice is
    /// stretched.
    exponents: [i32; D],
    /// 2ᵏ if `f64` can represent it, else NaN.
    factors: [f64; D],
    /// The scaled and rounded minimum of each axis, which is subtracted from the coordinates;
    /// `None` for an axis on which all points agree (its lattice coordinates are all 0).
    origin: [Option<i128>; D],
    /// The lower bits of the origin; 0 where there is none.
    lower_origin: [i64; D],
    /// Whether no coordinate exceeds 2⁶² before the origin is subtracted.
    is_near: bool,
    /// The minimum and the maximum of each axis.
    bounds: [[f64; D]; 2],
}

/// A lattice coordinate, and whether it represents the input's coordinate exactly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coordinate {
    /// 0 ≤ value < 2ᵇⁱᵗˢ for the [`Width::bits`] of the lattice.
    pub value: i64,
    /// Whether nothing was rounded.
    pub exact: bool,
}

/// Returns (`mantissa`, `exponent`) with |x| = `mantissa`·2^`exponent`, for finite `x`; the
/// mantissa is odd, or 0 for 0.
pub(crate) fn decompose(x: f64) -> (u64, i32) {
    let bits = x.to_bits();
    let biased = (bits >> 52 & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    if mantissa == 0 {
        return (0, 0);
    }
    let zeros = mantissa.trailing_zeros();
    (mantissa >> zeros, exponent + zeros as i32)
}

/// Returns `round(x·2^exponent)`, halves rounded up, and whether it is exact.
///
/// The result must fit, which |x|·2^exponent < 2¹²⁶ ensures. A right shift by more than 100 bits
/// rounds any 53-bit mantissa to 0.
fn scale(x: f64, exponent: i32) -> (i128, bool) {
    let (mantissa, e) = decompose(x);
    if mantissa == 0 {
        return (0, true);
    }
    let signed = if x < 0.0 { -i128::from(mantissa) } else { i128::from(mantissa) };
    match e + exponent {
        shift @ 0.. => (signed << shift, true),
        shift @ -100..0 => ((signed + (1 << (-shift - 1))) >> -shift, false),
        _ => (0, false),
    }
}

impl<const D: usize> Lattice<D> {
    /// Returns the lattice of `points`.
    ///
    /// # Panics
    ///
    /// Panics if a coordinate is not finite.
    pub fn fit(points: Points<'_, D>) -> Self {
        Lattice::fit_by(Threads::One, points).expect("the points have been checked")
    }

    /// Returns the lattice of `points`, computed by `threads`.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotFinite`] with the first point that has a coordinate that is not finite.
    pub(crate) fn fit_by(threads: Threads, points: Points<'_, D>) -> Result<Self, Error> {
        Ok(Lattice::fit_to(threads, points, points.finite_bounds(threads)?))
    }

    /// Returns the lattice of finite `points` with these bounds, computed by `threads`.
    pub(crate) fn fit_to(threads: Threads, points: Points<'_, D>, bounds: [[f64; D]; 2]) -> Self {
        let narrow = Lattice::of_bounds(Width::Narrow, bounds);
        let is_exact = |p| !narrow.rounds(p);
        let all_exact = |range| points.range(range).iter().all(is_exact);
        // Other threads need not wake up where one of the first points decides.
        let is_narrow = all_exact(0..points.len().min(FEW))
            && parallel::map_ranges(threads, points.len(), all_exact).into_iter().all(|exact| exact);
        if is_narrow { narrow } else { narrow.widened() }
    }

    /// Returns the lattice of `points` with these weights, all of which have been checked, computed by `threads`: a
    /// narrow one only if it rounds no weight either.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotFinite`] with the first point that has a coordinate that is not finite.
    pub(crate) fn fit_weighted(threads: Threads, points: Points<'_, D>, weights: &[f64]) -> Result<Self, Error> {
        let lattice = Lattice::fit_by(threads, points)?;
        let is_exact = |&w: &f64| lattice.weight(w, 2 * Width::Narrow.bits()).is_some();
        let is_wide = lattice.width == Width::Narrow && !weights.iter().all(is_exact);
        Ok(if is_wide { lattice.widened() } else { lattice })
    }

    /// Returns the lattice's integer for a weight, w·2²ᵏ, if it is one of at most so many bits. All axes must have the
    /// same *k*.
    pub(crate) fn weight(&self, w: f64, bits: u32) -> Option<i128> {
        let (mantissa, e) = decompose(w);
        if mantissa == 0 {
            return Some(0);
        }
        // The mantissa is odd.
        let shift = e + 2 * self.exponent();
        let length = shift + (u64::BITS - mantissa.leading_zeros()) as i32;
        (shift >= 0 && length <= bits as i32).then(|| {
            let magnitude = i128::from(mantissa) << shift;
            if w < 0.0 { -magnitude } else { magnitude }
        })
    }

    /// Returns the wide lattice of the same points.
    pub(crate) fn widened(&self) -> Self {
        Lattice::of_bounds(Width::Wide, self.bounds)
    }

    fn of_bounds(width: Width, [low, high]: [[f64; D]; 2]) -> Self {
        let varies: [bool; D] = std::array::from_fn(|axis| low[axis] < high[axis]);
        let fitting = |axis: usize| largest_exponent(low[axis], high[axis], width.bits());
        let exponent = (0..D).filter(|&axis| varies[axis]).map(fitting).min().unwrap_or(0);
        Lattice::with_exponents(width, [exponent; D], varies, [low, high])
    }

    fn with_exponents(width: Width, exponents: [i32; D], varies: [bool; D], bounds: [[f64; D]; 2]) -> Self {
        let scaled = |end: usize, axis: usize| varies[axis].then(|| scale(bounds[end][axis], exponents[axis]).0);
        let origin: [Option<i128>; D] = std::array::from_fn(|axis| scaled(0, axis));
        let ends = (0..D).flat_map(|axis| [origin[axis], scaled(1, axis)]).flatten();
        let is_near = ends.into_iter().all(|end| end.unsigned_abs() <= 1 << 62);
        let lower_origin = origin.map(|origin| origin.unwrap_or(0) as i64);
        let factors = exponents.map(|exponent| match exponent {
            -1000..=1000 => f64::from_bits(((1023 + exponent) as u64) << 52),
            _ => f64::NAN,
        });
        Lattice { width, exponents, factors, origin, lower_origin, is_near, bounds }
    }

    /// Returns a wide lattice of points with these bounds, and the box around them within which it
    /// has coordinates for other points as well, rounded if they are not exact. The box is wider
    /// than the bounds by more than half of the longest axis on each side; it is empty where `f64`
    /// does not represent it.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub(crate) fn with_room(bounds: [[f64; D]; 2]) -> (Self, [[f64; D]; 2]) {
        // The points take the second quarter and a half of the coordinates.
        const BITS: u32 = Width::Wide.bits() - 2;
        const ROOM: i64 = 3 << (BITS - 1);
        let [low, high] = bounds;
        let varies: [bool; D] = std::array::from_fn(|axis| low[axis] < high[axis]);
        let fitting =
            (0..D).filter(|&axis| varies[axis]).map(|axis| largest_exponent(low[axis], high[axis], BITS)).min();
        let exponent = fitting.unwrap_or(0);
        let mut lattice = Lattice::with_exponents(Width::Wide, [exponent; D], varies, bounds);
        lattice.origin = lattice.origin.map(|origin| origin.map(|origin| origin - i128::from(ROOM)));
        lattice.lower_origin = lattice.lower_origin.map(|origin| origin.wrapping_sub(ROOM));
        // Three halves of this are room on each side. What rounding changes is at most half of it,
        // since there are two different coordinates on some axis.
        let extent = libm::ldexp(1.0, BITS as i32 - exponent);
        let room = if extent.is_finite() { 0.875 * extent } else { f64::NEG_INFINITY };
        (lattice, [low.map(|x| x - room), high.map(|x| x + room)])
    }

    /// Returns the wide lattice on which each axis has the largest *k* for which its coordinates
    /// fit, but at most `max_shift` more than the smallest; `None` if all axes have the same.
    pub(crate) fn stretched(&self, max_shift: u32) -> Option<Self> {
        let varies = self.varies();
        let [low, high] = self.bounds;
        let own = |axis: usize| varies[axis].then(|| largest_exponent(low[axis], high[axis], Width::Wide.bits()));
        let own: [Option<i32>; D] = std::array::from_fn(own);
        let min = own.iter().flatten().copied().min()?;
        // On an axis on which all points agree, all coordinates are 0.
        let exponents = own.map(|k| k.unwrap_or(min).min(min + max_shift as i32));
        let is_stretched = exponents.iter().any(|&k| k != min);
        is_stretched.then(|| Lattice::with_exponents(Width::Wide, exponents, varies, self.bounds))
    }

    /// Returns how many bits each axis' coordinates would have to be shifted to the left to have
    /// the same scale.
    pub(crate) fn shifts(&self) -> [u32; D] {
        let max = self.exponents.iter().copied().max().unwrap_or(0);
        self.exponents.map(|k| (max - k) as u32)
    }

    /// Returns the minimum and the maximum of each axis of the input.
    pub fn bounds(&self) -> [[f64; D]; 2] {
        self.bounds
    }

    /// Returns the number of bits of the coordinates.
    pub fn width(&self) -> Width {
        self.width
    }

    /// Returns *k*: one lattice step is 2⁻ᵏ.
    pub fn exponent(&self) -> i32 {
        self.exponents[0]
    }

    /// Returns, for each axis, whether the points differ on it.
    pub fn varies(&self) -> [bool; D] {
        self.origin.map(|o| o.is_some())
    }

    /// Returns `round(x·2ᵏ)` of the minimum of each axis, which is subtracted from all coordinates;
    /// `None` for an axis on which all points agree.
    pub fn origin(&self) -> [Option<i128>; D] {
        self.origin
    }

    /// Returns the lattice coordinates of a point of the input that the narrow lattice was fitted
    /// to.
    ///
    /// On a narrow lattice every coordinate times 2ᵏ is an integer, and so is the difference of
    /// two, which fits into 31 bits: no operation rounds.
    #[inline]
    pub(crate) fn narrow(&self, p: [f64; D]) -> [f64; D] {
        if self.factors[0].is_nan() {
            return self.coordinates(p).map(|c| c.value as f64);
        }
        std::array::from_fn(|axis| match self.origin[axis] {
            None => 0.0,
            Some(_) => p[axis] * self.factors[0] - self.bounds[0][axis] * self.factors[0],
        })
    }

    /// Returns the lattice coordinates of a point of the input that the lattice was fitted to and
    /// does not [round](Self::rounds), from its coordinates times 2ᵏ⁻ᵐ, where *m* is `more`.
    #[inline]
    pub(crate) fn position(&self, scaled: [f64; D], more: u32) -> [i64; D] {
        let factor = (1u64 << more) as f64;
        // Integers, of which the differences need only the lower bits.
        let lower = |x: f64| if self.is_near { x as i64 } else { x as i128 as i64 };
        std::array::from_fn(|axis| lower(scaled[axis] * factor).wrapping_sub(self.lower_origin[axis]))
    }

    /// Returns whether the lattice coordinates of a point of the input that the lattice was fitted
    /// to are rounded.
    #[inline]
    pub(crate) fn rounds(&self, p: [f64; D]) -> bool {
        self.coordinates(p).iter().any(|c| !c.exact)
    }

    /// Returns the lattice coordinates of a point of the input that the lattice was fitted to.
    #[inline]
    pub fn coordinates(&self, p: [f64; D]) -> [Coordinate; D] {
        std::array::from_fn(|axis| match self.origin[axis] {
            None => Coordinate { value: 0, exact: true },
            Some(origin) => {
                // Most coordinates become integers that need no rounding. A NaN factor fails the
                // comparison below.
                let scaled = p[axis] * self.factors[axis];
                let integer = scaled as i64;
                let underflow = integer == 0 && p[axis] != 0.0;
                let (scaled, exact) = if integer as f64 == scaled && integer.unsigned_abs() < 1 << 62 && !underflow {
                    (i128::from(integer), true)
                } else {
                    scale(p[axis], self.exponents[axis])
                };
                Coordinate { value: (scaled - origin) as i64, exact }
            }
        })
    }
}

/// Returns the largest *k* for which `round(high·2ᵏ) − round(low·2ᵏ)` < 2^`bits`, where `low` <
/// `high`.
fn largest_exponent(low: f64, high: f64, bits: u32) -> i32 {
    // The halves never overflow. A subnormal may lose its last bit here, which does no harm: the
    // estimate is only where the search below starts.
    let range = high / 2.0 - low / 2.0;
    let (mantissa, e) = decompose(if range > 0.0 { range } else { f64::from_bits(1) });
    // range·2 has its leading bit at e + bits(mantissa).
    let leading = e + 1 + (64 - mantissa.leading_zeros() as i32);
    let mut k = bits as i32 - leading + 2;
    while {
        let span = scale(high, k).0 - scale(low, k).0;
        span >> bits != 0
    } {
        k -= 1;
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(points: &[[f64; 3]]) -> Lattice<3> {
        let lattice = Lattice::fit(points.into());
        let bits = lattice.width().bits();
        let mut highest = 0;
        for &p in points {
            for c in lattice.coordinates(p) {
                assert!(c.value >= 0 && c.value >> bits == 0, "{p:?} gives {c:?}");
                highest = highest.max(c.value);
            }
        }
        if points.iter().any(|p| p != &points[0]) {
            assert!(highest >> (bits - 2) != 0, "the lattice is coarser than it need be: {highest:#x}");
        }
        lattice
    }

    #[test]
    fn extremes_fit() {
        let values = [0.0, 1.0, -1.0, 1e300, -1e300, f64::MAX, f64::MIN, f64::MIN_POSITIVE, 5e-324, -5e-324, 1e-5];
        for a in values {
            for b in values {
                check(&[[a, b, 1.0], [b, a, 1e9]]);
                check(&[[a, 1e300, 1.0], [b, 1e300, 1.0]]);
            }
        }
    }

    #[test]
    fn grids_are_narrow_and_exact() {
        assert_eq!(check(&[[0.0, 0.0, 0.0], [512.0, 3.0, 5.0]]).width(), Width::Narrow);
        assert_eq!(check(&[[1e7, 5e6, 0.125], [1e7 + 1000.5, 5e6, 17.0]]).width(), Width::Narrow);
        assert_eq!(check(&[[0.1, 0.2, 0.3], [1.0, 1.0, 1.0]]).width(), Width::Wide);
    }

    #[test]
    fn axes_of_different_ranges_are_exact_on_the_stretched_lattice() {
        let at = |i: u32, step: f64| f64::from(i) * step;
        let points: Vec<[f64; 3]> = (0..40).map(|i| [at(i, 1.0), at(i, 1e-3), at(i, 1e6)]).collect();
        let lattice = check(&points);
        let rounded =
            |lattice: &Lattice<3>| points.iter().filter(|&&p| lattice.coordinates(p).iter().any(|c| !c.exact)).count();
        assert!(rounded(&lattice) > 30);
        let stretched = lattice.stretched(64).unwrap();
        assert_eq!(rounded(&stretched), 0);
        for &p in &points {
            assert!(stretched.coordinates(p).iter().all(|c| c.value >= 0 && c.value >> 62 == 0));
        }
        let [x, y, z] = stretched.shifts();
        assert!((z - x, x - y) == (20, 10), "{x} {y} {z}");
        assert!(check(&[[0.0; 3], [1.0; 3]]).stretched(64).is_none());
    }

    #[test]
    fn rounding_is_noticed() {
        let lattice = check(&[[0.0; 3], [1.0; 3], [1e-30, 0.5, 1.0 / 3.0]]);
        assert_eq!(lattice.coordinates([1e-30, 0.5, 1.0 / 3.0]).map(|c| c.exact), [false, true, true]);
    }
}
