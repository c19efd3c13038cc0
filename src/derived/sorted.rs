//! A mesh in an order in which what is near in space is near in memory.

use super::{
    complex::{Complex, Coordinates},
    groups::Groups,
    queries::{CurveKey, places},
};
use crate::{
    geometry::{Euclidean, Geometry},
    index::NONE,
    parallel::{self, Threads},
};
use std::borrow::Cow;

/// A copy of a mesh and its points that is numbered along the Hilbert curve: the points by their
/// places, the simplices by the first of their vertices.
///
/// A mesh comes in whatever order its backend has made it in, and its points in that of the input,
/// so that a step to a neighbour reads memory that no other step has brought near. To look at all
/// simplices and what is around them a few times takes longer than to sort them first.
#[derive(Debug)]
pub struct Sorted<const D: usize, const N: usize> {
    pub(super) complex: Complex<'static, D, N>,
    /// The number of each point in the mesh that was sorted.
    pub(super) points: Vec<u32>,
    /// The number of each simplex in the mesh that was sorted.
    pub(super) simplices: Vec<u32>,
    /// The place of each simplex of that mesh in this one.
    pub(super) places: Vec<u32>,
}

impl<const D: usize, const N: usize> Sorted<D, N>
where
    Euclidean: Geometry<D, N>,
{
    pub(super) fn new(complex: &Complex<'_, D, N>) -> Self {
        let keys = places(complex.points(), CurveKey::new(complex.bounds()));
        let mut points = parallel::order_of(Threads::All, keys.clone());
        // Points in the same cell by their coordinates, so that the input's order does not matter.
        for cell in points.chunk_by_mut(|&i, &j| keys[i as usize] == keys[j as usize]).filter(|cell| cell.len() > 1) {
            let order =
                |&i: &u32, &j: &u32| complex.point(i).partial_cmp(&complex.point(j)).map(|order| order.then(i.cmp(&j)));
            cell.sort_unstable_by(|i, j| order(i, j).unwrap_or_else(|| i.cmp(j)));
        }
        drop(keys);
        let ranks = inverse(&points);
        let firsts = map(complex.simplices.len(), 0, |t| {
            let ranks = complex.simplices[t].map(|v| ranks[v as usize]);
            ranks.into_iter().fold(u32::MAX, u32::min)
        });
        let simplices = Groups::new(points.len(), firsts.iter().copied().zip(0..)).items;
        drop(firsts);
        let places = inverse(&simplices);
        let rank_or_none = |i: u32, ranks: &[u32]| if i == NONE { NONE } else { ranks[i as usize] };
        let row = [0; N];
        let sorted = Complex {
            points: Coordinates::Owned(map(points.len(), [0.0; D], |rank| complex.point(points[rank]))),
            simplices: Cow::Owned(map(simplices.len(), row, |place| {
                complex.simplices[simplices[place] as usize].map(|v| ranks[v as usize])
            })),
            neighbors: Cow::Owned(map(simplices.len(), row, |place| {
                complex.neighbors[simplices[place] as usize].map(|t| rank_or_none(t, &places))
            })),
            duplicate_of: Cow::Owned(map(points.len(), 0, |rank| {
                rank_or_none(complex.duplicate_of[points[rank] as usize], &ranks)
            })),
            weights: Cow::Borrowed(&[]),
            visible: None,
        };
        Sorted { complex: sorted, points, simplices, places }
    }

    /// Arranges the vertices of each simplex by an even permutation so that all but the last two, and
    /// these too if the orientation allows it, ascend. The arrays of a simplex then depend on its
    /// vertices alone.
    pub(super) fn arrange_rows(&mut self) {
        let rows = (self.complex.simplices.to_mut(), self.complex.neighbors.to_mut());
        parallel::for_chunk_pairs(Threads::All, (&mut rows.0[..], &mut rows.1[..]), |_, (simplices, neighbors)| {
            for (simplex, across) in simplices.iter_mut().zip(neighbors) {
                let order = even_order(simplex);
                *simplex = order.map(|k| simplex[k]);
                *across = order.map(|k| across[k]);
            }
        });
    }

    /// Returns the vertices of a face as they were numbered in the mesh that was sorted.
    pub(super) fn given<const K: usize>(&self, face: [u32; K]) -> [u32; K] {
        face.map(|v| self.points[v as usize])
    }
}

/// Returns the results of `work` for the numbers below `len`; `empty` may be any. Threads share the work.
fn map<R: Copy + Send + Sync>(len: usize, empty: R, work: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let mut results = parallel::filled(Threads::All, len, empty);
    parallel::for_chunks(Threads::All, &mut results, |start, chunk| {
        for (result, i) in chunk.iter_mut().zip(start..) {
            *result = work(i);
        }
    });
    results
}

/// Returns an even permutation that sorts the row, except that its last two entries may descend.
pub(super) fn even_order<const N: usize>(row: &[u32; N]) -> [usize; N] {
    let mut order: [usize; N] = std::array::from_fn(|k| k);
    let mut is_odd = false;
    for end in 1..N {
        let mut k = end;
        while k > 0 && row[order[k - 1]] > row[order[k]] {
            order.swap(k - 1, k);
            is_odd = !is_odd;
            k -= 1;
        }
    }
    if is_odd {
        order.swap(N - 2, N - 1);
    }
    order
}

/// Returns where each number is in a list of all numbers below its length.
pub(super) fn inverse(order: &[u32]) -> Vec<u32> {
    let mut places = vec![0; order.len()];
    for (place, &i) in (0..).zip(order) {
        places[i as usize] = place;
    }
    places
}
