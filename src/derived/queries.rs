//! Query points, in an order in which consecutive ones are near each other.

use crate::{
    error::Error,
    geometry::{Euclidean, Geometry},
    input::points::Points,
    parallel::{self, Threads},
};

/// The number of queries that is worth handing to another thread.
const GRAIN: usize = 1 << 11;

/// Maps points to their places along the Hilbert curve that fills a box.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CurveKey<const D: usize> {
    low: [f64; D],
    /// Cells per unit of each axis.
    scale: [f64; D],
}

impl<const D: usize> CurveKey<D> {
    /// Bits per axis, so that a key fits beside an index in 64 bits.
    const BITS: u32 = 32 / D as u32;

    pub(crate) fn new([low, high]: [[f64; D]; 2]) -> Self {
        let cells = (1u64 << Self::BITS) as f64;
        CurveKey { low, scale: std::array::from_fn(|axis| cells / (high[axis] - low[axis])) }
    }

    /// Returns the place of the cell that contains `p`, or of the nearest cell if `p` is outside
    /// the box.
    #[inline]
    pub(crate) fn of<const N: usize>(&self, p: [f64; D]) -> u32
    where
        Euclidean: Geometry<D, N>,
    {
        let last = (1u32 << Self::BITS) - 1;
        // A conversion to an integer saturates, and makes 0 of NaN, where the box has no width.
        let cell = std::array::from_fn(|axis| (((p[axis] - self.low[axis]) * self.scale[axis]) as u32).min(last));
        (<Euclidean as Geometry<D, N>>::CURVE)(cell, Self::BITS) as u32
    }
}

/// Calls `work` with every query, its index and a state, along the curve, and returns the results
/// in the order of the queries. Threads have a state each, so the results must not depend on it.
pub(crate) fn map_along_curve<const D: usize, const N: usize, S, R: Copy + Send>(
    queries: Points<'_, D>,
    key: CurveKey<D>,
    state: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, [f64; D]) -> Result<R, Error> + Sync,
) -> Result<Vec<R>, Error>
where
    Euclidean: Geometry<D, N>,
{
    queries.validate_by(Threads::All)?;
    if queries.len() > u32::MAX as usize {
        return Err(Error::TooManyPoints { points: queries.len(), limit: u32::MAX as usize });
    }
    let order = order_along_curve(queries, key);
    let results = parallel::map_grains(Threads::All, order.len(), GRAIN, |range| {
        let mut state = state();
        order[range].iter().map(|&query| work(&mut state, queries.get(query as usize))).collect::<Result<Vec<_>, _>>()
    });
    let mut results = results.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten();
    let Some(first) = results.next() else { return Ok(Vec::new()) };
    let mut sorted = vec![first; queries.len()];
    for (&query, result) in order[1..].iter().zip(results) {
        sorted[query as usize] = result;
    }
    Ok(sorted)
}

/// Returns the indices of points in their order along the curve. There are at most 2³² points.
pub(crate) fn order_along_curve<const D: usize, const N: usize>(points: Points<'_, D>, key: CurveKey<D>) -> Vec<u32>
where
    Euclidean: Geometry<D, N>,
{
    let ranges = parallel::map_ranges(Threads::All, points.len(), |range| {
        let place = |i: usize| u64::from(key.of::<N>(points.get(i))) << 32 | i as u64;
        range.map(place).collect::<Vec<_>>()
    });
    let mut keyed = parallel::joined(ranges);
    parallel::sort(Threads::All, &mut keyed);
    keyed.into_iter().map(|entry| entry as u32).collect()
}
