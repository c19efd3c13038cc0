//! The proof that a hull encloses its inside once, for meshes whose points have moved.
//!
//! Nothing less suffices: around an edge, tetrahedra may go round twice without any being inverted.
//!
//! 1. Every facet is seen from inside the spanning tetrahedron, which is positively oriented.
//! 2. A ray from there hits one facet. By 1, every ray then does, so the hull is the boundary of a
//!    star-shaped body.
//! 3. Its edges are convex, which the caller has proved. So the body is convex.
//! 4. Tetrahedra that are positively oriented, and whose facets are shared or on the hull, then
//!    cover it once.

use crate::{
    d3::splay::predicates::StarPredicates,
    input::{lattice::Lattice, points::Points3},
    parallel::{self, Threads},
    predicates::{
        filter::{PredicateContext, PredicateContext3},
        orient2d,
    },
};

/// The number of facets of the hull that a thread takes at a time.
const FACET_GRAIN: usize = 1 << 10;

/// Returns whether a hull, whose edges are convex, is the boundary of a convex body that it encloses
/// once. `spanning` are the vertices of a tetrahedron inside the hull, positively oriented on the
/// lattice.
pub(super) fn encloses_once(points: Points3<'_>, lattice: &Lattice<3>, hull: &[[u32; 3]], spanning: [u32; 4]) -> bool {
    let infinite = points.len() as u32;
    let hits = parallel::map_grains(Threads::All, hull.len(), FACET_GRAIN, |range| {
        let vertices = PredicateContext::of_input(points, lattice);
        let predicates = StarPredicates::new(&vertices, infinite, spanning);
        let mut hits = 0;
        for &[a, b, c] in &hull[range] {
            if predicates.orient([a, b, c, infinite]) <= 0 {
                return None;
            }
            hits += usize::from(is_hit(&vertices, [a, b, c], spanning));
        }
        Some(hits)
    });
    let [a, b, c, d] = spanning;
    let vertices = PredicateContext::of_input(points, lattice);
    vertices.orient3d(a, b, c, d) > 0 && hits.into_iter().sum::<Option<usize>>() == Some(1)
}

/// Returns whether the ray along the *x* axis from a point inside the spanning tetrahedron hits a
/// facet of the hull, counter-clockwise as seen from outside, that the point is inside of.
///
/// The point is the first vertex of the tetrahedron, displaced towards the second one, far less
/// towards the third, and still less towards the fourth, so that it is in no plane with an edge and
/// the axis.
fn is_hit(vertices: &PredicateContext3<'_>, facet: [u32; 3], spanning: [u32; 4]) -> bool {
    let flat = |v: u32| {
        let [_, y, z] = vertices.point(v);
        [y, z]
    };
    let [a, b, c] = facet.map(flat);
    let is_left =
        |p, q| spanning.iter().map(|&v| orient2d(p, q, flat(v))).find(|&sign| sign != 0).is_some_and(|sign| sign > 0);
    orient2d(a, b, c) > 0 && is_left(a, b) && is_left(b, c) && is_left(c, a)
}
