//! A point set prepared for fast exact predicates: floating-point filters first, then lattice
//! integers, then expansions (the paper's §4.4).

mod d2;
mod d3;
mod weights;

pub(crate) use d3::{Row, Rows};

use crate::{
    input::{
        lattice::{Lattice, Width},
        points::Points,
    },
    parallel::{self, Threads},
    predicates::integer,
    stats::ExactCounts,
};
use std::{cell::Cell, sync::Arc};
use weights::{WEIGHT_BITS, Weights, in_sphere_error, underflow};

/// The maximum roundoff of Shewchuk's determinants, as multiples of their permanents.
#[derive(Clone, Copy)]
struct ErrorBounds {
    orientation: f64,
    in_sphere: f64,
}

/// The maximum relative error of a rounded operation, 2⁻⁵³.
const EPSILON: f64 = f64::EPSILON / 2.0;

/// By dimension: the bounds of `orient2d` and `incircle`, and of `orient3d` and `insphere`
/// (*Adaptive precision floating-point arithmetic*, 1997, §4), which include the rounding of the
/// differences. That of `insphere` has 512·ε² instead of his 224·ε²: its products may be summed in
/// another order, with 121·ε² instead of less for second-order terms, and its permanent is rounded
/// up to 12 times, 192·ε².
const ERROR_BOUNDS: [ErrorBounds; 4] = [
    ErrorBounds { orientation: 0.0, in_sphere: 0.0 },
    ErrorBounds { orientation: 0.0, in_sphere: 0.0 },
    ErrorBounds { orientation: (3.0 + 16.0 * EPSILON) * EPSILON, in_sphere: (10.0 + 96.0 * EPSILON) * EPSILON },
    ErrorBounds { orientation: (7.0 + 56.0 * EPSILON) * EPSILON, in_sphere: (16.0 + 512.0 * EPSILON) * EPSILON },
];

/// Wide lattice coordinates have so many bits more than stored coordinates have before the point.
const WIDER: u32 = Width::Wide.bits() - Width::Narrow.bits();

/// Added to every error bound, 2⁻⁹⁰⁰. Coordinates are scaled to a range of 2³¹, so the total effect
/// of underflow, 2⁻¹⁰⁷⁴ in each of about a hundred operations, times at most 2¹⁵⁷ of later factors,
/// is far below it.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// Points in an order of the caller's choosing (*vertices*), with the predicates on them.
///
/// With weights, for which `W` stands, the in-sphere and in-circle tests are power tests: point *i* is lifted to the
/// height |pᵢ|² − wᵢ instead of |pᵢ|². Without them, nothing is computed that has to do with weights.
///
/// The signs are those of the exact input coordinates; the symbolic ties are those of the input
/// indices.
///
/// Each predicate checks once whether coordinates are stored and then reads them itself, in text
/// that the four predicates have in common but do not share: one function for all, which took the
/// determinant as a closure, passed the coordinates through memory and made the insertion take 1.5
/// times as long.
pub struct PredicateContext<'a, const D: usize, const W: bool = false> {
    input: Points<'a, D>,
    lattice: Lattice<D>,
    /// The input index of each vertex; empty if the vertices are the input points in their order.
    indices: Arc<Vec<u32>>,
    /// The index by which the ties of each vertex are broken: its input index, unless the caller has others.
    ties: Arc<Vec<u32>>,
    /// Input coordinates times a power of two that brings the range of every axis below 2³¹; for a
    /// narrow lattice, the lattice coordinates. Empty if they are computed each time.
    coordinates: Arc<Vec<[f64; D]>>,
    weights: Weights<'a>,
    scaling: Scaling<D>,
    exact: ExactStage<D>,
    /// Bounds, valid for all arguments, of the error of the determinants' floating-point values.
    orientation_bound: f64,
    in_sphere_bound: f64,
    counts: Cell<ExactCounts>,
}

/// The predicates of which one vertex is given, so that its coordinates need not be looked up each
/// time.
#[derive(Clone, Copy)]
pub(crate) struct PredicatesAt<'c, 'a, const D: usize, const W: bool = false> {
    context: &'c PredicateContext<'a, D, W>,
    vertex: u32,
    /// The coordinates of all vertices; empty if they are computed each time.
    stored: &'c [[f64; D]],
    /// The coordinates of the vertex if they are stored.
    place: [f64; D],
}

/// 2D points in an order of the caller's choosing (*vertices*), with the predicates on them.
pub type PredicateContext2<'a> = PredicateContext<'a, 2>;

/// 3D points in an order of the caller's choosing (*vertices*), with the predicates on them.
pub type PredicateContext3<'a> = PredicateContext<'a, 3>;

/// The exact stage, which evaluates the predicates that the filters leave open.
#[derive(Clone)]
enum ExactStage<const D: usize> {
    /// 31-bit integers, which are the `coordinates`.
    Narrow,
    /// 62-bit integers where no coordinate of the vertices is rounded, expansions elsewhere.
    Wide(Wide<D>),
}

/// The vertices on a wide lattice.
#[derive(Clone, Default)]
struct Wide<const D: usize> {
    /// Whether each vertex is rounded; empty if that is computed each time.
    rounded: Arc<Vec<bool>>,
    /// The positions on a stretched lattice, if the lattice is stretched.
    stretched: Option<Stretched<D>>,
}

/// The vertices on a stretched lattice.
#[derive(Clone)]
struct Stretched<const D: usize> {
    positions: Arc<Vec<[i64; D]>>,
    /// The shift of each axis of the lattice.
    shifts: [u32; D],
}

/// How coordinates are computed from the input.
#[derive(Clone)]
enum Scaling<const D: usize> {
    /// They are the lattice coordinates.
    Lattice,
    /// They are the input's times a power of two, except that an axis on which the points agree is
    /// 0.
    By(Scale, [bool; D]),
}

/// A multiplication by a power of two that `f64` need not be able to represent, as two
/// multiplications by powers of two that it represents.
#[derive(Clone)]
struct Scale([f64; 2]);

impl Scale {
    /// Creates the multiplication by 2^`exponent`.
    fn new(exponent: i32) -> Self {
        // |exponent| is at most 62 + 1074.
        let half = exponent.clamp(-2000, 2000) / 2;
        Scale([half, exponent.clamp(-2000, 2000) - half].map(|e| f64::from_bits(((1023 + e) as u64) << 52)))
    }

    /// Multiplies `x`; exact unless the result is subnormal.
    fn apply(&self, x: f64) -> f64 {
        x * self.0[0] * self.0[1]
    }
}

impl<const D: usize> Scaling<D> {
    /// Computes the coordinates of a point of the input that `lattice` was fitted to.
    fn apply(&self, lattice: &Lattice<D>, p: [f64; D]) -> [f64; D] {
        match self {
            Scaling::Lattice => lattice.narrow(p),
            Scaling::By(scale, varies) => {
                std::array::from_fn(|axis| if varies[axis] { scale.apply(p[axis]) } else { 0.0 })
            }
        }
    }
}

impl<'a, const D: usize> PredicateContext<'a, D> {
    /// Creates a context in which vertex *v* is point `indices[v]` of the input. The points must be
    /// finite, and `lattice` fitted to them.
    ///
    /// The coordinates of the vertices are stored, which is best for many predicate evaluations.
    pub fn new(input: Points<'a, D>, lattice: &Lattice<D>, indices: Vec<u32>) -> Self {
        PredicateContext::new_by(Threads::One, input, lattice, indices)
    }

    /// Creates the context of [`PredicateContext::new`] by `threads`.
    pub(crate) fn new_by(threads: Threads, input: Points<'a, D>, lattice: &Lattice<D>, indices: Vec<u32>) -> Self {
        let mut context = PredicateContext::of_input(input, lattice);
        context.store(threads, indices);
        context
    }

    /// Breaks the ties of input point *i* by the index `ranks[i]`.
    pub(crate) fn ranked(self, ranks: &[u32]) -> Self {
        let of_vertices = self.indices.iter().map(|&i| ranks[i as usize]).collect();
        let ties = if self.indices.is_empty() { ranks.to_vec() } else { of_vertices };
        PredicateContext { ties: Arc::new(ties), ..self }
    }

    /// Creates a context whose vertices are the points of the input in their order. The points must
    /// be finite, and `lattice` fitted to them.
    ///
    /// Nothing is stored, which is best for few predicate evaluations.
    pub fn of_input(input: Points<'a, D>, lattice: &Lattice<D>) -> Self {
        PredicateContext::of_weighted(input, &[], lattice)
    }

    /// Returns the arguments of [`PredicateContext::of_input`] that create an equal context for
    /// another thread, or `None` if coordinates are stored.
    pub(crate) fn source(&self) -> Option<(Points<'a, D>, &Lattice<D>)> {
        self.coordinates.is_empty().then_some((self.input, &self.lattice))
    }
}

impl<'a, const D: usize, const W: bool> PredicateContext<'a, D, W> {
    /// Stores the coordinates of the points with these indices, which become the vertices.
    fn store(&mut self, threads: Threads, indices: Vec<u32>) {
        let Self { scaling, lattice, input, .. } = self;
        let (scaling, lattice, input, weights) = (&*scaling, &*lattice, *input, self.weights.input);
        let mut coordinates = bytemuck::zeroed_vec(indices.len());
        if let ExactStage::Narrow = self.exact {
            parallel::for_chunks(threads, &mut coordinates, |start, chunk| {
                for (p, &i) in chunk.iter_mut().zip(&indices[start..]) {
                    *p = scaling.apply(lattice, input.get(i as usize));
                }
            });
        } else {
            let mut rounded: Vec<bool> = bytemuck::zeroed_vec(indices.len());
            let lists = (&mut coordinates[..], &mut rounded[..]);
            parallel::for_chunk_pairs(threads, lists, |start, (coordinates, rounded)| {
                for ((p, rounded), &i) in coordinates.iter_mut().zip(rounded).zip(&indices[start..]) {
                    let point = input.get(i as usize);
                    *p = scaling.apply(lattice, point);
                    *rounded =
                        lattice.rounds(point) || (W && lattice.weight(weights[i as usize], WEIGHT_BITS).is_none());
                }
            });
            // Few inputs have points that are rounded, and few of these have axes that differ. With weights, the lattice
            // is not stretched: these would be stretched by another factor for each axis.
            let number = rounded.iter().filter(|&&rounded| rounded).count();
            let stretched = if W { None } else { lattice.stretched(integer::MAX_SHIFT).filter(|_| number > 0) };
            let better = stretched.and_then(|lattice| stretch(threads, input, &lattice, &indices, number / 2));
            self.exact =
                ExactStage::Wide(better.unwrap_or_else(|| Wide { rounded: Arc::new(rounded), stretched: None }));
        }
        self.coordinates = Arc::new(coordinates);
        self.indices = Arc::new(indices);
        self.ties = Arc::clone(&self.indices);
    }

    /// Returns a context of the same vertices for another thread, which shares what is stored and
    /// counts for itself.
    pub(crate) fn fork(&self) -> Self {
        PredicateContext {
            input: self.input,
            lattice: self.lattice.clone(),
            indices: Arc::clone(&self.indices),
            ties: Arc::clone(&self.ties),
            coordinates: Arc::clone(&self.coordinates),
            weights: self.weights.clone(),
            scaling: self.scaling.clone(),
            exact: self.exact.clone(),
            orientation_bound: self.orientation_bound,
            in_sphere_bound: self.in_sphere_bound,
            counts: Cell::default(),
        }
    }

    /// Creates a context of which nothing is stored.
    fn of_weighted(input: Points<'a, D>, weights: &'a [f64], lattice: &Lattice<D>) -> Self {
        let (scaling, exact) = match lattice.width() {
            Width::Narrow => (Scaling::Lattice, ExactStage::Narrow),
            Width::Wide => {
                let exponent = lattice.exponent() - WIDER as i32;
                (Scaling::By(Scale::new(exponent), lattice.varies()), ExactStage::Wide(Wide::default()))
            }
        };
        let mut context = PredicateContext {
            input,
            lattice: lattice.clone(),
            indices: Arc::default(),
            ties: Arc::default(),
            coordinates: Arc::default(),
            weights: Weights { input: weights, scaled: Arc::default() },
            scaling,
            exact,
            orientation_bound: 0.0,
            in_sphere_bound: 0.0,
            counts: Cell::default(),
        };
        let [low, high] = lattice.bounds().map(|corner| context.scaled(corner));
        let extents: [f64; D] = std::array::from_fn(|axis| (high[axis] - low[axis]).max(0.0));
        context.orientation_bound = orientation_bound(extents);
        context.in_sphere_bound = in_sphere_bound::<D, false>(extents, 0.0);
        context
    }

    /// Returns the predicates of which `vertex` is given.
    #[inline]
    pub(crate) fn at(&self, vertex: u32) -> PredicatesAt<'_, 'a, D, W> {
        let stored = self.coordinates.as_slice();
        let place = if stored.is_empty() { [0.0; D] } else { stored[vertex as usize] };
        PredicatesAt { context: self, vertex, stored, place }
    }

    /// Adds the counts of other contexts of the same points.
    pub(crate) fn add_counts(&self, more: ExactCounts) {
        self.counts.set(self.counts.get() + more);
    }

    /// Returns the number of vertices.
    pub fn len(&self) -> usize {
        if self.indices.is_empty() { self.input.len() } else { self.indices.len() }
    }

    /// Returns whether there are no vertices.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the exact coordinates of vertex `v`.
    pub fn point(&self, v: u32) -> [f64; D] {
        self.input.get(self.input_index(v) as usize)
    }

    /// Returns the input index of vertex `v`.
    #[inline]
    pub fn input_index(&self, v: u32) -> u32 {
        self.indices.get(v as usize).copied().unwrap_or(v)
    }

    /// Returns the index by which the ties of vertex `v` are broken.
    #[inline]
    fn rank(&self, v: u32) -> u32 {
        self.ties.get(v as usize).copied().unwrap_or(v)
    }

    /// Returns the input index of every vertex.
    pub fn into_input_indices(self) -> Arc<Vec<u32>> {
        self.indices
    }

    /// Returns the number of predicate evaluations so far that the filters left open.
    pub fn exact_counts(&self) -> ExactCounts {
        self.counts.get()
    }

    /// Returns the coordinates of vertex `v`, stored or not.
    fn coordinate(&self, v: u32) -> [f64; D] {
        self.coordinates.get(v as usize).copied().unwrap_or_else(|| self.computed(v))
    }

    /// Computes the coordinates of input point `i`.
    fn computed(&self, i: u32) -> [f64; D] {
        self.scaled(self.input.get(i as usize))
    }

    /// Computes the coordinates of a point of the input.
    fn scaled(&self, p: [f64; D]) -> [f64; D] {
        self.scaling.apply(&self.lattice, p)
    }

    /// Returns the lattice coordinates of these vertices, if none of them is rounded.
    fn wide<const N: usize>(&self, wide: &Wide<D>, vertices: [u32; N]) -> Option<[[i64; D]; N]> {
        if wide.rounded.is_empty() {
            return self.computed_wide(vertices);
        }
        if vertices.iter().any(|&v| wide.rounded[v as usize]) {
            return None;
        }
        Some(match &wide.stretched {
            None => vertices.map(|v| self.lattice.position(self.coordinates[v as usize], WIDER)),
            Some(stretched) => vertices.map(|v| stretched.positions[v as usize]),
        })
    }

    #[inline(never)]
    fn computed_wide<const N: usize>(&self, vertices: [u32; N]) -> Option<[[i64; D]; N]> {
        let computed = vertices.map(|v| self.lattice.coordinates(self.point(v)));
        let exact = computed.as_flattened().iter().all(|c| c.exact);
        exact.then(|| computed.map(|q| q.map(|c| c.value)))
    }

    /// Returns the narrow lattice coordinates of vertex `v`.
    fn narrow(&self, v: u32) -> [i64; D] {
        self.coordinate(v).map(|x| x as i64)
    }

    /// Increments one of the counts.
    fn count(&self, field: impl Fn(&mut ExactCounts) -> &mut u64) {
        let mut counts = self.counts.get();
        *field(&mut counts) += 1;
        self.counts.set(counts);
    }
}

/// Returns what is known of vertices on a stretched lattice, if it rounds fewer of them than
/// `limit`.
fn stretch<const D: usize>(
    threads: Threads,
    input: Points<'_, D>,
    lattice: &Lattice<D>,
    indices: &[u32],
    limit: usize,
) -> Option<Wide<D>> {
    let mut positions: Vec<[i64; D]> = bytemuck::zeroed_vec(indices.len());
    let mut rounded: Vec<bool> = bytemuck::zeroed_vec(indices.len());
    let lists = (&mut positions[..], &mut rounded[..]);
    parallel::for_chunk_pairs(threads, lists, |start, (positions, rounded)| {
        for ((position, rounded), &i) in positions.iter_mut().zip(rounded).zip(&indices[start..]) {
            let q = lattice.coordinates(input.get(i as usize));
            *position = q.map(|c| c.value);
            *rounded = q.iter().any(|c| !c.exact);
        }
    });
    let number = rounded.iter().filter(|&&rounded| rounded).count();
    let stretched = Stretched { positions: Arc::new(positions), shifts: lattice.shifts() };
    (number < limit).then(|| Wide { rounded: Arc::new(rounded), stretched: Some(stretched) })
}

/// Returns a bound of the error of an orientation's floating-point value if no difference of
/// coordinates exceeds the `extents`: the permanent is at most D! times their product. The last
/// factor covers the roundings in the bound itself.
#[inline]
fn orientation_bound<const D: usize>(extents: [f64; D]) -> f64 {
    ERROR_BOUNDS[D].orientation * greatest_permanent(extents) * (1.0 + 64.0 * EPSILON) + UNDERFLOW
}

/// Returns the same bound for coordinates that are not scaled; infinite where these are so large
/// that underflow, an error of 2⁻¹⁰⁷⁵ in six products with one later factor, could exceed
/// [`UNDERFLOW`].
#[inline]
pub(crate) fn unscaled_orientation_bound<const D: usize>(extents: [f64; D]) -> f64 {
    const LARGEST: f64 = f64::from_bits((1023 + 150) << 52);
    if extents.iter().all(|&extent| extent < LARGEST) { orientation_bound(extents) } else { f64::INFINITY }
}

/// Returns a bound of the error of an in-sphere determinant's floating-point value if no difference
/// of coordinates exceeds the `extents`, and none of weights `weights`: its permanent has D + 1 orientations, each
/// times a squared length and a difference of weights.
#[inline]
fn in_sphere_bound<const D: usize, const W: bool>(extents: [f64; D], weights: f64) -> f64 {
    let squared: f64 = extents.iter().map(|x| x * x).sum();
    let lift = if W { squared + weights } else { squared };
    let permanent = (D + 1) as f64 * lift * greatest_permanent(extents);
    in_sphere_error::<D, W>() * permanent * (1.0 + 64.0 * EPSILON) + underflow::<W>()
}

/// Returns D! times the product of the extents.
#[inline]
fn greatest_permanent<const D: usize>(extents: [f64; D]) -> f64 {
    extents.iter().zip(1..).map(|(x, factor)| x * f64::from(factor)).product()
}

/// Returns the greatest of some numbers, none of which is NaN.
#[inline]
fn greatest<const N: usize>(numbers: [f64; N]) -> f64 {
    numbers.into_iter().reduce(|a, b| if a > b { a } else { b }).unwrap_or(0.0)
}

/// Returns the difference of two points.
#[inline]
fn minus<const D: usize>(a: [f64; D], b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}
