//! The nearest neighbours of points, by a k-d tree (Bentley 1975).
//!
//! [`Locator`](crate::Locator) finds them on a mesh. Points that were moved have none.

use crate::{
    geometry::vector,
    parallel::{self, Threads},
};
use std::collections::BinaryHeap;

/// Ranges of so few points are searched one by one.
const LEAF: usize = 12;

/// The number of parts of a tree that threads share.
const PARTS: usize = 64;

/// A k-d tree over points.
#[derive(Debug)]
pub(super) struct Tree<'a, const D: usize> {
    pub(super) points: &'a [[f64; D]],
    /// The points. The one in the middle of a range is between those before and after along its axis.
    order: Vec<u32>,
    /// The axis along which each point splits its range.
    axes: Vec<u8>,
}

impl<'a, const D: usize> Tree<'a, D> {
    pub(super) fn new(points: &'a [[f64; D]]) -> Self {
        let mut tree = Tree { points, order: (0..points.len() as u32).collect(), axes: vec![0; points.len()] };
        let mut parts = vec![Part { order: &mut tree.order, axes: &mut tree.axes }];
        while parts.len() < PARTS && parts.iter().any(|part| part.order.len() > LEAF) {
            parallel::map_mut(Threads::All, &mut parts, |_, part| part.split(points));
            parts = parts.into_iter().flat_map(Part::halves).collect();
        }
        parallel::map_mut(Threads::All, &mut parts, |_, part| part.split_all(points));
        tree
    }

    /// Finds the `count` points nearest to a query, in order of their distances, those at the same
    /// distance in order of their indices, with the squared distances.
    pub(super) fn nearest(&self, query: [f64; D], count: usize, found: &mut Vec<(f64, u32)>) {
        // Squares are in the order of their bits.
        let mut nearest = BinaryHeap::with_capacity(count + 1);
        self.search((0, self.order.len()), query, count, &mut nearest);
        found.clear();
        found.extend(nearest.into_sorted_vec().into_iter().map(|(bits, i)| (f64::from_bits(bits), i)));
    }

    fn search(
        &self,
        (start, end): (usize, usize),
        query: [f64; D],
        count: usize,
        nearest: &mut BinaryHeap<(u64, u32)>,
    ) {
        let consider = |i: u32, nearest: &mut BinaryHeap<(u64, u32)>| {
            let squared = vector::squared_norm(vector::minus(self.points[i as usize], query));
            let found = (squared.to_bits(), i);
            if nearest.len() < count {
                nearest.push(found);
            } else if let Some(mut farthest) = nearest.peek_mut()
                && found < *farthest
            {
                *farthest = found;
            }
        };
        if end - start <= LEAF {
            self.order[start..end].iter().for_each(|&i| consider(i, nearest));
            return;
        }
        let middle = start + (end - start) / 2;
        let i = self.order[middle];
        let axis = usize::from(self.axes[middle]);
        let beyond = query[axis] - self.points[i as usize][axis];
        let halves = [(start, middle), (middle + 1, end)];
        let [near, far] = if beyond < 0.0 { halves } else { [halves[1], halves[0]] };
        consider(i, nearest);
        self.search(near, query, count, nearest);
        let worst = nearest.peek().map_or(0, |&(bits, _)| bits);
        if nearest.len() < count || (beyond * beyond).to_bits() <= worst {
            self.search(far, query, count, nearest);
        }
    }
}

/// A range of a tree.
struct Part<'a> {
    order: &'a mut [u32],
    axes: &'a mut [u8],
}

impl<'a> Part<'a> {
    /// Puts the point in the middle of the range, along the axis of its greatest extent, into its place; the points
    /// before are lower there, and those after higher.
    fn split<const D: usize>(&mut self, points: &[[f64; D]]) {
        if self.order.len() <= LEAF {
            return;
        }
        let extent = |axis: usize| {
            let bounds = self.order.iter().map(|&i| points[i as usize][axis]);
            let [low, high] = bounds.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)]);
            high - low
        };
        let axis = (1..D).fold(0, |widest, axis| if extent(axis) > extent(widest) { axis } else { widest });
        let middle = self.order.len() / 2;
        self.order
            .select_nth_unstable_by(middle, |&i, &j| points[i as usize][axis].total_cmp(&points[j as usize][axis]));
        self.axes[middle] = axis as u8;
    }

    /// Returns the ranges before and after the point in the middle; one that is small as it is.
    fn halves(self) -> impl Iterator<Item = Part<'a>> {
        let Part { order, axes } = self;
        let middle = if order.len() > LEAF { order.len() / 2 } else { order.len() };
        let ((order, order_after), (axes, axes_after)) = (order.split_at_mut(middle), axes.split_at_mut(middle));
        let after = match (order_after, axes_after) {
            ([_, order @ ..], [_, axes @ ..]) => Some(Part { order, axes }),
            _ => None,
        };
        std::iter::once(Part { order, axes }).chain(after)
    }

    /// Splits the range until its parts are small.
    fn split_all<const D: usize>(&mut self, points: &[[f64; D]]) {
        let mut parts = vec![Part { order: self.order, axes: self.axes }];
        while let Some(mut part) = parts.pop() {
            if part.order.len() > LEAF {
                part.split(points);
                parts.extend(part.halves());
            }
        }
    }
}

/// Returns the median of numbers; `None` if there are none. Changes their order.
pub(super) fn median(numbers: &mut [f64]) -> Option<f64> {
    let middle = numbers.len() / 2;
    (!numbers.is_empty()).then(|| *numbers.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_are_those_of_brute_force() {
        // A grid has many equal distances.
        let points: Vec<[f64; 3]> = (0..600u32).map(|i| [7 * i % 11, i % 5, i * i % 13].map(f64::from)).collect();
        let tree = Tree::new(&points);
        let mut found = Vec::new();
        for query in [[0.0; 3], [3.0, 2.5, 7.0], [20.0, -3.0, 6.5], points[77]] {
            let squared = |p: &[f64; 3]| -> f64 { (0..3).map(|a| (p[a] - query[a]) * (p[a] - query[a])).sum() };
            let mut all: Vec<(u64, u32)> = points.iter().map(|p| squared(p).to_bits()).zip(0..).collect();
            all.sort_unstable();
            for count in [1, 6, 40] {
                tree.nearest(query, count, &mut found);
                assert!(found.iter().map(|&(d, i)| (d.to_bits(), i)).eq(all[..count].iter().copied()));
            }
        }
    }
}
