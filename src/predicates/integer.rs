//! Predicates for lattice coordinates, in fixed-width integers.
//!
//! For *b*-bit coordinates, differences have b + 1 bits with their sign, an orientation needs 3b +
//! 3 and an in-sphere determinant 5b + 6; in 2D, 2b + 2 and 4b + 4. The narrow forms take 31-bit
//! coordinates and stay within 64- and 128-bit integers except for the last sum of `insphere`; the
//! wide forms take 62-bit coordinates.

use crate::predicates::Sign;

type Point = [i64; 3];

/// Returns the difference of two points.
fn minus<const D: usize>(a: [i64; D], b: [i64; D]) -> [i64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// Returns the sign of det(b − a, c − a) for coordinates 0 ≤ q < 2³¹.
#[inline]
pub fn orient2d_narrow(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> Sign {
    let (u, v) = (minus(b, a), minus(c, a));
    // Twice the area of a triangle in a square of side 2³¹ − 1.
    (u[0] * v[1] - u[1] * v[0]).signum() as Sign
}

/// Returns the sign of the in-circle determinant: positive if d lies inside the circle through the
/// counter-clockwise a, b, c, for coordinates 0 ≤ q < 2³¹.
#[inline]
pub fn incircle_narrow(a: [i64; 2], b: [i64; 2], c: [i64; 2], d: [i64; 2]) -> Sign {
    let (a, b, c) = (minus(a, d), minus(b, d), minus(c, d));
    // The minors are twice the areas of triangles in a square of side 2³¹ − 1: below 2⁶². The sums
    // of two squares are below 2⁶³.
    let minor = |p: [i64; 2], q: [i64; 2]| i128::from(p[0] * q[1] - p[1] * q[0]);
    let lift = |p: [i64; 2]| i128::from(p[0] * p[0] + p[1] * p[1]);
    (lift(a) * minor(b, c) + lift(b) * minor(c, a) + lift(c) * minor(a, b)).signum() as Sign
}

/// Returns the sign of det(b − a, c − a) for coordinates 0 ≤ q < 2⁶².
#[inline]
pub fn orient2d_wide(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> Sign {
    minor_wide(minus(b, a), minus(c, a), 0, 1).signum() as Sign
}

/// Returns the sign of the in-circle determinant: positive if d lies inside the circle through the
/// counter-clockwise a, b, c, for coordinates 0 ≤ q < 2⁶².
#[inline]
pub fn incircle_wide(a: [i64; 2], b: [i64; 2], c: [i64; 2], d: [i64; 2]) -> Sign {
    let (a, b, c) = (minus(a, d), minus(b, d), minus(c, d));
    // Minors are below 2¹²⁴, lifts below 2¹²⁵.
    let minor = |p: [i64; 2], q: [i64; 2]| {
        let value = minor_wide(p, q, 0, 1);
        I192 { high: value >> 64, low: value as u64 }
    };
    let columns = [(a, b, c), (b, c, a), (c, a, b)].map(|(p, q, r)| column_product(minor(q, r), lift_wide(p)));
    sign_of_columns(std::array::from_fn(|i| columns.iter().map(|column| column[i]).sum()))
}

/// Returns the sign of det(b − a, c − a, d − a) for coordinates 0 ≤ q < 2³¹.
#[inline]
pub fn orient3d_narrow(a: Point, b: Point, c: Point, d: Point) -> Sign {
    let (u, v, w) = (minus(b, a), minus(c, a), minus(d, a));
    // Differences are below 2³¹, so the 2×2 minors are below 2⁶³.
    let x = i128::from(u[0]) * i128::from(v[1] * w[2] - v[2] * w[1]);
    let y = i128::from(u[1]) * i128::from(v[2] * w[0] - v[0] * w[2]);
    let z = i128::from(u[2]) * i128::from(v[0] * w[1] - v[1] * w[0]);
    (x + y + z).signum() as Sign
}

/// Returns the sign of the in-sphere determinant: positive if e lies inside the sphere through the
/// positively oriented a, b, c, d, for coordinates 0 ≤ q < 2³¹.
#[inline]
pub fn insphere_narrow(a: Point, b: Point, c: Point, d: Point, e: Point) -> Sign {
    let (a, b, c, d) = (minus(a, e), minus(b, e), minus(c, e), minus(d, e));
    let minor = |p: Point, q: Point| p[0] * q[1] - q[0] * p[1];
    let (ab, bc, cd, da) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a));
    let (ac, bd) = (minor(a, c), minor(b, d));
    let times = |p: Point, m: i64| i128::from(p[2]) * i128::from(m);
    let abc = times(a, bc) - times(b, ac) + times(c, ab);
    let bcd = times(b, cd) - times(c, bd) + times(d, bc);
    let cda = times(c, da) + times(d, ac) + times(a, cd);
    let dab = times(d, ab) + times(a, bd) + times(b, da);
    // Below 3·2⁶².
    let lift = |p: Point| p.iter().map(|&x| (x * x) as u64).sum::<u64>();
    // The terms are below 2⁹⁶·2⁶⁴: kept as high·2⁶⁴ + low, with the carries of the low halves in
    // their own upper half.
    let mut high = 0i128;
    let mut low = 0i128;
    for (positive, m, l) in [(true, bcd, lift(a)), (false, cda, lift(b)), (true, dab, lift(c)), (false, abc, lift(d))] {
        let m = if positive { m } else { -m };
        let upper = (m >> 64) * i128::from(l);
        let lower = u128::from(m as u64) * u128::from(l);
        high += upper + (lower >> 64) as i128;
        low += i128::from(lower as u64);
    }
    high += low >> 64;
    match high.signum() {
        0 => (low as u64 != 0) as Sign,
        sign => sign as Sign,
    }
}

/// The number high·2⁶⁴ + low.
#[derive(Clone, Copy)]
struct I192 {
    high: i128,
    low: u64,
}

impl I192 {
    /// Returns m·s.
    #[inline]
    fn product(m: i128, s: i64) -> Self {
        let upper = (m >> 64) * i128::from(s);
        let lower = i128::from(m as u64) * i128::from(s);
        I192 { high: upper + (lower >> 64), low: lower as u64 }
    }

    /// Returns the sum of two numbers.
    #[inline]
    fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        I192 { high: self.high + other.high + i128::from(carry), low }
    }

    /// Returns the sum of three products.
    #[inline]
    fn sum(terms: [(i128, i64); 3]) -> Self {
        let [a, b, c] = terms.map(|(m, s)| Self::product(m, s));
        a.plus(b).plus(c)
    }
}

/// Returns the minor pᵢ·qⱼ − pⱼ·qᵢ.
#[inline]
fn minor_wide<const D: usize>(p: [i64; D], q: [i64; D], i: usize, j: usize) -> i128 {
    i128::from(p[i]) * i128::from(q[j]) - i128::from(p[j]) * i128::from(q[i])
}

/// Returns the sign of det(b − a, c − a, d − a) for coordinates 0 ≤ q < 2⁶².
#[inline]
pub fn orient3d_wide(a: Point, b: Point, c: Point, d: Point) -> Sign {
    let (u, v, w) = (minus(b, a), minus(c, a), minus(d, a));
    let det =
        I192::sum([(minor_wide(v, w, 1, 2), u[0]), (minor_wide(v, w, 2, 0), u[1]), (minor_wide(v, w, 0, 1), u[2])]);
    match det.high.signum() {
        0 => (det.low != 0) as Sign,
        sign => sign as Sign,
    }
}

/// Returns the sign of the in-sphere determinant: positive if e lies inside the sphere through the
/// positively oriented a, b, c, d, for coordinates 0 ≤ q < 2⁶².
#[inline]
pub fn insphere_wide(a: Point, b: Point, c: Point, d: Point, e: Point) -> Sign {
    let (a, b, c, d) = (minus(a, e), minus(b, e), minus(c, e), minus(d, e));
    let (bcd, cda, dab, abc) = minors3_wide([a, b, c, d]);
    // Straight text: with the lifts inside a loop, the compiler keeps the loops, which takes a
    // fifth more instructions.
    let [a, b, c, d] = [(bcd, a), (cda, b), (dab, c), (abc, d)].map(|(m, p)| column_product(m, lift_wide(p)));
    sign_of_columns(std::array::from_fn(|i| a[i] - b[i] + c[i] - d[i]))
}

/// Returns the minors of three differences: without the first, the second, the third, and the last.
#[inline(always)]
fn minors3_wide([a, b, c, d]: [Point; 4]) -> (I192, I192, I192, I192) {
    let minor = |p: Point, q: Point| minor_wide(p, q, 0, 1);
    let (ab, bc, cd, da) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a));
    let (ac, bd) = (minor(a, c), minor(b, d));
    let abc = I192::sum([(bc, a[2]), (ac, -b[2]), (ab, c[2])]);
    let bcd = I192::sum([(cd, b[2]), (bd, -c[2]), (bc, d[2])]);
    let cda = I192::sum([(da, c[2]), (ac, d[2]), (cd, a[2])]);
    let dab = I192::sum([(ab, d[2]), (bd, a[2]), (da, b[2])]);
    (bcd, cda, dab, abc)
}

/// Returns the sign of the in-circle determinant of weighted points: positive if the last one is below the lifted
/// triangle of the others, which turn counter-clockwise, for coordinates 0 ≤ q < 2⁶² and weights |w| < 2¹²⁵.
pub fn power2d([a, b, c, d]: [[i64; 2]; 4], [wa, wb, wc, wd]: [i128; 4]) -> Sign {
    let (a, b, c) = (minus(a, d), minus(b, d), minus(c, d));
    let minor = |p: [i64; 2], q: [i64; 2]| {
        let value = minor_wide(p, q, 0, 1);
        I192 { high: value >> 64, low: value as u64 }
    };
    let lift = |p: [i64; 2], w: i128| lift_wide(p) as i128 - (w - wd);
    sign_of_products([(minor(b, c), lift(a, wa)), (minor(c, a), lift(b, wb)), (minor(a, b), lift(c, wc))])
}

/// Returns the sign of the in-sphere determinant of weighted points: positive if the last one is below the lifted
/// tetrahedron of the others, which is positively oriented, for coordinates 0 ≤ q < 2⁶² and weights |w| < 2¹²⁵.
pub fn power3d([a, b, c, d, e]: [Point; 5], [wa, wb, wc, wd, we]: [i128; 5]) -> Sign {
    let (a, b, c, d) = (minus(a, e), minus(b, e), minus(c, e), minus(d, e));
    let (bcd, cda, dab, abc) = minors3_wide([a, b, c, d]);
    let lift = |p: Point, w: i128| lift_wide(p) as i128 - (w - we);
    sign_of_products([(bcd, lift(a, wa)), (cda, -lift(b, wb)), (dab, lift(c, wc)), (abc, -lift(d, wd))])
}

/// Returns the sign of Σ mᵢ·lᵢ for |lᵢ| < 2¹²⁷ and minors of three differences of 62 bits.
fn sign_of_products<const N: usize>(terms: [(I192, i128); N]) -> Sign {
    let columns = terms.map(|(m, l)| {
        let columns = column_product(m, l.unsigned_abs());
        if l < 0 { columns.map(|column| -column) } else { columns }
    });
    sign_of_columns(std::array::from_fn(|i| columns.iter().map(|column| column[i]).sum()))
}

/// Returns the sign of the in-circle determinant of points whose coordinates on axis *k* have been
/// divided by 2^`shifts[k]`: positive if d lies inside the circle through the counter-clockwise a,
/// b, c, for coordinates 0 ≤ q < 2⁶² and shifts up to [`MAX_SHIFT`].
pub fn incircle_stretched(a: [i64; 2], b: [i64; 2], c: [i64; 2], d: [i64; 2], shifts: [u32; 2]) -> Sign {
    let (a, b, c) = (minus(a, d), minus(b, d), minus(c, d));
    let minor = |p: [i64; 2], q: [i64; 2]| {
        let value = minor_wide(p, q, 0, 1);
        I192 { high: value >> 64, low: value as u64 }
    };
    sign_of_stretched([(minor(b, c), a), (minor(c, a), b), (minor(a, b), c)], shifts)
}

/// Returns the sign of the in-sphere determinant of points whose coordinates on axis *k* have been
/// divided by 2^`shifts[k]`: positive if e lies inside the sphere through the positively oriented
/// a, b, c, d, for coordinates 0 ≤ q < 2⁶² and shifts up to [`MAX_SHIFT`].
pub fn insphere_stretched(a: Point, b: Point, c: Point, d: Point, e: Point, shifts: [u32; 3]) -> Sign {
    let (a, b, c, d) = (minus(a, e), minus(b, e), minus(c, e), minus(d, e));
    let minor = |p: Point, q: Point| minor_wide(p, q, 0, 1);
    let (ab, bc, cd, da) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a));
    let (ac, bd) = (minor(a, c), minor(b, d));
    // Every other minor has the opposite sign, so that all terms are added.
    let cba = I192::sum([(bc, -a[2]), (ac, b[2]), (ab, -c[2])]);
    let bcd = I192::sum([(cd, b[2]), (bd, -c[2]), (bc, d[2])]);
    let adc = I192::sum([(da, -c[2]), (ac, -d[2]), (cd, -a[2])]);
    let dab = I192::sum([(ab, d[2]), (bd, a[2]), (da, b[2])]);
    sign_of_stretched([(bcd, a), (adc, b), (dab, c), (cba, d)], shifts)
}

/// The largest difference of the powers of two that the axes of a stretched lattice are multiplied
/// by. A sum of four minors, below 2¹⁸⁹, times squares, below 2¹²⁴, shifted by twice as much, for
/// three axes, stays below 2⁴⁴⁸.
pub const MAX_SHIFT: u32 = 64;

/// Returns the sign of Σ mᵢ·Σ (pᵢₖ·2^`shifts[k]`)².
///
/// The minors of a stretched lattice have a common factor that is a power of two, so only the
/// squared lengths depend on the shifts. The sum for each axis is shifted as a whole.
fn sign_of_stretched<const D: usize, const N: usize>(terms: [(I192, [i64; D]); N], shifts: [u32; D]) -> Sign {
    let mut total = [0; 8];
    for (axis, &shift) in shifts.iter().enumerate() {
        let mut columns = [0; 5];
        // Points of grids agree on many coordinates.
        for (m, p) in terms.iter().filter(|(_, p)| p[axis] != 0) {
            let square = i128::from(p[axis]) * i128::from(p[axis]);
            let product = column_product(*m, square as u128);
            columns.iter_mut().zip(product).for_each(|(column, c)| *column += c);
        }
        add_shifted(&mut total, columns, 2 * shift);
    }
    match total[7] as i64 {
        0 => total.iter().any(|&limb| limb != 0) as Sign,
        top => top.signum() as Sign,
    }
}

/// Adds Σ cᵢ·2^(64·i + `shift`) to a number of 512 bits in two's complement.
fn add_shifted(total: &mut [u64; 8], columns: [i128; 5], shift: u32) {
    let mut limbs = [0; 8];
    let mut carry = 0;
    for (limb, column) in limbs.iter_mut().zip(columns.into_iter().chain([0; 3])) {
        let sum = column + carry;
        (*limb, carry) = (sum as u64, sum >> 64);
    }
    let (words, bits) = ((shift / 64) as usize, shift % 64);
    let mut carry = false;
    for i in words..8 {
        let low = if bits == 0 || i == words { 0 } else { limbs[i - words - 1] >> (64 - bits) };
        let (sum, first) = total[i].overflowing_add(limbs[i - words] << bits | low);
        let (sum, second) = sum.overflowing_add(carry.into());
        (total[i], carry) = (sum, first | second);
    }
}

/// Returns the squared length, below D·2¹²⁴.
#[inline]
fn lift_wide<const D: usize>(p: [i64; D]) -> u128 {
    p.iter().map(|&x| (i128::from(x) * i128::from(x)) as u128).sum()
}

/// Returns the sign of Σ cᵢ·2^(64·i), where the columns keep their carries in their upper halves.
#[inline]
fn sign_of_columns(mut columns: [i128; 5]) -> Sign {
    let mut rest = 0;
    for i in 0..4 {
        columns[i + 1] += columns[i] >> 64;
        rest |= columns[i] as u64;
    }
    match columns[4].signum() {
        0 => (rest != 0) as Sign,
        sign => sign as Sign,
    }
}

/// Returns m·l as a sum of columns, Σ cᵢ·2^(64·i).
#[inline]
fn column_product(m: I192, l: u128) -> [i128; 5] {
    let (m0, m1, m2) = (m.low, m.high as u64, (m.high >> 64) as i64);
    let (l0, l1) = (l as u64, (l >> 64) as u64);
    let unsigned = |x: u64, y: u64| {
        let p = u128::from(x) * u128::from(y);
        (i128::from(p as u64), (p >> 64) as i128)
    };
    let signed = |x: i64, y: u64| {
        let p = i128::from(x) * i128::from(y);
        (i128::from(p as u64), p >> 64)
    };
    let (p00, p01, p10, p11) = (unsigned(m0, l0), unsigned(m0, l1), unsigned(m1, l0), unsigned(m1, l1));
    let (p20, p21) = (signed(m2, l0), signed(m2, l1));
    [p00.0, p00.1 + p01.0 + p10.0, p01.1 + p10.1 + p11.0 + p20.0, p11.1 + p20.1 + p21.0, p21.1]
}
