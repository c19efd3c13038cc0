//! The solid: simplices that are inside, without specks and bubbles.

use super::super::{complex::Complex, sets::DisjointSets};
use crate::{
    geometry::{Euclidean, Geometry, measure},
    parallel::{self, Threads},
};

/// Removes the pieces of the solid, and fills its cavities, that are smaller than `share` of its
/// largest piece. Pieces and cavities hang together across facets. Returns how many they were.
pub(super) fn drop_small<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    is_inside: &mut [bool],
    share: f64,
) -> [usize; 2]
where
    Euclidean: Geometry<D, N>,
{
    let count = is_inside.len();
    // The last number is that of the space outside the hull.
    let sides: &[bool] = is_inside;
    let mut sets = DisjointSets::of_lower(Threads::All, count + 1, |number| {
        let t = number as usize;
        let across = (0..N).filter(move |_| t < count).filter_map(move |k| complex.across(t, k));
        across.filter(move |&across| across < t && sides[across] == sides[t]).map(|across| across as u32)
    });
    for t in (0..count).filter(|&t| !is_inside[t]) {
        if (0..N).any(|k| complex.across(t, k).is_none()) {
            sets.unite(t as u32, count as u32);
        }
    }
    let unbounded = sets.find(count as u32);
    let mut volumes = vec![0.0; count + 1];
    for (t, volume) in (0..).zip(measures(complex, |_| true)) {
        volumes[sets.find(t) as usize] += volume;
    }
    let roots = || volumes.iter().enumerate().filter(|&(t, &volume)| volume > 0.0 && t != unbounded as usize);
    let largest = roots().filter(|&(t, _)| is_inside[t]).map(|(_, &volume)| volume).fold(0.0, f64::max);
    let is_small = |t: usize| t != unbounded as usize && volumes[t] > 0.0 && volumes[t] < share * largest;
    let mut dropped = [0; 2];
    for (t, _) in roots().filter(|&(t, _)| is_small(t)) {
        dropped[usize::from(!is_inside[t])] += 1;
    }
    if dropped != [0; 2] {
        for (t, is_inside) in is_inside.iter_mut().enumerate() {
            *is_inside ^= is_small(sets.find(t as u32) as usize);
        }
    }
    dropped
}

/// Returns the measures of some simplices, in their order.
fn measures<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    is_meant: impl Fn(usize) -> bool + Sync,
) -> Vec<f64>
where
    Euclidean: Geometry<D, N>,
{
    parallel::joined(parallel::map_ranges(Threads::All, complex.simplices.len(), |range| {
        range.filter(|&t| is_meant(t)).map(|t| measure(&complex.corners(t))).collect()
    }))
}

/// Returns the sum of the measures of the simplices that are inside, whatever their order.
pub(super) fn volume<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, is_inside: &[bool]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let mut measures = measures(complex, |t| is_inside[t]);
    // Sums of numbers that are rounded depend on their order.
    parallel::sort_by(Threads::All, &mut measures, f64::total_cmp);
    measures.into_iter().fold(0.0, |sum, measure| sum + measure)
}
