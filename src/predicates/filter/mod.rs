//! A point set prepared for fast exact predicates: floating-point filters, then lattice integers, then expansions.

mod d2;
mod d3;

use crate::{
    Points,
    input::lattice::{Lattice, Width},
    stats::ExactCounts,
};
use std::cell::Cell;

/// What the roundoff of Shewchuk's determinants is at most, as a multiple of their permanents.
#[derive(Clone, Copy)]
struct ErrorBounds {
    orientation: f64,
    in_sphere: f64,
}

const EPSILON: f64 = f64::EPSILON / 2.0;

/// By the dimension: `orient2d` and `incircle`, `orient3d` and `insphere` (*Adaptive precision floating-point
/// arithmetic*, 1997, §4), with the rounded differences counted in.
const ERROR_BOUNDS: [ErrorBounds; 4] = [
    ErrorBounds { orientation: 0.0, in_sphere: 0.0 },
    ErrorBounds { orientation: 0.0, in_sphere: 0.0 },
    ErrorBounds { orientation: (3.0 + 16.0 * EPSILON) * EPSILON, in_sphere: (10.0 + 96.0 * EPSILON) * EPSILON },
    ErrorBounds { orientation: (7.0 + 56.0 * EPSILON) * EPSILON, in_sphere: (16.0 + 224.0 * EPSILON) * EPSILON },
];

/// Added to every error bound: coordinates are scaled to a range of 2³¹, so all that underflow can cost, 2⁻¹⁰⁷⁴ in any
/// of some hundred operations and times at most 2¹⁵⁷ of later factors, is far below it.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// Points in an order of the engine's choosing (*vertices*), with the predicates on them.
///
/// The signs are those of the exact input coordinates; the symbolic ties are those of the input indices.
///
/// Each predicate checks once whether coordinates are stored and then reads them itself, in text that the four predicates
/// have in common but do not share: one function for all, which took the determinant as a closure, passed the coordinates
/// through memory and made the insertion take 1.5 times as long.
pub struct PredicateContext<'a, const D: usize = 3> {
    input: Points<'a, D>,
    lattice: Lattice<D>,
    /// The input index of each vertex; empty when the vertices are the input points in their order.
    indices: Vec<u32>,
    /// Input coordinates times a power of two that brings the range of every axis below 2³¹; for a narrow lattice, the
    /// lattice coordinates. Empty when they are computed anew each time.
    coordinates: Vec<[f64; D]>,
    scaling: Scaling<D>,
    exact: ExactStage<D>,
    /// Error bounds of the determinants' floating-point values that hold for all arguments.
    orientation_bound: f64,
    in_sphere_bound: f64,
    counts: Cell<ExactCounts>,
}

/// Points of the plane, likewise.
pub type PredicateContext2<'a> = PredicateContext<'a, 2>;

/// What decides the signs that the filters leave open.
enum ExactStage<const D: usize> {
    /// 31-bit integers, which the `coordinates` are.
    Narrow,
    /// 62-bit integers, where none of the points is rounded. Empty when they are computed anew each time.
    Wide { positions: Vec<[i64; D]>, rounded: Vec<bool> },
}

/// How coordinates come from the input.
enum Scaling<const D: usize> {
    /// They are the lattice coordinates.
    Lattice,
    /// They are the input's times a power of two, but 0 where an axis does not vary.
    By(Scale, [bool; D]),
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

impl<'a, const D: usize> PredicateContext<'a, D> {
    /// Vertex *v* is `input` point `indices[v]`, and its coordinates lie at place *v* of an array, which is best for many
    /// signs. The points must be finite and `lattice` fitted to them.
    pub fn new(input: Points<'a, D>, lattice: &Lattice<D>, indices: Vec<u32>) -> Self {
        let mut vertices = PredicateContext::of_input(input, lattice);
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
    pub fn of_input(input: Points<'a, D>, lattice: &Lattice<D>) -> Self {
        let (scaling, exact) = match lattice.width() {
            Width::Narrow => (Scaling::Lattice, ExactStage::Narrow),
            Width::Wide => {
                let exponent = lattice.exponent() - (Width::Wide.bits() - Width::Narrow.bits()) as i32;
                let exact = ExactStage::Wide { positions: Vec::new(), rounded: Vec::new() };
                (Scaling::By(Scale::new(exponent), lattice.varies()), exact)
            }
        };
        let mut vertices = PredicateContext {
            input,
            lattice: lattice.clone(),
            indices: Vec::new(),
            coordinates: Vec::new(),
            scaling,
            exact,
            orientation_bound: 0.0,
            in_sphere_bound: 0.0,
            counts: Cell::default(),
        };
        let [low, high] = lattice.bounds().map(|corner| vertices.scaled(corner));
        let extents: [f64; D] = std::array::from_fn(|axis| (high[axis] - low[axis]).max(0.0));
        vertices.orientation_bound = orientation_bound(extents);
        vertices.in_sphere_bound = in_sphere_bound(extents);
        vertices
    }

    /// What [`PredicateContext::of_input`] makes others of, for another thread, if nothing is stored.
    pub(crate) fn source(&self) -> Option<(Points<'a, D>, &Lattice<D>)> {
        self.coordinates.is_empty().then_some((self.input, &self.lattice))
    }

    /// Adds what others of the same points have counted.
    pub(crate) fn add_counts(&self, more: ExactCounts) {
        self.counts.set(self.counts.get() + more);
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
    pub fn point(&self, v: u32) -> [f64; D] {
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

    /// The coordinates of vertex `v`, stored or not.
    fn coordinate(&self, v: u32) -> [f64; D] {
        self.coordinates.get(v as usize).copied().unwrap_or_else(|| self.computed(v))
    }

    fn computed(&self, i: u32) -> [f64; D] {
        self.scaled(self.input.get(i as usize))
    }

    fn scaled(&self, p: [f64; D]) -> [f64; D] {
        match &self.scaling {
            Scaling::Lattice => self.lattice.narrow(p),
            Scaling::By(scale, varies) => {
                std::array::from_fn(|axis| if varies[axis] { scale.apply(p[axis]) } else { 0.0 })
            }
        }
    }

    /// The lattice coordinates of these vertices, if none of them is rounded.
    fn wide<const N: usize>(
        &self,
        positions: &[[i64; D]],
        rounded: &[bool],
        vertices: [u32; N],
    ) -> Option<[[i64; D]; N]> {
        if positions.is_empty() {
            return self.computed_wide(vertices);
        }
        if vertices.iter().any(|&v| rounded[v as usize]) {
            return None;
        }
        Some(vertices.map(|v| positions[v as usize]))
    }

    #[inline(never)]
    fn computed_wide<const N: usize>(&self, vertices: [u32; N]) -> Option<[[i64; D]; N]> {
        let computed = vertices.map(|v| self.lattice.coordinates(self.point(v)));
        let exact = computed.as_flattened().iter().all(|c| c.exact);
        exact.then(|| computed.map(|q| q.map(|c| c.value)))
    }

    fn narrow(&self, v: u32) -> [i64; D] {
        self.coordinate(v).map(|x| x as i64)
    }

    fn count(&self, field: impl Fn(&mut ExactCounts) -> &mut u64) {
        let mut counts = self.counts.get();
        *field(&mut counts) += 1;
        self.counts.set(counts);
    }
}

/// The error of an orientation's floating-point value where no difference of coordinates exceeds the `extents`: the
/// permanent is at most D! times their product. The last factor covers the roundings here.
#[inline]
fn orientation_bound<const D: usize>(extents: [f64; D]) -> f64 {
    ERROR_BOUNDS[D].orientation * greatest_permanent(extents) * (1.0 + 64.0 * EPSILON) + UNDERFLOW
}

/// Likewise for an in-sphere determinant: its permanent has D + 1 orientations, each times a squared length.
#[inline]
fn in_sphere_bound<const D: usize>(extents: [f64; D]) -> f64 {
    let squared: f64 = extents.iter().map(|x| x * x).sum();
    let permanent = (D + 1) as f64 * squared * greatest_permanent(extents);
    ERROR_BOUNDS[D].in_sphere * permanent * (1.0 + 64.0 * EPSILON) + UNDERFLOW
}

#[inline]
fn greatest_permanent<const D: usize>(extents: [f64; D]) -> f64 {
    extents.iter().zip(1..).map(|(x, factor)| x * f64::from(factor)).product()
}

#[inline]
fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}
