//! A point set prepared for fast exact predicates: floating-point filters, then lattice integers, then expansions.

mod plane;
mod space;

use crate::{
    Points,
    lattice::{Lattice, Width},
    stats::ExactCounts,
};
use std::cell::Cell;

/// What the roundoff of Shewchuk's determinants is at most, as a multiple of their permanents.
#[derive(Clone, Copy)]
struct Errors {
    orientation: f64,
    in_sphere: f64,
}

const EPSILON: f64 = f64::EPSILON / 2.0;

/// By the dimension: `orient2d` and `incircle`, `orient3d` and `insphere` (*Adaptive precision floating-point
/// arithmetic*, 1997, §4), with the rounded differences counted in.
const ERRORS: [Errors; 4] = [
    Errors { orientation: 0.0, in_sphere: 0.0 },
    Errors { orientation: 0.0, in_sphere: 0.0 },
    Errors { orientation: (3.0 + 16.0 * EPSILON) * EPSILON, in_sphere: (10.0 + 96.0 * EPSILON) * EPSILON },
    Errors { orientation: (7.0 + 56.0 * EPSILON) * EPSILON, in_sphere: (16.0 + 224.0 * EPSILON) * EPSILON },
];

/// Added to every error bound: coordinates are scaled to a range of 2³¹, so all that underflow can cost, 2⁻¹⁰⁷⁴ in any
/// of some hundred operations and times at most 2¹⁵⁷ of later factors, is far below it.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// Points in an order of the engine's choosing (*vertices*), with the predicates on them.
///
/// The signs are those of the exact input coordinates; the symbolic ties are those of the input indices.
pub struct Vertices<'a, const D: usize = 3> {
    input: Points<'a, D>,
    /// The input index of each vertex.
    indices: Vec<u32>,
    /// Input coordinates times a power of two that brings the range of every axis below 2³¹; for a narrow lattice, the
    /// lattice coordinates.
    coordinates: Vec<[f64; D]>,
    exact: ExactStage<D>,
    /// Error bounds of the determinants' floating-point values that hold for all arguments.
    orientation_bound: f64,
    in_sphere_bound: f64,
    counts: Cell<ExactCounts>,
}

/// Points of the plane, likewise.
pub type Vertices2<'a> = Vertices<'a, 2>;

/// What decides the signs that the filters leave open.
enum ExactStage<const D: usize> {
    /// 31-bit integers, which the `coordinates` are.
    Narrow,
    /// 62-bit integers, where none of the points is rounded.
    Wide { lattice: Vec<[i64; D]>, rounded: Option<Vec<bool>> },
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

impl<'a, const D: usize> Vertices<'a, D> {
    /// Vertex *v* is `input` point `indices[v]`. The points must be finite and `lattice` fitted to them.
    pub fn new(input: Points<'a, D>, lattice: &Lattice<D>, indices: Vec<u32>) -> Self {
        let mut coordinates = Vec::with_capacity(indices.len());
        let exact = match lattice.width() {
            Width::Narrow => {
                let narrow = |&i: &u32| lattice.coordinates(input.get(i as usize)).map(|c| c.value as f64);
                coordinates.extend(indices.iter().map(narrow));
                ExactStage::Narrow
            }
            Width::Wide => {
                let exponent = lattice.exponent() - (Width::Wide.bits() - Width::Narrow.bits()) as i32;
                let scale = Scale::new(exponent);
                let varies = lattice.varies();
                let mut words = Vec::with_capacity(indices.len());
                let mut rounded = Vec::new();
                for (v, &i) in indices.iter().enumerate() {
                    let p = input.get(i as usize);
                    coordinates.push(std::array::from_fn(|axis| if varies[axis] { scale.apply(p[axis]) } else { 0.0 }));
                    let q = lattice.coordinates(p);
                    words.push(q.map(|c| c.value));
                    if q.iter().any(|c| !c.exact) {
                        rounded.resize(indices.len(), false);
                        rounded[v] = true;
                    }
                }
                ExactStage::Wide { lattice: words, rounded: (!rounded.is_empty()).then_some(rounded) }
            }
        };
        let mut low = [f64::INFINITY; D];
        let mut high = [f64::NEG_INFINITY; D];
        for p in &coordinates {
            for axis in 0..D {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
        }
        let extents: [f64; D] = std::array::from_fn(|axis| (high[axis] - low[axis]).max(0.0));
        Vertices {
            input,
            indices,
            coordinates,
            exact,
            orientation_bound: orientation_bound(extents),
            in_sphere_bound: in_sphere_bound(extents),
            counts: Cell::default(),
        }
    }

    /// The number of vertices.
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// The exact coordinates of vertex `v`.
    pub fn point(&self, v: u32) -> [f64; D] {
        self.input.get(self.indices[v as usize] as usize)
    }

    /// The input index of vertex `v`.
    pub fn input_index(&self, v: u32) -> u32 {
        self.indices[v as usize]
    }

    /// The input index of every vertex.
    pub fn into_input_indices(self) -> Vec<u32> {
        self.indices
    }

    /// What the filters left open so far.
    pub fn exact_counts(&self) -> ExactCounts {
        self.counts.get()
    }

    fn narrow(&self, v: u32) -> [i64; D] {
        self.coordinates[v as usize].map(|x| x as i64)
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
    ERRORS[D].orientation * greatest_permanent(extents) * (1.0 + 64.0 * EPSILON) + UNDERFLOW
}

/// Likewise for an in-sphere determinant: its permanent has D + 1 orientations, each times a squared length.
#[inline]
fn in_sphere_bound<const D: usize>(extents: [f64; D]) -> f64 {
    let squared: f64 = extents.iter().map(|x| x * x).sum();
    let permanent = (D + 1) as f64 * squared * greatest_permanent(extents);
    ERRORS[D].in_sphere * permanent * (1.0 + 64.0 * EPSILON) + UNDERFLOW
}

#[inline]
fn greatest_permanent<const D: usize>(extents: [f64; D]) -> f64 {
    extents.iter().zip(1..).map(|(x, factor)| x * f64::from(factor)).product()
}

fn unrounded(rounded: &Option<Vec<bool>>, vertices: &[u32]) -> bool {
    rounded.as_ref().is_none_or(|rounded| vertices.iter().all(|&v| !rounded[v as usize]))
}

#[inline]
fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}
