//! Query points, in an order in which consecutive ones are near each other.

use crate::{
    error::Error,
    geometry::{Euclidean, Geometry},
    input::points::Points,
    parallel::{self, Threads},
};

/// The number of queries that is worth handing to another thread.
const GRAIN: usize = 1 << 11;

/// How many times as long as along the curve the way through queries may be as they are given.
const MOST_DETOUR: f64 = 4.0;

/// Maps points to their places along the Hilbert curve that fills a box.
///
/// The cell of a coordinate *x* is ⌊x·2ᵏ⌋ less that of the box, with the largest *k* for which all
/// cells fit: no step rounds, so that the device, which has integers only, finds the same cell.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CurveKey<const D: usize> {
    /// 2ᵏ for each axis.
    factors: [f64; D],
    /// ⌊x·2ᵏ⌋ of the lowest coordinates.
    origin: [f64; D],
}

impl<const D: usize> CurveKey<D> {
    /// Bits per axis, so that a key fits beside an index in 64 bits.
    const BITS: u32 = 30 / D as u32;
    /// The number of cells of an axis.
    const CELLS: u32 = 1 << Self::BITS;
    /// The most by which the *k* of an axis exceeds another one.
    const MAX_STRETCH: i32 = 40;

    pub(crate) fn new([low, high]: [[f64; D]; 2]) -> Self {
        let own: [Option<i32>; D] = std::array::from_fn(|axis| largest_exponent(low[axis], high[axis], Self::CELLS));
        let max = own.iter().flatten().min().map_or(0, |min| min + Self::MAX_STRETCH);
        let factors = own.map(|k| libm::ldexp(1.0, k.unwrap_or(0).min(max)));
        CurveKey { factors, origin: std::array::from_fn(|axis| floor_product(low[axis], factors[axis])) }
    }

    /// Returns the place of the cell that contains `p`, or of the nearest cell if `p` is outside
    /// the box.
    #[inline]
    pub(crate) fn of<const N: usize>(&self, p: [f64; D]) -> u32
    where
        Euclidean: Geometry<D, N>,
    {
        let cell = std::array::from_fn(|axis| {
            // A conversion to an integer saturates.
            ((floor_product(p[axis], self.factors[axis]) - self.origin[axis]) as u32).min(Self::CELLS - 1)
        });
        (<Euclidean as Geometry<D, N>>::CURVE)(cell, Self::BITS) as u32
    }

    /// Returns about how far two points are from each other, as a share of the box: at most 1.
    fn distance(&self, p: [f64; D], q: [f64; D]) -> f64 {
        let cells = (0..D).map(|axis| ((p[axis] - q[axis]) * self.factors[axis]).abs());
        cells.fold(0.0, f64::max).min(f64::from(Self::CELLS)) / f64::from(Self::CELLS)
    }

    /// Returns *k* of each axis, and ⌊x·2ᵏ⌋ of the lowest coordinates modulo 2⁶⁴.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub(crate) fn cells(&self) -> [(i32, u64); D] {
        std::array::from_fn(|axis| (libm::ilogb(self.factors[axis]), self.origin[axis] as i128 as u64))
    }
}

/// Returns the largest *k*, within what `f64` represents, for which there are at most so many cells
/// of the size 2⁻ᵏ from `low` to `high`; `None` if these are equal, or there is no box.
fn largest_exponent(low: f64, high: f64, cells: u32) -> Option<i32> {
    // The halves do not overflow.
    let half = high / 2.0 - low / 2.0;
    if !(low < high && half.is_finite()) {
        return None;
    }
    let exponent = if half > 0.0 { libm::ilogb(half) } else { -1074 };
    let mut k = (cells.ilog2() as i32 - exponent).clamp(-1000, 1000);
    let count = |k: i32| {
        let factor = libm::ldexp(1.0, k);
        floor_product(high, factor) - floor_product(low, factor)
    };
    while count(k) >= f64::from(cells) {
        k -= 1;
    }
    Some(k)
}

/// Returns ⌊x·f⌋ for a power of two *f*.
#[inline(always)]
fn floor_product(x: f64, factor: f64) -> f64 {
    let product = x * factor;
    // What underflows is negative nevertheless.
    if product == 0.0 && x < 0.0 { -1.0 } else { product.floor() }
}

/// Calls `work` with runs of queries of which consecutive ones are near each other, and returns the results, of which
/// there is one for each query of a run, in the order of the queries. The results must not depend on which queries are
/// in a run, and in which order.
pub(crate) fn map_along_curve<const D: usize, const N: usize, R: Copy + Send>(
    queries: Points<'_, D>,
    key: CurveKey<D>,
    work: impl Fn(&[[f64; D]]) -> Result<Vec<R>, Error> + Sync,
) -> Result<Vec<R>, Error>
where
    Euclidean: Geometry<D, N>,
{
    let (order, results) = along_curve(queries, key, work)?;
    let mut results = results.into_iter().flatten();
    let Some(first) = results.next() else { return Ok(Vec::new()) };
    let mut sorted = vec![first; queries.len()];
    for (&query, result) in order[1..].iter().zip(results) {
        sorted[query as usize] = result;
    }
    Ok(sorted)
}

/// Calls `work` with runs of queries that are consecutive along the curve, or as they are given, if that is about as
/// short a way: along the rows of a raster, for example. Returns the queries in this order, and the result of each run.
pub(super) fn along_curve<const D: usize, const N: usize, R: Send>(
    queries: Points<'_, D>,
    key: CurveKey<D>,
    work: impl Fn(&[[f64; D]]) -> Result<R, Error> + Sync,
) -> Result<(Vec<u32>, Vec<R>), Error>
where
    Euclidean: Geometry<D, N>,
{
    queries.validate_by(Threads::All)?;
    if queries.len() > u32::MAX as usize {
        return Err(Error::TooManyPoints { points: queries.len(), limit: u32::MAX as usize });
    }
    let order =
        if is_ordered(queries, key) { (0..queries.len() as u32).collect() } else { order_along_curve(queries, key) };
    let results = parallel::map_grains(Threads::All, order.len(), GRAIN, |range| {
        let mut run = Vec::with_capacity(GRAIN.min(range.len()));
        let parts = order[range].chunks(GRAIN).map(|part| {
            run.clear();
            run.extend(part.iter().map(|&query| queries.get(query as usize)));
            work(&run)
        });
        parts.collect::<Result<Vec<R>, Error>>()
    });
    let results = results.into_iter().collect::<Result<Vec<Vec<R>>, Error>>()?;
    Ok((order, results.into_iter().flatten().collect()))
}

/// Returns whether the way from query to query, as they are given, is not much longer than along the curve.
fn is_ordered<const D: usize>(queries: Points<'_, D>, key: CurveKey<D>) -> bool {
    let parts = parallel::map_ranges(Threads::All, queries.len(), |range| {
        let steps = range.start.max(1)..range.end;
        steps.map(|i| key.distance(queries.get(i - 1), queries.get(i))).sum::<f64>()
    });
    // Along the curve, all n queries are in steps of 1/n of the volume; along rows, each row is gone through twice.
    let along_curve = libm::pow(queries.len() as f64, 1.0 - 1.0 / D as f64);
    parts.into_iter().sum::<f64>() <= MOST_DETOUR * along_curve
}

/// Returns the indices of points in their order along the curve. There are at most 2³² points.
pub(crate) fn order_along_curve<const D: usize, const N: usize>(points: Points<'_, D>, key: CurveKey<D>) -> Vec<u32>
where
    Euclidean: Geometry<D, N>,
{
    parallel::order_of(Threads::All, places(points, key))
}

/// Returns the places of points along the curve.
pub(super) fn places<const D: usize, const N: usize>(points: Points<'_, D>, key: CurveKey<D>) -> Vec<u32>
where
    Euclidean: Geometry<D, N>,
{
    parallel::joined(parallel::map_ranges(Threads::All, points.len(), |range| {
        range.map(|i| key.of::<N>(points.get(i))).collect::<Vec<_>>()
    }))
}
