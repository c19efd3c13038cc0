//! The 3D predicates.

use crate::predicates::filter::{
    EPSILON, ERROR_BOUNDS, ExactStage, PredicateContext, PredicateContext3, PredicatesAt, UNDERFLOW, greatest, minus,
    weights::{in_sphere_error, underflow},
};
use crate::{
    index::NONE,
    predicates::{Sign, exact, integer, symbolic},
};
use std::cell::Cell;

/// A point lifted to the paraboloid, as a row of the in-sphere determinant: its difference (x, y, z)
/// to a given vertex, and the square *l* of its distance, less the difference of their weights.
///
/// They are stored as x, y, z, x, l, l, y, and, with weights, the sum of the magnitudes of the two that *l* is the
/// difference of: all pairs that [`minors`] takes are in it, so that none needs to be put together for each test.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Row([f64; 8]);

impl Row {
    /// Stands for the row of a vertex whose coordinates are not stored, or which is infinite. It
    /// makes determinants NaN, so that no filter decides.
    pub(crate) const NONE: Row = Row([f64::NAN; 8]);

    /// Creates the row from the differences of coordinates and, if `W`, of weights.
    #[inline(always)]
    fn new<const W: bool>([x, y, z]: [f64; 3], weight: f64) -> Self {
        let square = lift([x, y, z]);
        if !W {
            return Row([x, y, z, x, square, square, y, 0.0]);
        }
        let l = square - weight;
        Row([x, y, z, x, l, l, y, square + weight.abs()])
    }

    /// Returns l, or the sum of the magnitudes in it.
    #[inline(always)]
    fn magnitude<const W: bool>(&self) -> f64 {
        self.0[if W { 7 } else { 4 }]
    }

    /// Returns x, y, z and the magnitude.
    #[inline(always)]
    fn columns<const W: bool>(&self) -> [f64; 4] {
        let [x, y, z, ..] = self.0;
        [x, y, z, self.magnitude::<W>()]
    }

    /// Returns the numbers from the `k`-th on.
    #[inline(always)]
    fn pair(&self, k: usize) -> [f64; 2] {
        [self.0[k], self.0[k + 1]]
    }
}

/// Rows of the determinants of vertices around another one, computed when they are first needed: a star
/// evaluates its predicates for few vertices.
pub(crate) struct Rows {
    /// The vertex in the middle of the last one that was computed, and where it is.
    middle: Cell<(u32, [f64; 3])>,
    /// The vertex in the middle and the other one, for each place.
    keys: [Cell<[u32; 2]>; PLACES],
    /// The differences, and the square of the distance.
    rows: [Cell<[f64; 4]>; PLACES],
}

/// The number of rows that are stored: a power of two, larger than most stars.
const PLACES: usize = 128;

impl Rows {
    /// Creates the list without a row.
    pub(crate) fn new() -> Self {
        Rows {
            middle: Cell::new((NONE, [0.0; 3])),
            keys: [const { Cell::new([NONE; 2]) }; PLACES],
            rows: [const { Cell::new([0.0; 4]) }; PLACES],
        }
    }

    /// Returns the row of `v` around the vertex `at`.
    #[inline(always)]
    fn row(&self, context: &PredicateContext3<'_>, at: u32, v: u32) -> [f64; 4] {
        let place = (v.wrapping_mul(0x9e37_79b9) >> (u32::BITS - PLACES.ilog2())) as usize % PLACES;
        if self.keys[place].get() != [at, v] {
            self.compute(context, at, v, place);
        }
        self.rows[place].get()
    }

    #[inline(never)]
    fn compute(&self, context: &PredicateContext3<'_>, at: u32, v: u32, place: usize) {
        if self.middle.get().0 != at {
            self.middle.set((at, context.coordinate(at)));
        }
        let p @ [x, y, z] = minus(context.coordinate(v), self.middle.get().1);
        self.rows[place].set([x, y, z, lift(p)]);
        self.keys[place].set([at, v]);
    }
}

impl<const W: bool> PredicatesAt<'_, '_, 3, W> {
    /// Returns the context's `orient3d` with the vertex as d.
    #[inline]
    pub(crate) fn orient3d(&self, a: u32, b: u32, c: u32) -> Sign {
        let vertices = [a, b, c, self.vertex];
        if self.stored.is_empty() {
            return self.context.orient3d_computed(vertices);
        }
        let [u, v, w] = [a, b, c].map(|v| minus(self.stored[v as usize], self.place));
        self.context.orient3d_of(vertices, u, v, w)
    }

    /// Returns the facet of a positively oriented tetrahedron beyond which the vertex is, 4 if there
    /// is none, or `None` if floating point does not decide that. Of several facets, that with the
    /// greatest determinant is chosen: on average, walks are shorter by it.
    ///
    /// The determinants are those of [`orient3d`](Self::orient3d), expanded by another column, so
    /// that they have minors in common; the bound of their errors is the same.
    #[inline]
    pub(crate) fn facet_towards(&self, tetrahedron: [u32; 4]) -> Option<usize> {
        if self.stored.is_empty() {
            return None;
        }
        let [a, b, c, d] = tetrahedron.map(|v| minus(self.stored[v as usize], self.place));
        let minor = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - q[0] * p[1];
        let (ab, bc, cd) = (minor(a, b), minor(b, c), minor(c, d));
        let (ac, bd, ad) = (minor(a, c), minor(b, d), minor(a, d));
        let dets = [
            (c[2] * bd - b[2] * cd) - d[2] * bc,
            (a[2] * cd - c[2] * ad) + d[2] * ac,
            (b[2] * ad - a[2] * bd) - d[2] * ab,
            (a[2] * bc - b[2] * ac) + c[2] * ab,
        ];
        let greater = |k: usize, l: usize| if dets[k] > dets[l] { k } else { l };
        let k = greater(greater(0, 1), greater(2, 3));
        let det = greatest(dets);
        if det.abs() > self.context.orientation_bound { Some(if det > 0.0 { k } else { 4 }) } else { None }
    }

    /// Returns the context's `insphere` with the vertex as e.
    #[inline(always)]
    pub(crate) fn insphere(&self, [a, b, c, d]: [u32; 4]) -> Sign {
        let vertices = [a, b, c, d, self.vertex];
        if self.stored.is_empty() {
            return self.context.insphere_computed(vertices);
        }
        if W {
            return self.power(vertices);
        }
        self.context.insphere_of(vertices, [a, b, c, d].map(|v| minus(self.stored[v as usize], self.place)))
    }

    /// Returns the sign of the determinant with weights.
    #[inline(never)]
    fn power(&self, vertices: [u32; 5]) -> Sign {
        let [a, b, c, d, _] = vertices;
        let rows = [a, b, c].map(|v| self.row(v));
        let (det, is_certain) = self.insphere_of_rows(rows.each_ref(), d);
        if is_certain {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.insphere_again(det, rows.each_ref(), [a, b, c, d], 3)
    }

    /// Returns the row of vertex `v`.
    #[inline(always)]
    pub(crate) fn row(&self, v: u32) -> Row {
        self.stored.get(v as usize).map_or(Row::NONE, |&p| self.row_of(p, v))
    }

    /// Returns the row of vertex `v`, whose coordinates are `p`.
    #[inline(always)]
    fn row_of(&self, p: [f64; 3], v: u32) -> Row {
        Row::new::<W>(minus(p, self.place), self.weight_to(v))
    }

    /// Returns the value of the determinant of [`insphere`](Self::insphere) from the rows of a, b and
    /// c, and whether its sign is certain. The value is NaN if a row is missing.
    ///
    /// Computing the rows once halves the instructions of a test when many spheres are tested for
    /// one point.
    #[inline(always)]
    pub(crate) fn insphere_of_rows(&self, [a, b, c]: [&Row; 3], d: u32) -> (f64, bool) {
        let Some(&p) = self.stored.get(d as usize) else { return (f64::NAN, false) };
        let row = self.row_of(p, d);
        let det = lifted_determinant(a, b, c, &row);
        // The sum is no less than the greatest, and needs no comparisons, which processors often predict wrongly.
        let [la, lb, lc, ld] = [a, b, c, &row].map(Row::magnitude::<W>);
        let bound = squared_bound::<W>((la + lb) + (lc + ld));
        let is_certain = det.abs() > self.context.in_sphere_bound || det * det > bound;
        (det, is_certain)
    }

    /// Returns [`insphere`](Self::insphere) of `vertices` from the value `det` with which
    /// [`insphere_of_rows`](Self::insphere_of_rows) left it open, where vertex `k` was d.
    #[inline]
    pub(crate) fn insphere_again(&self, det: f64, [a, b, c]: [&Row; 3], vertices: [u32; 4], k: usize) -> Sign {
        if is_insphere_certain::<W>(det, [a, b, c, &self.row(vertices[k % 4])]) {
            return if det > 0.0 { 1 } else { -1 };
        }
        let [a, b, c, d] = vertices;
        self.context.insphere_exact([a, b, c, d, self.vertex])
    }
}

impl PredicateContext3<'_> {
    /// Returns [`orient3d`](Self::orient3d), from `rows` if coordinates are not stored.
    #[inline(never)]
    pub(crate) fn orient3d_around(&self, rows: &Rows, [at, b, c, d]: [u32; 4]) -> Sign {
        if !self.coordinates.is_empty() {
            return self.orient3d(at, b, c, d);
        }
        let [u, v, w] = [b, c, d].map(|v| {
            let [x, y, z, _] = rows.row(self, at, v);
            [x, y, z]
        });
        // Four vertices in turn are an odd permutation.
        -self.orient3d_of([b, c, d, at], u, v, w)
    }

    /// Returns [`insphere`](Self::insphere), from `rows` if coordinates are not stored.
    #[inline(never)]
    pub(crate) fn insphere_around(&self, rows: &Rows, [at, b, c, d]: [u32; 4], e: u32) -> Sign {
        if !self.coordinates.is_empty() {
            return self.insphere([at, b, c, d], e);
        }
        // Exchanging two vertices changes the sign.
        -self.insphere_lifted([e, b, c, d, at], [e, b, c, d].map(|v| rows.row(self, at, v)))
    }
}

impl<const W: bool> PredicateContext<'_, 3, W> {
    /// Returns the sign of det(b − a, c − a, d − a).
    #[inline]
    pub fn orient3d(&self, a: u32, b: u32, c: u32, d: u32) -> Sign {
        self.at(d).orient3d(a, b, c)
    }

    #[inline(never)]
    fn orient3d_computed(&self, vertices: [u32; 4]) -> Sign {
        let [pa, pb, pc, pd] = vertices.map(|v| self.computed(v));
        self.orient3d_of(vertices, minus(pa, pd), minus(pb, pd), minus(pc, pd))
    }

    /// Returns the sign, from the differences to the last vertex.
    #[inline(always)]
    fn orient3d_of(&self, vertices: [u32; 4], u: [f64; 3], v: [f64; 3], w: [f64; 3]) -> Sign {
        // det(b − a, c − a, d − a) = −det(a − d, b − d, c − d).
        let det = u[0] * (v[2] * w[1] - v[1] * w[2])
            + u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[1] * w[0] - v[0] * w[1]);
        if det.abs() > self.orientation_bound {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.orient3d_unfiltered(vertices, u, v, w, det)
    }

    #[inline(never)]
    fn orient3d_unfiltered(&self, vertices: [u32; 4], u: [f64; 3], v: [f64; 3], w: [f64; 3], det: f64) -> Sign {
        let perm = |i: usize, j: usize| (v[i] * w[j]).abs() + (v[j] * w[i]).abs();
        let permanent = u[0].abs() * perm(1, 2) + u[1].abs() * perm(2, 0) + u[2].abs() * perm(0, 1);
        if det.abs() > ERROR_BOUNDS[3].orientation * permanent + UNDERFLOW {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.orient3d_exact(vertices)
    }

    fn orient3d_exact(&self, vertices: [u32; 4]) -> Sign {
        match &self.exact {
            ExactStage::Narrow => {
                self.count(|c| &mut c.integer);
                let [a, b, c, d] = vertices.map(|v| self.narrow(v));
                integer::orient3d_narrow(a, b, c, d)
            }
            ExactStage::Wide(wide) => match self.wide(wide, vertices) {
                Some([a, b, c, d]) => {
                    self.count(|c| &mut c.integer);
                    integer::orient3d_wide(a, b, c, d)
                }
                None => {
                    self.count(|c| &mut c.expansion);
                    let [a, b, c, d] = vertices.map(|v| self.point(v));
                    exact::orient3d(a, b, c, d)
                }
            },
        }
    }

    /// Returns the sign of the in-sphere determinant: positive if e lies inside the sphere through
    /// the positively oriented a, b, c, d. Ties are broken symbolically: never zero for five
    /// different vertices of which at least four are not coplanar.
    #[inline(always)]
    pub fn insphere(&self, [a, b, c, d]: [u32; 4], e: u32) -> Sign {
        self.at(e).insphere([a, b, c, d])
    }

    #[inline(never)]
    fn insphere_computed(&self, vertices: [u32; 5]) -> Sign {
        let [pa, pb, pc, pd, pe] = vertices.map(|v| self.computed(v));
        self.insphere_of(vertices, [pa, pb, pc, pd].map(|p| minus(p, pe)))
    }

    /// Returns the sign, from the differences to the last vertex.
    #[inline(always)]
    fn insphere_of(&self, vertices: [u32; 5], differences: [[f64; 3]; 4]) -> Sign {
        self.insphere_lifted(vertices, differences.map(|p @ [x, y, z]| [x, y, z, lift(p)]))
    }

    /// Returns the sign, from the differences to the last vertex and the squares of the distances.
    #[inline(always)]
    fn insphere_lifted(&self, vertices: [u32; 5], rows: [[f64; 4]; 4]) -> Sign {
        let lifts = rows.map(|[_, _, _, l]| l);
        let [a, b, c, d] = rows.map(|[x, y, z, _]| [x, y, z]);
        let det = insphere_determinant([a, b, c, d], lifts);
        if det.abs() > self.in_sphere_bound || det * det > squared_bound::<false>(greatest(lifts)) {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.insphere_unfiltered(vertices, [a, b, c, d], det)
    }

    #[inline(never)]
    fn insphere_unfiltered(&self, vertices: [u32; 5], [a, b, c, d]: [[f64; 3]; 4], det: f64) -> Sign {
        let rows = [a, b, c, d].map(|p| Row::new::<false>(p, 0.0));
        if is_insphere_certain::<false>(det, rows.each_ref()) {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.insphere_exact(vertices)
    }

    /// Returns the sign by integers or expansions, and ties symbolically.
    #[inline(never)]
    fn insphere_exact(&self, vertices: [u32; 5]) -> Sign {
        let sign = match &self.exact {
            _ if W => self.power_sign(vertices, integer::power3d),
            ExactStage::Narrow => {
                self.count(|c| &mut c.integer);
                let [a, b, c, d, e] = vertices.map(|v| self.narrow(v));
                integer::insphere_narrow(a, b, c, d, e)
            }
            ExactStage::Wide(wide) => match self.wide(wide, vertices) {
                Some([a, b, c, d, e]) => {
                    self.count(|c| &mut c.integer);
                    match &wide.stretched {
                        None => integer::insphere_wide(a, b, c, d, e),
                        Some(stretched) => integer::insphere_stretched(a, b, c, d, e, stretched.shifts),
                    }
                }
                None => {
                    self.count(|c| &mut c.expansion);
                    let [a, b, c, d, e] = vertices.map(|v| self.point(v));
                    exact::insphere(a, b, c, d, e)
                }
            },
        };
        if sign != 0 {
            return sign;
        }
        self.count(|c| &mut c.symbolic);
        symbolic::break_tie(vertices.map(|v| self.rank(v)), |k| {
            let [a, b, c, d] = symbolic::without(vertices, k);
            self.orient3d(a, b, c, d)
        })
    }
}

/// Returns a bound of the square of an in-sphere determinant's error, from the greatest squared
/// distance *L* of its four points to the fifth, or more than that.
///
/// The permanent of three vectors is at most √3 times the product of their lengths, by Cauchy and
/// Schwarz twice: |b₁c₂| + |b₂c₁| ≤ |b|·|c|, and |a₀| + |a₁| + |a₂| ≤ √3·|a|. So that of the
/// determinant is at most 4·√3·L^(5/2). The last factor covers the roundings in the bound itself;
/// the last term, underflow: an error of [`UNDERFLOW`] beside one of at most 2¹²⁰. With weights, *L* is the greatest
/// sum of a squared distance and the magnitude of a difference of weights, so at least the squared distance; and an
/// error of 2⁻⁸⁰⁰ may be beside one of at most 2²⁷⁵.
#[inline]
fn squared_bound<const W: bool>(greatest_lift: f64) -> f64 {
    let error = const { in_sphere_error::<3, W>() };
    let factor = 48.0 * error * error * (1.0 + 128.0 * EPSILON);
    let squared_underflow = const { f64::from_bits((1023 - if W { 500 } else { 700 }) << 52) };
    let squared = greatest_lift * greatest_lift;
    factor * (squared * squared) * greatest_lift + squared_underflow
}

/// Returns the squared distance from the origin.
#[inline]
fn lift(p: [f64; 3]) -> f64 {
    p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
}

#[inline]
fn insphere_determinant([a, b, c, d]: [[f64; 3]; 4], lifts: [f64; 4]) -> f64 {
    let minor = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - q[0] * p[1];
    let (ab, bc, cd, da) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a));
    let (ac, bd) = (minor(a, c), minor(b, d));
    let abc = a[2] * bc - b[2] * ac + c[2] * ab;
    let bcd = b[2] * cd - c[2] * bd + d[2] * bc;
    let cda = c[2] * da + d[2] * ac + a[2] * cd;
    let dab = d[2] * ab + a[2] * bd + b[2] * da;
    (lifts[0] * bcd - lifts[1] * cda) + (lifts[2] * dab - lifts[3] * abc)
}

/// Returns the same determinant from the rows, in pairs of operations as processors have them.
///
/// Each of its products is rounded at most 16 times, as Shewchuk's are: in three differences and
/// those of a squared distance 3 + 2, in its squares and their sum 3, in two minors 2 + 2, in their
/// product and its sum with others 1 + 3. So the error is at most (1 + ε)¹⁶ − 1 < (16 + 121·ε)·ε
/// times the permanent.
#[inline(always)]
fn lifted_determinant(a: &Row, b: &Row, c: &Row, d: &Row) -> f64 {
    let [ab_yz_zx, ab_xl_yl, ab_zl_xy] = minors(a, b);
    let [dc_yz_zx, dc_xl_yl, [zl, xy]] = minors(d, c);
    let [p, q] = plus(plus(times(ab_yz_zx, dc_xl_yl), times(ab_xl_yl, dc_yz_zx)), times(ab_zl_xy, [xy, zl]));
    p + q
}

/// Returns the minors of two rows, by their columns, in pairs of which the first two have each
/// other's complements.
#[inline(always)]
fn minors(a: &Row, b: &Row) -> [[f64; 2]; 3] {
    let minors = |j: usize, k: usize| minus(times(a.pair(j), b.pair(k)), times(a.pair(k), b.pair(j)));
    let [xy, yz, zx, ll, ly] = [0, 1, 2, 4, 5];
    [minors(yz, zx), minors(xy, ll), minors(zx, ly)]
}

#[inline(always)]
fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0], a[1] * b[1]]
}

#[inline(always)]
fn plus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

/// Returns whether the value of an in-sphere determinant of these rows has its sign.
fn is_insphere_certain<const W: bool>(det: f64, rows: [&Row; 4]) -> bool {
    det.abs() > in_sphere_error::<3, W>() * insphere_permanent::<W>(rows) + underflow::<W>()
}

fn insphere_permanent<const W: bool>(rows: [&Row; 4]) -> f64 {
    let [a, b, c, d] = rows.map(Row::columns::<W>);
    let minor = |p: [f64; 4], q: [f64; 4]| (p[0] * q[1]).abs() + (q[0] * p[1]).abs();
    let (ab, bc, cd, da) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a));
    let (ac, bd) = (minor(a, c), minor(b, d));
    let [az, bz, cz, dz] = [a, b, c, d].map(|p| p[2].abs());
    let abc = az * bc + bz * ac + cz * ab;
    let bcd = bz * cd + cz * bd + dz * bc;
    let cda = cz * da + dz * ac + az * cd;
    let dab = dz * ab + az * bd + bz * da;
    a[3] * bcd + b[3] * cda + c[3] * dab + d[3] * abc
}

#[cfg(test)]
mod tests {
    use super::{super::Scale, *};
    use crate::input::lattice::{Lattice, Width};
    use proptest::prelude::*;

    /// Checks that every sign of a `PredicateContext` for the first five points agrees with the
    /// exact predicates on `f64`.
    fn agree(points: &[[f64; 3]]) -> Result<(), TestCaseError> {
        let lattice = Lattice::fit(points.into());
        // An order that differs from the input's, for the ties.
        let indices: Vec<u32> = (0..points.len() as u32).rev().collect();
        let vertices = PredicateContext3::new(points.into(), &lattice, indices);
        let p = |v: u32| points[vertices.input_index(v) as usize];
        let sign = exact::orient3d(p(0), p(1), p(2), p(3));
        prop_assert_eq!(vertices.orient3d(0, 1, 2, 3), sign);
        prop_assert_eq!(vertices.orient3d(1, 0, 2, 3), -sign);
        prop_assert_eq!(vertices.orient3d_exact([0, 1, 2, 3]), sign);
        let five = [0, 1, 2, 3, 4].map(|v| (vertices.input_index(v), p(v)));
        let sign = gdel_reference::insphere_symbolic(five);
        prop_assert_eq!(vertices.insphere([0, 1, 2, 3], 4), sign);
        // From rows, with each of the vertices in each place.
        let here = vertices.at(4);
        for (order, parity) in [([0, 1, 2, 3], 1), ([3, 2, 1, 0], 1), ([2, 3, 1, 0], -1), ([1, 0, 2, 3], -1)] {
            let [a, b, c, d] = order;
            let rows = [a, b, c].map(|v| here.row(v));
            let (det, is_certain) = here.insphere_of_rows(rows.each_ref(), d);
            let from_det = if det > 0.0 { 1 } else { -1 };
            prop_assert!(!is_certain || from_det == parity * sign, "{det} for {order:?}, {sign}");
            prop_assert_eq!(here.insphere_again(det, rows.each_ref(), order, 3), parity * sign);
        }
        // From rows that are computed when they are needed, around one vertex after another.
        let (computed, rows) = (PredicateContext3::of_input(points.into(), &lattice), Rows::new());
        for k in [0, 1, 2, 3, 4, 0] {
            let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|i| (i + k) % 5);
            prop_assert_eq!(computed.orient3d_around(&rows, [a, b, c, d]), computed.orient3d(a, b, c, d));
            prop_assert_eq!(computed.insphere_around(&rows, [a, b, c, d], e), computed.insphere([a, b, c, d], e));
        }
        // With vertex 4 in the place of its corner k, a tetrahedron is inverted if that is beyond facet k.
        let tetrahedron = if vertices.orient3d(0, 1, 2, 3) > 0 { [0, 1, 2, 3] } else { [1, 0, 2, 3] };
        let is_beyond = |k: usize| {
            let [a, b, c, d] = std::array::from_fn(|i| p(if i == k { 4 } else { tetrahedron[i] }));
            exact::orient3d(a, b, c, d) < 0
        };
        match here.facet_towards(tetrahedron) {
            Some(4) => prop_assert!(!(0..4).any(is_beyond)),
            Some(k) => prop_assert!(is_beyond(k), "{k}"),
            None => {}
        }
        Ok(())
    }

    fn near(exponent: std::ops::RangeInclusive<i32>) -> impl Strategy<Value = f64> + Clone {
        (-9i32..10, exponent, -1i32..2).prop_map(|(m, e, nudge)| {
            let x = f64::from(m) * 2f64.powi(e);
            if nudge == 0 || x == 0.0 { x } else { f64::from_bits(x.to_bits().wrapping_add_signed(nudge.into())) }
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn small_grid(points in prop::array::uniform5(prop::array::uniform3((-3i32..4).prop_map(f64::from)))) {
            agree(&points)?;
        }

        #[test]
        fn narrow(points in prop::array::uniform5(prop::array::uniform3((-(1i32 << 30)..1 << 30).prop_map(f64::from)))) {
            agree(&points)?;
        }

        #[test]
        fn nudged(points in prop::array::uniform5(prop::array::uniform3(near(0..=0)))) {
            agree(&points)?;
        }

        #[test]
        fn axes_of_different_ranges(
            points in prop::array::uniform5(prop::array::uniform3(-4i32..5)),
            scales in prop::array::uniform3(prop::sample::select(vec![1.0, 1e-3, 1e-5, 1e6, 1e12, 1e40])),
        ) {
            agree(&points.map(|p| std::array::from_fn::<f64, 3, _>(|axis| f64::from(p[axis]) * scales[axis])))?;
        }

        #[test]
        fn mixed_exponents(points in prop::array::uniform5(prop::array::uniform3(near(-40..=4)))) {
            agree(&points)?;
        }

        #[test]
        fn any_finite(points in prop::array::uniform5(prop::array::uniform3(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO))) {
            agree(&points)?;
        }

        #[test]
        fn cospherical(points in prop::array::uniform5((0usize..1 << 20).prop_map(|i| {
            // Rational points of the unit sphere are cospherical up to rounding, integer points of
            // the sphere of radius 9 exactly.
            let corners = [[0, 0, 9], [1, 4, 8], [4, 4, 7], [3, 6, 6]];
            let mut p = corners[i % 4].map(f64::from);
            p.rotate_left(i / 4 % 3);
            for (axis, x) in p.iter_mut().enumerate() {
                if i >> (5 + axis) & 1 == 1 { *x = -*x; }
            }
            p
        })), scale in -1100i32..900, nudge: bool) {
            let mut points = points.map(|p| p.map(|x| Scale::new(scale).apply(x)));
            if nudge { points[2][0] = points[2][0].next_up(); }
            agree(&points)?;
        }
    }

    /// Scaled to the lattice, such coordinates exceed 2⁶² before the origin is subtracted.
    #[test]
    fn far_from_the_origin() {
        // More than 31 bits apart, so that the lattice is wide.
        let far = |i: u32, side: u32| 1.0 + f64::from(i % side) * (1.0 / 16384.0 + f64::EPSILON);
        for side in [2, 3, 5] {
            for seed in 0..40u32 {
                let at = |k: u32| (seed * 31 + k * k * 7 + k) % (side * side * side);
                let points: Vec<_> = (0..5)
                    .map(|k| [far(at(k), side), far(at(k) / side, side), far(at(k) / (side * side), side)])
                    .collect();
                assert_eq!(Lattice::fit((&points).into()).width(), Width::Wide);
                agree(&points).unwrap();
            }
        }
    }

    #[test]
    fn grids_with_axes_of_different_ranges_need_no_expansions() {
        let at = |i: u32, scales: [f64; 3]| [i % 4, i / 4 % 4, i / 16].map(f64::from).into_iter().zip(scales);
        for scales in [[1.0, 1e-3, 1e6], [1e-5, 1e-5, 1.0]] {
            let point = |i: u32| -> [f64; 3] {
                let mut p = at(i, scales).map(|(x, scale)| x * scale);
                [(); 3].map(|()| p.next().expect("three coordinates"))
            };
            let points: Vec<[f64; 3]> = (0..64).map(point).collect();
            let lattice = Lattice::fit((&points).into());
            let vertices = PredicateContext3::new((&points).into(), &lattice, (0..64).collect());
            for e in 5..64 {
                assert_ne!(vertices.insphere([0, 1, 4, 16], e), 0);
            }
            let counts = vertices.exact_counts();
            assert!(counts.integer > 0 && counts.expansion == 0, "{counts:?}");
        }
    }
}
