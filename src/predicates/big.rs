//! Integers of any size, for coordinates whose exponents lie far apart.
//!
//! The operations are those of school: numbers of more than a few dozen digits are rare, and a library
//! for all sizes takes 9 kB of a WebAssembly module.

use std::{
    iter,
    ops::{Add, Mul, Shl, Sub},
};

use crate::{input::lattice::decompose, predicates::Sign};

/// An integer.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Big {
    /// False for 0.
    is_negative: bool,
    /// The magnitude in base 2⁶⁴, the lowest digit first. The last one is not 0.
    digits: Vec<u64>,
}

impl Big {
    /// Returns `x`·2⁻ᵉ, which must be an integer.
    pub(crate) fn new(x: f64, exponent: i32) -> Self {
        let (mantissa, e) = decompose(x);
        if mantissa == 0 {
            return Big::default();
        }
        Big { is_negative: x < 0.0, digits: vec![mantissa] } << (e - exponent) as u32
    }

    /// Returns the sign.
    pub(crate) fn sign(&self) -> Sign {
        match (self.digits.is_empty(), self.is_negative) {
            (true, _) => 0,
            (false, true) => -1,
            (false, false) => 1,
        }
    }

    /// Returns the number of bits of the magnitude.
    pub(crate) fn bits(&self) -> i64 {
        self.digits.last().map_or(0, |last| 64 * self.digits.len() as i64 - i64::from(last.leading_zeros()))
    }

    /// Returns the magnitude, times the power of two that makes it a number between 1/2 and 1, as the
    /// sum of two numbers with an error below 2⁻¹⁰⁵.
    fn leading(&self) -> [f64; 2] {
        let [a, b, c] = std::array::from_fn(|i| self.digits.len().checked_sub(i + 1).map_or(0, |i| self.digits[i]));
        let shift = a.leading_zeros();
        let next = u128::from(b) << 64 | u128::from(c);
        let top = (u128::from(a) << 64 | next >> 64) << shift | (next << 64 >> 1) >> (127 - shift);
        // One bit less, since it is converted to a signed integer and back.
        let top = (top >> 1) as i128;
        let first = top as f64;
        let rest = (top - first as i128) as f64;
        let unit = 1.0 / (1u128 << 127) as f64;
        [first * unit, rest * unit]
    }

    /// Returns whether the magnitude is less than that of `other`.
    fn is_shorter(&self, other: &Self) -> bool {
        let digits = || self.digits.iter().rev().cmp(other.digits.iter().rev());
        self.digits.len().cmp(&other.digits.len()).then_with(digits).is_lt()
    }

    /// Adds `other`, or subtracts it.
    fn combine(mut self, other: &Self, subtract: bool) -> Self {
        if self.digits.len() < other.digits.len() {
            self.digits.resize(other.digits.len(), 0);
        }
        let is_other_negative = other.is_negative != subtract;
        let is_sum = self.is_negative == is_other_negative;
        let mut carry = false;
        for (x, y) in self.digits.iter_mut().zip(other.digits.iter().copied().chain(iter::repeat(0))) {
            let combine = if is_sum { u64::overflowing_add } else { u64::overflowing_sub };
            let (combined, first) = combine(*x, y);
            let (combined, second) = combine(combined, carry.into());
            (*x, carry) = (combined, first || second);
        }
        if carry && is_sum {
            self.digits.push(1);
        } else if carry {
            // The magnitude of the other number is the larger one.
            self.is_negative = is_other_negative;
            for x in &mut self.digits {
                (*x, carry) = (!*x).overflowing_add(carry.into());
            }
        }
        self.trimmed()
    }

    /// Removes leading zeros.
    fn trimmed(mut self) -> Self {
        while self.digits.last() == Some(&0) {
            self.digits.pop();
        }
        self.is_negative &= !self.digits.is_empty();
        self
    }
}

impl From<i64> for Big {
    fn from(x: i64) -> Self {
        Big { is_negative: x < 0, digits: vec![x.unsigned_abs()] }.trimmed()
    }
}

impl From<i32> for Big {
    fn from(x: i32) -> Self {
        i64::from(x).into()
    }
}

impl Add for Big {
    type Output = Big;
    fn add(self, other: Big) -> Big {
        self.combine(&other, false)
    }
}

impl Sub for Big {
    type Output = Big;
    fn sub(self, other: Big) -> Big {
        self.combine(&other, true)
    }
}

impl Mul for &Big {
    type Output = Big;
    fn mul(self, other: &Big) -> Big {
        let mut digits = vec![0; self.digits.len() + other.digits.len()];
        for (i, &x) in self.digits.iter().enumerate() {
            let mut carry = 0;
            let places = &mut digits[i..];
            for (place, &y) in places.iter_mut().zip(&other.digits) {
                let sum = u128::from(x) * u128::from(y) + u128::from(*place) + u128::from(carry);
                (*place, carry) = (sum as u64, (sum >> 64) as u64);
            }
            places[other.digits.len()] = carry;
        }
        Big { is_negative: self.is_negative != other.is_negative, digits }.trimmed()
    }
}

impl Mul for Big {
    type Output = Big;
    fn mul(self, other: Big) -> Big {
        &self * &other
    }
}

impl Shl<u32> for Big {
    type Output = Big;
    fn shl(mut self, bits: u32) -> Big {
        let mut carry = 0;
        for digit in &mut self.digits {
            let shifted = u128::from(*digit) << (bits % 64);
            (*digit, carry) = (shifted as u64 | carry, (shifted >> 64) as u64);
        }
        self.digits.push(carry);
        if bits >= 64 {
            let mut digits = vec![0; bits as usize / 64];
            digits.append(&mut self.digits);
            self.digits = digits;
        }
        self.trimmed()
    }
}

/// Returns the largest exponent *e* such that all coordinates are integers times 2ᵉ.
pub(crate) fn common_exponent<'a>(coordinates: impl IntoIterator<Item = &'a f64>) -> i32 {
    let exponents = coordinates.into_iter().filter(|x| **x != 0.0).map(|&x| decompose(x).1);
    exponents.min().unwrap_or(0)
}

/// Returns `numerator` / `denominator` · 2ᵉ, correctly rounded unless the result is subnormal;
/// infinite beyond the range of `f64`. The denominator must be positive.
pub(crate) fn quotient(numerator: &Big, denominator: &Big, exponent: i32) -> f64 {
    // Of the same number of bits, so that the quotient is between 1/2 and 2.
    let shift = denominator.bits() - numerator.bits();
    let mut rest = Big { is_negative: false, ..numerator.clone() } << shift.max(0) as u32;
    let divisor = denominator.clone() << (-shift).max(0) as u32;
    // It gets 66 or 67 bits, then one that stands for all others.
    let mut whole = 0u128;
    for _ in 0..67 {
        whole <<= 1;
        if !rest.is_shorter(&divisor) {
            whole |= 1;
            rest = rest.combine(&divisor, true);
        }
        rest = rest << 1;
    }
    let sticky = u128::from(rest.sign() != 0);
    let value = scaled((whole << 1 | sticky) as f64, i64::from(exponent) - shift - 67);
    if numerator.is_negative { -value } else { value }
}

/// Returns `numerator` / `denominator` · 2ᵉ as the sum of two numbers, of which the second one is at
/// most half a unit in the last place of the first one, with a relative error below 2⁻⁹⁸. Both
/// integers must be positive, and the result far from the limits of `f64`.
pub(crate) fn precise_quotient(numerator: &Big, denominator: &Big, exponent: i32) -> [f64; 2] {
    let ([n, n_rest], [d, d_rest]) = (numerator.leading(), denominator.leading());
    let first = n / d;
    // What is left of the numerator: the first difference is exact.
    let [product, product_rest] = product(first, d);
    let rest = ((n - product) - product_rest + n_rest - first * d_rest) / d;
    let sum = first + rest;
    let shift = i64::from(exponent) + numerator.bits() - denominator.bits();
    [sum, rest - (sum - first)].map(|x| libm::ldexp(x, shift.clamp(-4000, 4000) as i32))
}

/// Returns a product of numbers of ordinary size as the sum of two, exactly (Dekker 1971).
fn product(a: f64, b: f64) -> [f64; 2] {
    let split = |x: f64| {
        let wide = 134_217_729.0 * x;
        let high = wide - (wide - x);
        (high, x - high)
    };
    let ((a0, a1), (b0, b1)) = (split(a), split(b));
    let product = a * b;
    [product, a1 * b1 - (product - a0 * b0 - a1 * b0 - a0 * b1)]
}

/// Returns `x`·2ᵉ for a number between 2⁶⁴ and 2⁷⁰, or 0.
fn scaled(x: f64, exponent: i64) -> f64 {
    let mut left = exponent.clamp(-1300, 1300);
    let mut value = x;
    // Each step multiplies by a power of two that is a normal number. A result that becomes
    // subnormal does so in the last step, because the first steps are at most 2⁻⁵⁰⁰ each.
    while left != 0 {
        let step = left.clamp(-500, 500);
        value *= f64::from_bits(((1023 + step) as u64) << 52);
        left -= step;
    }
    value
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use num_bigint::BigInt;
    use proptest::prelude::*;

    /// Returns the same number of another library.
    pub(crate) fn oracle(x: &Big) -> BigInt {
        assert!(x.digits.last() != Some(&0) && !(x.is_negative && x.digits.is_empty()), "not normal: {x:?}");
        let magnitude = x.digits.iter().rev().fold(BigInt::ZERO, |sum, &digit| (sum << 64) + digit);
        if x.is_negative { -magnitude } else { magnitude }
    }

    /// Numbers of up to five digits, many of which are all zeros or all ones.
    fn number() -> impl Strategy<Value = Big> {
        let digit = prop_oneof![Just(0), Just(1), Just(u64::MAX), any::<u64>()];
        (any::<bool>(), prop::collection::vec(digit, 0..6))
            .prop_map(|(is_negative, digits)| Big { is_negative, digits }.trimmed())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(5_000))]

        #[test]
        fn operations_are_those_of_another_library(a in number(), b in number(), bits in 0u32..200) {
            let (x, y) = (oracle(&a), oracle(&b));
            prop_assert_eq!(oracle(&(a.clone() + b.clone())), &x + &y);
            prop_assert_eq!(oracle(&(a.clone() - b.clone())), &x - &y);
            prop_assert_eq!(oracle(&(&a * &b)), &x * &y);
            prop_assert_eq!(oracle(&(a.clone() << bits)), &x << bits);
            prop_assert_eq!(a.bits(), x.bits() as i64);
            let sign = match x.sign() {
                num_bigint::Sign::Minus => -1,
                num_bigint::Sign::NoSign => 0,
                num_bigint::Sign::Plus => 1,
            };
            prop_assert_eq!(a.sign(), sign);
        }

        #[test]
        fn small_integers(x in any::<i64>()) {
            prop_assert_eq!(oracle(&Big::from(x)), BigInt::from(x));
        }

        #[test]
        fn floating_point_numbers(x in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
            // 2⁻¹⁰⁷⁴ is the smallest number.
            let (mantissa, exponent) = decompose(x);
            let magnitude = BigInt::from(mantissa) << (exponent + 1074);
            let expected = if x < 0.0 { -magnitude } else { magnitude };
            prop_assert_eq!(oracle(&Big::new(x, -1074)), expected);
        }

        #[test]
        fn quotients_are_rounded_correctly(a in -1_000_000i64..1_000_000, b in 1i64..1_000_000, e in -900i32..900) {
            let found = quotient(&a.into(), &b.into(), e);
            prop_assert_eq!(found, scaled((a as f64 / b as f64) * 2f64.powi(66), i64::from(e) - 66));
        }
    }

    proptest! {
        #[test]
        fn precise_quotients_are_precise(a in number(), b in number(), e in -300i32..300) {
            let positive = |x: Big| if x.sign() == 0 { Big::from(3) } else { Big { is_negative: false, ..x } };
            let (a, b) = (positive(a), positive(b));
            let [first, rest] = precise_quotient(&a, &b, e);
            prop_assert_eq!(first + rest, first);
            // All of them times the same power of two.
            let integer = |x: f64| oracle(&Big::new(x, -1074));
            let found = (integer(first) + integer(rest)) * oracle(&b);
            let expected = oracle(&a) << (1074 + e);
            let error = if found > expected { found - &expected } else { &expected - found };
            prop_assert!(error << 98 < expected);
        }
    }

    #[test]
    fn extreme_quotients() {
        let big = |bits: u32| Big::from(1) << bits;
        assert_eq!(quotient(&big(0), &3.into(), 0), 1.0 / 3.0);
        assert_eq!(quotient(&big(5000), &big(4999), 0), 2.0);
        assert_eq!(quotient(&big(5000), &big(0), 0), f64::INFINITY);
        assert_eq!(quotient(&big(0), &big(1074), 0), 5e-324);
        assert_eq!(quotient(&big(0), &big(5000), 0), 0.0);
        assert_eq!(quotient(&Big::default(), &big(3), 7), 0.0);
    }
}
