//! The solid: simplices that are inside, without specks and bubbles.

use super::super::{complex::Complex, sets::DisjointSets};
use crate::{
    geometry::{Euclidean, Geometry, measure},
    parallel::{self, Threads},
};
use rustc_hash::FxHashMap;

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
    let on_hull = parallel::map_ranges(Threads::All, count, |range| {
        let outside = range.filter(|&t| !sides[t] && (0..N).any(|k| complex.across(t, k).is_none()));
        outside.map(|t| t as u32).collect::<Vec<u32>>()
    });
    for t in on_hull.into_iter().flatten() {
        sets.unite(t, count as u32);
    }
    let unbounded = sets.root(count as u32);
    // Neighbours in memory mostly are neighbours in space: few parts of their sets have to be added up.
    let parts = parallel::map_ranges(Threads::All, count, |range| {
        let mut parts: Vec<(u32, f64)> = Vec::new();
        for t in range {
            let (root, volume) = (sets.root(t as u32), measure(&complex.corners(t)));
            match parts.last_mut().filter(|&&mut (last, _)| last == root) {
                Some((_, sum)) => *sum += volume,
                None => parts.push((root, volume)),
            }
        }
        parts
    });
    let mut volumes: FxHashMap<u32, f64> = FxHashMap::default();
    for (root, volume) in parts.into_iter().flatten().filter(|&(root, _)| root != unbounded) {
        *volumes.entry(root).or_default() += volume;
    }
    let largest = volumes.iter().filter(|&(&t, _)| sides[t as usize]).map(|(_, &volume)| volume).fold(0.0, f64::max);
    volumes.retain(|_, &mut volume| volume > 0.0 && volume < share * largest);
    let cavities = volumes.keys().filter(|&&t| !sides[t as usize]).count();
    if !volumes.is_empty() {
        parallel::for_chunks(Threads::All, is_inside, |start, chunk| {
            for (is_inside, t) in chunk.iter_mut().zip(start as u32..) {
                *is_inside ^= volumes.contains_key(&sets.root(t));
            }
        });
    }
    [volumes.len() - cavities, cavities]
}

/// Returns the sum of the measures of the simplices that are inside, whatever their order.
pub(super) fn volume<const D: usize, const N: usize>(complex: &Complex<'_, D, N>, is_inside: &[bool]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let mut measures = parallel::joined(parallel::map_ranges(Threads::All, is_inside.len(), |range| {
        range.filter(|&t| is_inside[t]).map(|t| measure(&complex.corners(t))).collect::<Vec<f64>>()
    }));
    // Sums of numbers that are rounded depend on their order.
    parallel::sort_by(Threads::All, &mut measures, f64::total_cmp);
    measures.into_iter().fold(0.0, |sum, measure| sum + measure)
}
