//! Where the points are, as seen from above.

use crate::{
    error::Error,
    index::NONE,
    input::{
        hilbert,
        lattice::Lattice,
        order::{Order, insertion_order},
        points::{Points2, Points3},
    },
    parallel::{self, Threads},
    predicates::orient2d,
};
use std::cmp::Ordering;

/// The distinct places of points, and which point counts at each.
pub(super) struct Places {
    /// The places along a curve: *x* and *y*.
    pub(super) places: Vec<[f64; 2]>,
    /// The height there.
    pub(super) heights: Vec<f64>,
    /// The point that counts at each place.
    pub(super) names: Vec<u32>,
    /// The point that counts at the place of each point.
    pub(super) counting: Vec<u32>,
    /// The number of points that have not the height of the point that counts at their place.
    pub(super) other_heights: usize,
}

impl Places {
    /// Finds the places. Of several points at one, the first end of a constraint counts that is lowest there, and without an
    /// end the lowest point.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotFinite`].
    pub(super) fn new(threads: Threads, points: Points3<'_>, segments: &[[u32; 2]]) -> Result<Self, Error> {
        points.validate_by(threads)?;
        let mut seen: Vec<[f64; 2]> = vec![[0.0; 2]; points.len()];
        parallel::for_chunks(threads, &mut seen, |start, chunk| {
            chunk.iter_mut().zip(start..).for_each(|(place, i)| {
                let [x, y, _] = points.get(i);
                *place = [x, y];
            });
        });
        let from_above = Points2::F64(&seen);
        let lattice = Lattice::fit_by(threads, from_above)?;
        let distinct = insertion_order(threads, from_above, &lattice, hilbert::index2d, Order::Brio);
        let mut names = distinct.order;
        let mut counting: Vec<u32> = (0..points.len() as u32).collect();
        let mut other_heights = 0;
        if names.len() < points.len() {
            let mut is_end = vec![false; points.len()];
            segments.as_flattened().iter().for_each(|&v| is_end[v as usize] = true);
            let duplicates = || (0..).zip(&distinct.duplicate_of).filter(|&(_, &first)| first != NONE);
            let height = |i: u32| points.get(i as usize)[2];
            for (i, &first) in duplicates() {
                let best = &mut counting[first as usize];
                let key = |i: u32| (!is_end[i as usize], height(i));
                if key(i) < key(*best) {
                    *best = i;
                }
            }
            for (i, &first) in duplicates() {
                counting[i as usize] = counting[first as usize];
            }
            names.iter_mut().for_each(|name| *name = counting[*name as usize]);
            other_heights = (0..).zip(&counting).filter(|&(i, &name)| height(i) != height(name)).count();
        }
        let places = names.iter().map(|&name| seen[name as usize]).collect();
        let heights = names.iter().map(|&name| points.get(name as usize)[2]).collect();
        Ok(Places { places, heights, names, counting, other_heights })
    }

    /// Returns the number of points that share a place with the one that counts there.
    pub(super) fn duplicates(&self) -> usize {
        self.counting.len() - self.names.len()
    }

    /// Returns the places with these coordinates, in any order, each with the index of one of the coordinates.
    pub(super) fn at(&self, some: &[[f64; 2]]) -> Vec<(usize, usize)> {
        let by_place = |a: [f64; 2], b: [f64; 2]| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
        let mut order: Vec<usize> = (0..some.len()).collect();
        order.sort_by(|&i, &j| by_place(some[i], some[j]));
        let mut found = Vec::new();
        for (i, &place) in self.places.iter().enumerate().filter(|_| !some.is_empty()) {
            let from = order.partition_point(|&k| by_place(some[k], place).is_lt());
            found.extend(order[from..].iter().take_while(|&&k| some[k] == place).map(|&k| (i, k)));
        }
        found
    }

    /// Returns the points at the corners of the convex hull.
    pub(super) fn corners(&self, threads: Threads) -> Vec<u32> {
        let parts = parallel::map_ranges(threads, self.places.len(), |range| self.corners_of(range.collect()));
        self.corners_of(parts.concat()).into_iter().map(|i| self.names[i]).collect()
    }

    /// Returns the corners of the convex hull of some places (Andrew 1979).
    fn corners_of(&self, mut some: Vec<usize>) -> Vec<usize> {
        let at = |i: usize| self.places[i];
        some.sort_unstable_by(|&i, &j| at(i).partial_cmp(&at(j)).unwrap_or(Ordering::Equal));
        let mut corners: Vec<usize> = Vec::new();
        let mut chain = |places: &mut dyn Iterator<Item = usize>| {
            let first = corners.len();
            for place in places {
                while let [.., a, b] = corners[first..]
                    && orient2d(at(a), at(b), at(place)) <= 0
                {
                    corners.pop();
                }
                corners.push(place);
            }
            // The other chain begins where this one ends.
            corners.pop();
        };
        if some.len() < 2 {
            return some;
        }
        chain(&mut some.iter().copied());
        chain(&mut some.iter().rev().copied());
        corners
    }
}
