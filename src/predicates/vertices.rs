//! A point set prepared for fast exact predicates: floating-point filters, then lattice integers, then expansions.

use super::{Sign, exact, integer, symbolic};
use crate::{
    Points,
    lattice::{Lattice, Width},
    stats::ExactCounts,
};
use std::cell::Cell;

/// The roundoff of Shewchuk's `insphere` is at most this times its permanent (*Adaptive precision floating-point
/// arithmetic*, 1997, §4.4: (16 + 224 ε) ε with ε = 2⁻⁵³), which counts the rounded differences in.
const INSPHERE: f64 = (16.0 + 224.0 * EPSILON) * EPSILON;
/// Likewise for `orient3d`: (7 + 56 ε) ε.
const ORIENT3D: f64 = (7.0 + 56.0 * EPSILON) * EPSILON;
const EPSILON: f64 = f64::EPSILON / 2.0;

/// Added to every error bound: coordinates are scaled to a range of 2³¹, so all that underflow can cost, 2⁻¹⁰⁷⁴ in any
/// of some hundred operations and times at most 2¹⁵⁷ of later factors, is far below it.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// Points in an order of the engine's choosing (*vertices*), with the predicates on them.
///
/// The signs are those of the exact input coordinates; the symbolic ties are those of the input indices.
pub struct Vertices<'a> {
    input: Points<'a>,
    lattice: Lattice,
    /// The input index of each vertex; empty when the vertices are the input points in their order.
    indices: Vec<u32>,
    /// Input coordinates times a power of two that brings the range of every axis below 2³¹; for a narrow lattice, the
    /// lattice coordinates. Empty when they are computed anew each time.
    coordinates: Vec<[f64; 3]>,
    scaling: Scaling,
    exact: ExactStage,
    /// Error bounds of the determinants' floating-point values that hold for all arguments.
    orient3d_bound: f64,
    insphere_bound: f64,
    counts: Cell<ExactCounts>,
}

/// What decides the signs that the filters leave open.
enum ExactStage {
    /// 31-bit integers, which the `coordinates` are.
    Narrow,
    /// 62-bit integers, where none of the points is rounded. Empty when they are computed anew each time.
    Wide { positions: Vec<[i64; 3]>, rounded: Vec<bool> },
}

/// How coordinates come from the input.
enum Scaling {
    /// They are the lattice coordinates.
    Lattice,
    /// They are the input's times a power of two, but 0 where an axis does not vary.
    By(Scale, [bool; 3]),
}

/// Multiplication by a power of two that `f64` need not have, as two that it has.
struct Scale([f64; 2]);

impl Scale {
    fn new(exponent: i32) -> Self {
        // |exponent| is at most 62 + 1074.
        let half = exponent.clamp(-2000, 2000) / 2;
        Scale([half, exponent.clamp(-2000, 2000) - half].map(|e| f64::from_bits(((1023 + e) as u64) << 52)))
    }

    /// Exact unless the result is subnormal.
    fn apply(&self, x: f64) -> f64 {
        x * self.0[0] * self.0[1]
    }
}

impl<'a> Vertices<'a> {
    /// Vertex *v* is `input` point `indices[v]`, and its coordinates lie at place *v* of an array, which is best for many
    /// signs. The points must be finite and `lattice` fitted to them.
    pub fn new(input: Points<'a>, lattice: &Lattice, indices: Vec<u32>) -> Self {
        let mut vertices = Vertices::of_input(input, lattice);
        vertices.coordinates.reserve_exact(indices.len());
        let coordinates = indices.iter().map(|&i| vertices.computed(i));
        vertices.coordinates = coordinates.collect();
        if let ExactStage::Wide { positions, rounded } = &mut vertices.exact {
            positions.reserve_exact(indices.len());
            rounded.reserve_exact(indices.len());
            for &i in &indices {
                let q = lattice.coordinates(input.get(i as usize));
                positions.push(q.map(|c| c.value));
                rounded.push(q.iter().any(|c| !c.exact));
            }
        }
        vertices.indices = indices;
        vertices
    }

    /// The vertices are the points of `input` in their order. Nothing is stored, which is best for few signs.
    pub fn of_input(input: Points<'a>, lattice: &Lattice) -> Self {
        let (scaling, exact) = match lattice.width() {
            Width::Narrow => (Scaling::Lattice, ExactStage::Narrow),
            Width::Wide => {
                let exponent = lattice.exponent() - (Width::Wide.bits() - Width::Narrow.bits()) as i32;
                let exact = ExactStage::Wide { positions: Vec::new(), rounded: Vec::new() };
                (Scaling::By(Scale::new(exponent), lattice.varies()), exact)
            }
        };
        let mut vertices = Vertices {
            input,
            lattice: lattice.clone(),
            indices: Vec::new(),
            coordinates: Vec::new(),
            scaling,
            exact,
            orient3d_bound: 0.0,
            insphere_bound: 0.0,
            counts: Cell::default(),
        };
        let [low, high] = lattice.bounds().map(|corner| vertices.scaled(corner));
        let extents = std::array::from_fn(|axis| (high[axis] - low[axis]).max(0.0));
        vertices.orient3d_bound = orient3d_bound(extents);
        vertices.insphere_bound = insphere_bound(extents);
        vertices
    }

    /// Others of the same points, for another thread, if nothing is stored. They count for themselves.
    pub(crate) fn again(&self) -> Option<Self> {
        self.coordinates.is_empty().then(|| Vertices::of_input(self.input, &self.lattice))
    }

    /// Adds what others of the same points have counted.
    pub(crate) fn add_counts(&self, more: ExactCounts) {
        let counts = self.counts.get();
        self.counts.set(ExactCounts {
            integer: counts.integer + more.integer,
            expansion: counts.expansion + more.expansion,
            symbolic: counts.symbolic + more.symbolic,
        });
    }

    /// The number of vertices.
    pub fn len(&self) -> usize {
        if self.indices.is_empty() { self.input.len() } else { self.indices.len() }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The exact coordinates of vertex `v`.
    pub fn point(&self, v: u32) -> [f64; 3] {
        self.input.get(self.input_index(v) as usize)
    }

    /// The input index of vertex `v`.
    #[inline]
    pub fn input_index(&self, v: u32) -> u32 {
        self.indices.get(v as usize).copied().unwrap_or(v)
    }

    /// The input index of every vertex.
    pub fn into_input_indices(self) -> Vec<u32> {
        self.indices
    }

    /// What the filters left open so far.
    pub fn exact_counts(&self) -> ExactCounts {
        self.counts.get()
    }

    /// The coordinates of vertex `v`, stored or not: an array that is empty costs what a bounds check costs.
    #[inline(always)]
    fn coordinate(&self, v: u32) -> [f64; 3] {
        match self.coordinates.get(v as usize) {
            Some(&p) => p,
            None => self.computed(v),
        }
    }

    #[cold]
    #[inline(never)]
    fn computed(&self, i: u32) -> [f64; 3] {
        self.scaled(self.input.get(i as usize))
    }

    fn scaled(&self, p: [f64; 3]) -> [f64; 3] {
        match &self.scaling {
            Scaling::Lattice => self.lattice.narrow(p),
            Scaling::By(scale, varies) => {
                std::array::from_fn(|axis| if varies[axis] { scale.apply(p[axis]) } else { 0.0 })
            }
        }
    }

    /// The sign of det(b − a, c − a, d − a).
    #[inline]
    pub fn orient3d(&self, a: u32, b: u32, c: u32, d: u32) -> Sign {
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.coordinate(v));
        let (u, v, w) = (minus(pa, pd), minus(pb, pd), minus(pc, pd));
        // det(b − a, c − a, d − a) = −det(a − d, b − d, c − d).
        let det = u[0] * (v[2] * w[1] - v[1] * w[2])
            + u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[1] * w[0] - v[0] * w[1]);
        if det.abs() > self.orient3d_bound {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.orient3d_unfiltered([a, b, c, d], u, v, w, det)
    }

    #[inline(never)]
    fn orient3d_unfiltered(&self, vertices: [u32; 4], u: [f64; 3], v: [f64; 3], w: [f64; 3], det: f64) -> Sign {
        let perm = |i: usize, j: usize| (v[i] * w[j]).abs() + (v[j] * w[i]).abs();
        let permanent = u[0].abs() * perm(1, 2) + u[1].abs() * perm(2, 0) + u[2].abs() * perm(0, 1);
        if det.abs() > ORIENT3D * permanent + UNDERFLOW {
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
            ExactStage::Wide { positions, rounded } => match self.wide(positions, rounded, vertices) {
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

    /// Positive when e is inside the sphere through the positively oriented a, b, c, d. Ties are broken symbolically:
    /// never zero for five different vertices, at least four of which are not coplanar.
    #[inline(always)]
    pub fn insphere(&self, [a, b, c, d]: [u32; 4], e: u32) -> Sign {
        let pe = self.coordinate(e);
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| minus(self.coordinate(v), pe));
        let det = insphere_determinant(pa, pb, pc, pd);
        if det.abs() > self.insphere_bound {
            return if det > 0.0 { 1 } else { -1 };
        }
        self.insphere_unfiltered([a, b, c, d, e], [pa, pb, pc, pd], det)
    }

    #[inline(never)]
    fn insphere_unfiltered(&self, vertices: [u32; 5], [a, b, c, d]: [[f64; 3]; 4], det: f64) -> Sign {
        let extent = |axis: usize| a[axis].abs().max(b[axis].abs()).max(c[axis].abs().max(d[axis].abs()));
        if det.abs() > insphere_bound([extent(0), extent(1), extent(2)]) {
            return if det > 0.0 { 1 } else { -1 };
        }
        if det.abs() > INSPHERE * insphere_permanent(a, b, c, d) + UNDERFLOW {
            return if det > 0.0 { 1 } else { -1 };
        }
        let sign = match &self.exact {
            ExactStage::Narrow => {
                self.count(|c| &mut c.integer);
                let [a, b, c, d, e] = vertices.map(|v| self.narrow(v));
                integer::insphere_narrow(a, b, c, d, e)
            }
            ExactStage::Wide { positions, rounded } => match self.wide(positions, rounded, vertices) {
                Some([a, b, c, d, e]) => {
                    self.count(|c| &mut c.integer);
                    integer::insphere_wide(a, b, c, d, e)
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
        symbolic::break_tie(vertices.map(|v| self.input_index(v)), |k| {
            let [a, b, c, d] = symbolic::without(vertices, k);
            self.orient3d(a, b, c, d)
        })
    }

    /// The lattice coordinates of these vertices, if none of them is rounded.
    fn wide<const N: usize>(
        &self,
        positions: &[[i64; 3]],
        rounded: &[bool],
        vertices: [u32; N],
    ) -> Option<[[i64; 3]; N]> {
        let mut all = [[0; 3]; N];
        for (q, v) in all.iter_mut().zip(vertices) {
            *q = match (positions.get(v as usize), rounded.get(v as usize)) {
                (Some(&q), Some(false)) => q,
                (Some(_), Some(true)) => return None,
                _ => {
                    let computed = self.lattice.coordinates(self.point(v));
                    if computed.iter().any(|c| !c.exact) {
                        return None;
                    }
                    computed.map(|c| c.value)
                }
            };
        }
        Some(all)
    }

    fn narrow(&self, v: u32) -> [i64; 3] {
        self.coordinate(v).map(|x| x as i64)
    }

    fn count(&self, field: impl Fn(&mut ExactCounts) -> &mut u64) {
        let mut counts = self.counts.get();
        *field(&mut counts) += 1;
        self.counts.set(counts);
    }
}

/// The error of an orientation's floating-point value where no difference of coordinates exceeds x, y and z: the permanent
/// is at most 6·x·y·z. The last factor covers the roundings here.
fn orient3d_bound([x, y, z]: [f64; 3]) -> f64 {
    ORIENT3D * 6.0 * x * y * z * (1.0 + 64.0 * EPSILON) + UNDERFLOW
}

/// Likewise for an in-sphere determinant, whose permanent is at most 4·(x² + y² + z²)·6·x·y·z.
#[inline]
fn insphere_bound([x, y, z]: [f64; 3]) -> f64 {
    INSPHERE * 24.0 * x * y * z * (x * x + y * y + z * z) * (1.0 + 64.0 * EPSILON) + UNDERFLOW
}

#[inline]
fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline]
fn insphere_determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> f64 {
    let minor = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - q[0] * p[1];
    let (ab, bc, cd, da) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a));
    let (ac, bd) = (minor(a, c), minor(b, d));
    let abc = a[2] * bc - b[2] * ac + c[2] * ab;
    let bcd = b[2] * cd - c[2] * bd + d[2] * bc;
    let cda = c[2] * da + d[2] * ac + a[2] * cd;
    let dab = d[2] * ab + a[2] * bd + b[2] * da;
    let lift = |p: [f64; 3]| p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    (lift(a) * bcd - lift(b) * cda) + (lift(c) * dab - lift(d) * abc)
}

fn insphere_permanent(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> f64 {
    let minor = |p: [f64; 3], q: [f64; 3]| (p[0] * q[1]).abs() + (q[0] * p[1]).abs();
    let (ab, bc, cd, da) = (minor(a, b), minor(b, c), minor(c, d), minor(d, a));
    let (ac, bd) = (minor(a, c), minor(b, d));
    let [az, bz, cz, dz] = [a, b, c, d].map(|p| p[2].abs());
    let abc = az * bc + bz * ac + cz * ab;
    let bcd = bz * cd + cz * bd + dz * bc;
    let cda = cz * da + dz * ac + az * cd;
    let dab = dz * ab + az * bd + bz * da;
    let lift = |p: [f64; 3]| p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    lift(a) * bcd + lift(b) * cda + lift(c) * dab + lift(d) * abc
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every sign that `Vertices` gives for the first five points agrees with the exact predicates on `f64`.
    fn agree(points: &[[f64; 3]]) -> Result<(), TestCaseError> {
        let lattice = Lattice::fit(points.into());
        // An order that differs from the input's, for the ties.
        let indices: Vec<u32> = (0..points.len() as u32).rev().collect();
        let vertices = Vertices::new(points.into(), &lattice, indices);
        let p = |v: u32| points[vertices.input_index(v) as usize];
        let sign = exact::orient3d(p(0), p(1), p(2), p(3));
        prop_assert_eq!(vertices.orient3d(0, 1, 2, 3), sign);
        prop_assert_eq!(vertices.orient3d(1, 0, 2, 3), -sign);
        prop_assert_eq!(vertices.orient3d_exact([0, 1, 2, 3]), sign);
        let five = [0, 1, 2, 3, 4].map(|v| (vertices.input_index(v), p(v)));
        prop_assert_eq!(vertices.insphere([0, 1, 2, 3], 4), symbolic::insphere_symbolic(five));
        Ok(())
    }

    fn near(exponent: std::ops::RangeInclusive<i32>) -> impl Strategy<Value = f64> {
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
        fn mixed_exponents(points in prop::array::uniform5(prop::array::uniform3(near(-40..=4)))) {
            agree(&points)?;
        }

        #[test]
        fn any_finite(points in prop::array::uniform5(prop::array::uniform3(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO))) {
            agree(&points)?;
        }

        #[test]
        fn cospherical(points in prop::array::uniform5((0usize..1 << 20).prop_map(|i| {
            // Rational points of the unit sphere are cospherical up to rounding; those of a sphere of integers exactly.
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
}
