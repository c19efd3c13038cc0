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

use crate::predicates::{Sign, vertices::Vertices};
use std::cell::Cell;

/// A point set and infinity.
pub(super) struct Space<'a> {
    vertices: &'a Vertices<'a>,
    infinite: u32,
    kernel: [u32; 4],
    signs: Cell<u64>,
}

impl<'a> Space<'a> {
    /// `kernel` are four vertices that are not coplanar.
    pub(super) fn new(vertices: &'a Vertices<'a>, infinite: u32, kernel: [u32; 4]) -> Self {
        Space { vertices, infinite, kernel, signs: Cell::new(0) }
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
