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
    let mut sets = DisjointSets::new(count + 1);
    for t in 0..count {
        for k in 0..N {
            match complex.across(t, k) {
                Some(across) if across > t || is_inside[across] != is_inside[t] => {}
                Some(across) => _ = sets.unite(t as u32, across as u32),
                None if !is_inside[t] => _ = sets.unite(t as u32, count as u32),
                None => {}
            }
        }
    }
    let unbounded = sets.find(count as u32);
    let mut volumes = vec![0.0; count + 1];
    for t in 0..count {
        volumes[sets.find(t as u32) as usize] += measure(&complex.corners(t));
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

/// Returns the sum of the measures of simplices, whatever their order.
pub(super) fn volume<const D: usize, const N: usize>(
    complex: &Complex<'_, D, N>,
    simplices: impl Iterator<Item = usize>,
) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let mut measures: Vec<f64> = simplices.map(|t| measure(&complex.corners(t))).collect();
    // Sums of numbers that are rounded depend on their order.
    parallel::sort_by(Threads::All, &mut measures, f64::total_cmp);
    measures.into_iter().fold(0.0, |sum, measure| sum + measure)
}
