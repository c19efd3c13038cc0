//! The two predicates that stars need, for vertices one of which may be at infinity.
//!
//! Lifted to R⁴, the triangulation is a convex hull, and infinity is the direction straight up: a
//! facet with it is a facet of the hull in R³. Four coplanar points of the hull leave that
//! direction undecided. So it leans, by less than anything else, away from an *interior point* of
//! the hull, such that the four points are triangulated as in their 2D Delaunay triangulation (and
//! not as the upper side of the tetrahedron that their liftings form). In R³, infinity is that lean
//! alone: the antipode of the interior point. The interior point is the first vertex of a *spanning
//! tetrahedron*, displaced towards the second vertex, far less towards the third, and still less
//! towards the fourth.
//!
//! Then no predicate that a convex star evaluates is zero, if the star's vertices surround it in R³
//! or include the spanning tetrahedron: a flat tetrahedron cannot be a facet, because its
//! hyperplane, being vertical, has the spanning tetrahedron on one side and infinity on the other.

use crate::{
    parallel::{self, Threads},
    predicates::{
        Sign,
        filter::{PredicateContext, PredicateContext3, Rows},
    },
};
use std::{cell::Cell, ops::Range};

/// A point set and infinity.
pub(in crate::d3) struct StarPredicates<'a> {
    context: &'a PredicateContext3<'a>,
    infinite: u32,
    /// The vertices of the spanning tetrahedron.
    spanning: [u32; 4],
    evaluations: Cell<u64>,
    /// Rows of vertices around the first one of the predicates, which stars evaluate at their own.
    rows: Rows,
}

impl<'a> StarPredicates<'a> {
    /// Creates the predicates. The four vertices `spanning` must not be coplanar.
    pub(in crate::d3) fn new(context: &'a PredicateContext3<'a>, infinite: u32, spanning: [u32; 4]) -> Self {
        StarPredicates { context, infinite, spanning, evaluations: Cell::new(0), rows: Rows::new() }
    }

    /// Splits 0 … `len` into ranges of `grain` elements and returns the results of `work` for each,
    /// in order. Threads each get predicates of their own; if the context cannot be shared, the
    /// calling thread does all work.
    pub(super) fn shared<R: Send>(
        &self,
        threads: Threads,
        len: usize,
        grain: usize,
        work: impl Fn(&StarPredicates<'_>, Range<usize>) -> R + Sync,
    ) -> Vec<R> {
        let source = if threads == Threads::All && len > grain { self.context.source() } else { None };
        let Some((points, lattice)) = source else { return vec![work(self, 0..len)] };
        let (infinite, spanning) = (self.infinite, self.spanning);
        let results = parallel::map_grains(threads, len, grain, |range| {
            let context = PredicateContext::of_input(points, lattice);
            let predicates = StarPredicates::new(&context, infinite, spanning);
            let result = work(&predicates, range);
            (result, predicates.evaluations(), context.exact_counts())
        });
        let results = results.into_iter().map(|(result, evaluations, counts)| {
            self.evaluations.set(self.evaluations.get() + evaluations);
            self.context.add_counts(counts);
            result
        });
        results.collect()
    }

    /// Returns the infinite vertex.
    pub(super) fn infinite(&self) -> u32 {
        self.infinite
    }

    /// Returns the vertices of the spanning tetrahedron.
    pub(super) fn spanning(&self) -> [u32; 4] {
        self.spanning
    }

    /// Returns the number of predicate evaluations so far: the measure of all work.
    pub(super) fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// Returns the orientation of four different vertices. Zero for four coplanar vertices, and for
    /// infinity with three collinear vertices.
    pub(in crate::d3) fn orient(&self, t: [u32; 4]) -> Sign {
        self.evaluations.set(self.evaluations.get() + 1);
        let orient = |t: [u32; 4]| self.context.orient3d_around(&self.rows, t);
        match t.iter().position(|&v| v == self.infinite) {
            None => orient(t),
            Some(k) => {
                let others = self.spanning.into_iter().filter(|w| !t.contains(w));
                -others.map(|w| orient(replaced(t, k, w))).find(|&sign| sign != 0).unwrap_or(0)
            }
        }
    }

    /// Returns a positive sign if vertex `e` lies inside the circumsphere of the positively
    /// oriented `t`, that is, below its hyperplane in R⁴. The sign changes with the orientation.
    pub(in crate::d3) fn conflict(&self, t: [u32; 4], e: u32) -> Sign {
        self.evaluations.set(self.evaluations.get() + 1);
        if e == self.infinite {
            // Two ghosts have a finite facet in common only where the triangulation is none.
            return if t.contains(&e) { -1 } else { -self.infinite_above(t) };
        }
        match t.iter().position(|&v| v == self.infinite) {
            None => self.context.insphere_around(&self.rows, t, e),
            // Exchanging two of the five vertices changes the sign.
            Some(k) => self.infinite_above(replaced(t, k, e)),
        }
    }

    /// Returns a positive sign if infinity lies above the hyperplane of the positively oriented,
    /// finite `t`. That is always so, except that the lean decides if `t` is flat.
    fn infinite_above(&self, t: [u32; 4]) -> Sign {
        match self.context.orient3d_around(&self.rows, t) {
            0 => {
                let others = self.spanning.into_iter().filter(|w| !t.contains(w));
                others.map(|w| self.context.insphere_around(&self.rows, t, w)).find(|&sign| sign != 0).unwrap_or(0)
            }
            sign => sign,
        }
    }
}

/// Returns the four vertices with entry `k` replaced by `v`.
pub(super) fn replaced(mut four: [u32; 4], k: usize, v: u32) -> [u32; 4] {
    four[k] = v;
    four
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::lattice::Lattice;

    /// Runs a test on a 3³ grid, on which nearly every in-sphere test is a tie.
    fn on_grid(test: impl Fn(&StarPredicates<'_>)) {
        let points: Vec<[f64; 3]> = (0..27).map(|i| [i % 3, i / 3 % 3, i / 9].map(f64::from)).collect();
        let lattice = Lattice::fit((&points).into());
        let vertices = PredicateContext::new((&points).into(), &lattice, (0..27).rev().collect());
        test(&StarPredicates::new(&vertices, 27, [0, 1, 3, 9]));
    }

    fn fives() -> impl Iterator<Item = [u32; 5]> {
        // Every fifth vertex number modulo 28 occurs in every place.
        (0..28u32.pow(3))
            .map(|i| {
                let (a, b, c) = (i % 28, i / 28 % 28, i / 28 / 28);
                [a, b, c, (a + 3 * b + 5 * c + 1) % 28, (7 * a + b + 2 * c + 11) % 28]
            })
            .filter(|five| (0..5).all(|i| (0..i).all(|j| five[i] != five[j])))
    }

    #[test]
    fn exchanging_two_vertices_changes_the_sign() {
        on_grid(|predicates| {
            for [a, b, c, d, e] in fives() {
                let sign = predicates.conflict([a, b, c, d], e);
                assert_eq!(predicates.conflict([a, b, c, e], d), -sign, "{:?}", [a, b, c, d, e]);
                assert_eq!(predicates.conflict([b, a, c, d], e), -sign, "{:?}", [a, b, c, d, e]);
                assert_eq!(predicates.conflict([b, c, a, d], e), sign, "{:?}", [a, b, c, d, e]);
                assert_eq!(predicates.orient([a, b, d, c]), -predicates.orient([a, b, c, d]));
            }
        });
    }

    /// A mesh whose points have moved far need not be a triangulation.
    #[test]
    fn two_ghosts_that_share_a_finite_facet_are_no_reason_to_panic() {
        on_grid(|predicates| assert_eq!(predicates.conflict([0, 1, 3, 27], 27), -1));
    }

    #[test]
    fn only_coplanar_points_tie() {
        on_grid(|predicates| {
            for five @ [a, b, c, d, e] in fives() {
                let coplanar = (0..5).all(|k| predicates.orient(crate::predicates::symbolic::without(five, k)) == 0);
                // No four points of this grid are collinear.
                let tie = coplanar && !five.contains(&predicates.infinite());
                assert_eq!(predicates.conflict([a, b, c, d], e) == 0, tie, "{five:?}");
            }
        });
    }

    #[test]
    fn coplanar_points_of_the_hull_are_triangulated_by_their_circles() {
        // Four points of the face z = 0, seen from below, and one that is inside the circle of
        // three but not on it.
        let points =
            [[0.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 5.0], [3.0, 3.0, 0.0], [9.0, 9.0, 0.0]];
        let lattice = Lattice::fit((&points).into());
        let vertices = PredicateContext::new((&points).into(), &lattice, (0..6).collect());
        let predicates = StarPredicates::new(&vertices, 6, [0, 2, 1, 3]);
        assert!(predicates.orient([0, 1, 2, 6]) > 0);
        assert!(predicates.conflict([0, 1, 2, 6], 4) > 0);
        assert!(predicates.conflict([0, 1, 2, 6], 5) < 0);
    }
}
