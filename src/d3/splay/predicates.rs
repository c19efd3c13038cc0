//! The two predicates that stars need, on vertices of which one may be at infinity.
//!
//! Lifted to R⁴, the triangulation is a convex hull, and infinity the direction straight up: a facet with it is a facet of
//! the hull in R³. Four coplanar points of the hull leave that direction undecided; it leans, by less than anything
//! else, away from a point inside the hull, so that they are triangulated as their Delaunay triangulation is (and not as
//! the upside of the tetrahedron that their liftings form). In R³, infinity is that lean alone: the antipode of the
//! point. The point itself is the first of four that span a tetrahedron, the *kernel*, displaced towards the second, far
//! less towards the third, and still less towards the fourth.
//!
//! Then no sign vanishes that a convex star asks for, if its vertices surround it in R³ or include the kernel: a flat
//! tetrahedron cannot be a facet, as its hyperplane, being vertical, has the kernel on one side and infinity on the other.

use crate::{
    parallel::{self, Threads},
    predicates::{Sign, filter::PredicateContext},
};
use std::{cell::Cell, ops::Range};

/// A point set and infinity.
pub(super) struct StarPredicates<'a> {
    vertices: &'a PredicateContext<'a>,
    infinite: u32,
    kernel: [u32; 4],
    signs: Cell<u64>,
}

impl<'a> StarPredicates<'a> {
    /// `kernel` are four vertices that are not coplanar.
    pub(super) fn new(vertices: &'a PredicateContext<'a>, infinite: u32, kernel: [u32; 4]) -> Self {
        StarPredicates { vertices, infinite, kernel, signs: Cell::new(0) }
    }

    /// What `work` makes of the ranges of `grain` elements that 0 … `len` is cut into, in order; each with a space of its own
    /// if threads can share it.
    pub(super) fn shared<R: Send>(
        &self,
        threads: Threads,
        len: usize,
        grain: usize,
        work: impl Fn(&StarPredicates<'_>, Range<usize>) -> R + Sync,
    ) -> Vec<R> {
        let source = if threads == Threads::All && len > grain { self.vertices.source() } else { None };
        let Some((points, lattice)) = source else { return vec![work(self, 0..len)] };
        let (infinite, kernel) = (self.infinite, self.kernel);
        let results = parallel::map_grains(threads, len, grain, |range| {
            let vertices = PredicateContext::of_input(points, lattice);
            let space = StarPredicates::new(&vertices, infinite, kernel);
            let result = work(&space, range);
            (result, space.signs(), vertices.exact_counts())
        });
        let results = results.into_iter().map(|(result, signs, counts)| {
            self.signs.set(self.signs.get() + signs);
            self.vertices.add_counts(counts);
            result
        });
        results.collect()
    }

    pub(super) fn infinite(&self) -> u32 {
        self.infinite
    }

    pub(super) fn kernel(&self) -> [u32; 4] {
        self.kernel
    }

    /// How many signs were asked for: the measure of all work.
    pub(super) fn signs(&self) -> u64 {
        self.signs.get()
    }

    /// The orientation of four different vertices. Zero for coplanar ones, and for infinity with three that are collinear.
    pub(super) fn orient(&self, t: [u32; 4]) -> Sign {
        self.signs.set(self.signs.get() + 1);
        let orient = |[a, b, c, d]: [u32; 4]| self.vertices.orient3d(a, b, c, d);
        match t.iter().position(|&v| v == self.infinite) {
            None => orient(t),
            Some(k) => {
                let others = self.kernel.into_iter().filter(|w| !t.contains(w));
                -others.map(|w| orient(replaced(t, k, w))).find(|&sign| sign != 0).unwrap_or(0)
            }
        }
    }

    /// Positive when vertex `e` lies inside the circumsphere of the positively oriented `t`, that is, below its
    /// hyperplane in R⁴. It changes sign with the orientation.
    pub(super) fn conflict(&self, t: [u32; 4], e: u32) -> Sign {
        self.signs.set(self.signs.get() + 1);
        if e == self.infinite {
            return -self.infinite_above(t);
        }
        match t.iter().position(|&v| v == self.infinite) {
            None => self.vertices.insphere(t, e),
            // To exchange two of the five changes the sign.
            Some(k) => self.infinite_above(replaced(t, k, e)),
        }
    }

    /// Positive when infinity lies above the hyperplane of the positively oriented, finite `t`: always, but for the lean
    /// if it is flat.
    fn infinite_above(&self, t: [u32; 4]) -> Sign {
        let [a, b, c, d] = t;
        match self.vertices.orient3d(a, b, c, d) {
            0 => {
                let others = self.kernel.into_iter().filter(|w| !t.contains(w));
                others.map(|w| self.vertices.insphere(t, w)).find(|&sign| sign != 0).unwrap_or(0)
            }
            sign => sign,
        }
    }
}

/// The same four with entry `k` replaced.
pub(super) fn replaced(mut four: [u32; 4], k: usize, v: u32) -> [u32; 4] {
    four[k] = v;
    four
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::lattice::Lattice;

    /// A 3³ grid: nearly everything is a tie.
    fn on_grid(test: impl Fn(&StarPredicates<'_>)) {
        let points: Vec<[f64; 3]> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(f64::from)).collect();
        let lattice = Lattice::fit((&points).into());
        let vertices = PredicateContext::new((&points).into(), &lattice, (0..27).rev().collect());
        test(&StarPredicates::new(&vertices, 27, [0, 1, 3, 9]));
    }

    fn fives() -> impl Iterator<Item = [u32; 5]> {
        // Every fifth vertex number modulo 28 comes up in every place.
        (0..28u32.pow(3))
            .map(|i| {
                let (a, b, c) = (i % 28, i / 28 % 28, i / 28 / 28);
                [a, b, c, (a + 3 * b + 5 * c + 1) % 28, (7 * a + b + 2 * c + 11) % 28]
            })
            .filter(|five| (0..5).all(|i| (0..i).all(|j| five[i] != five[j])))
    }

    #[test]
    fn exchanging_two_vertices_changes_the_sign() {
        on_grid(|space| {
            for [a, b, c, d, e] in fives() {
                let sign = space.conflict([a, b, c, d], e);
                assert_eq!(space.conflict([a, b, c, e], d), -sign, "{:?}", [a, b, c, d, e]);
                assert_eq!(space.conflict([b, a, c, d], e), -sign, "{:?}", [a, b, c, d, e]);
                assert_eq!(space.conflict([b, c, a, d], e), sign, "{:?}", [a, b, c, d, e]);
                assert_eq!(space.orient([a, b, d, c]), -space.orient([a, b, c, d]));
            }
        });
    }

    #[test]
    fn only_coplanar_points_tie() {
        on_grid(|space| {
            for five @ [a, b, c, d, e] in fives() {
                let coplanar = (0..5).all(|k| space.orient(crate::predicates::symbolic::without(five, k)) == 0);
                // No four points of this grid are collinear.
                let tie = coplanar && !five.contains(&space.infinite());
                assert_eq!(space.conflict([a, b, c, d], e) == 0, tie, "{five:?}");
            }
        });
    }

    #[test]
    fn coplanar_points_of_the_hull_are_triangulated_by_their_circles() {
        // Four points of the face z = 0, seen from below, and one that is inside the circle of three but not on it.
        let points =
            [[0.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 5.0], [3.0, 3.0, 0.0], [9.0, 9.0, 0.0]];
        let lattice = Lattice::fit((&points).into());
        let vertices = PredicateContext::new((&points).into(), &lattice, (0..6).collect());
        let space = StarPredicates::new(&vertices, 6, [0, 2, 1, 3]);
        assert!(space.orient([0, 1, 2, 6]) > 0);
        assert!(space.conflict([0, 1, 2, 6], 4) > 0);
        assert!(space.conflict([0, 1, 2, 6], 5) < 0);
    }
}
