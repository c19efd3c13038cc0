//! What differs between the dimensions in Voronoi cells.

use super::{
    super::complex::Complex,
    polytope::{Polygon, Polyhedron, Polytope},
};
use crate::geometry::{Euclidean, Geometry, vector};

/// The measures of a facet.
#[derive(Debug, Clone, Copy)]
pub struct FacetMeasures<const D: usize> {
    /// The area; in 2D the length.
    pub(crate) area: f64,
    /// The volume of the pyramid with its apex at the origin, in 2D the area of the triangle; positive if the origin is inside.
    pub(crate) volume: f64,
    /// The integral of the coordinates over that pyramid.
    pub(crate) moment: [f64; D],
}

/// What differs between the dimensions in Voronoi cells.
#[doc(hidden)]
pub trait VoronoiShapes<const D: usize, const N: usize>: Geometry<D, N> {
    /// The shape of a cell while it is clipped.
    type Polytope: Polytope<D>;

    /// Puts the simplices around the edge from vertex *v* to vertex *a* of simplex `t` into `ring`: counter-clockwise as seen
    /// from *a* in 3D, from right to left as seen from *v* in 2D. Returns whether they close a ring, or in 2D whether there
    /// are two.
    fn ring(complex: &Complex<'_, D, N>, v: u32, a: u32, t: usize, ring: &mut Vec<u32>) -> bool;

    /// Puts the star of vertex *v* into `arranged`, in the order in which its simplices are visited: in 2D counter-clockwise,
    /// on the hull from the first one.
    fn arrange_star(complex: &Complex<'_, D, N>, v: u32, star: &[u32], arranged: &mut Vec<u32>);

    /// The number of Voronoi edges, or vertices in 2D, that a bounded facet has at least.
    const FACET_EDGES: usize;

    /// Returns the outer normal of the facet of a simplex, and its product with the points of the facet.
    fn plane(facet: &[[f64; D]; D]) -> ([f64; D], f64);

    /// Returns the measures of a facet.
    fn facet_measures(corners: &[[f64; D]]) -> FacetMeasures<D>;
}

impl VoronoiShapes<2, 3> for Euclidean {
    type Polytope = Polygon<2>;

    fn ring(complex: &Complex<'_, 2, 3>, v: u32, a: u32, t: usize, ring: &mut Vec<u32>) -> bool {
        ring.clear();
        let simplex = complex.simplices[t];
        let Some(k) = simplex.iter().position(|&w| w != v && w != a) else { return false };
        // The triangle is left of the edge if the edge leads from the corner after the opposite one to that before.
        let is_left = simplex[(k + 1) % 3] == v;
        match complex.across(t, k) {
            Some(other) if is_left => ring.extend([other as u32, t as u32]),
            Some(other) => ring.extend([t as u32, other as u32]),
            None => ring.push(t as u32),
        }
        ring.len() == 2
    }

    fn arrange_star(complex: &Complex<'_, 2, 3>, v: u32, star: &[u32], arranged: &mut Vec<u32>) {
        arranged.clear();
        // Of a counter-clockwise triangle (v, a, b), the next one is across (v, b), opposite a, and the one before opposite b.
        let across = |t: u32, corner: usize| {
            let place = complex.simplices[t as usize].iter().position(|&w| w == v)?;
            complex.across(t as usize, (place + corner) % 3).map(|t| t as u32)
        };
        let start = star[0];
        let mut first = start;
        // Only a broken mesh needs the limit.
        for _ in 0..star.len() {
            match across(first, 2) {
                Some(before) if before != start => first = before,
                _ => break,
            }
        }
        let mut at = Some(first);
        while let Some(t) = at.filter(|&t| arranged.len() < star.len() && arranged.first() != Some(&t)) {
            arranged.push(t);
            at = across(t, 1);
        }
    }

    const FACET_EDGES: usize = 1;

    fn plane(&[a, b]: &[[f64; 2]; 2]) -> ([f64; 2], f64) {
        // To the right of the edge.
        let normal = [b[1] - a[1], a[0] - b[0]];
        (normal, vector::dot(normal, a))
    }

    fn facet_measures(corners: &[[f64; 2]]) -> FacetMeasures<2> {
        let &[p, q] = corners else { return FacetMeasures { area: 0.0, volume: 0.0, moment: [0.0; 2] } };
        let volume = 0.5 * (p[0] * q[1] - p[1] * q[0]);
        let moment = vector::times(volume / 3.0, vector::plus(p, q));
        FacetMeasures { area: vector::norm(vector::minus(q, p)), volume, moment }
    }
}

/// For corners *i* and *j* of a tetrahedron, the corner *k* such that (i, j, k, l) is an even permutation.
pub(crate) const THIRD: [[usize; 4]; 4] = [[4, 2, 3, 1], [3, 4, 0, 2], [1, 3, 4, 0], [2, 0, 1, 4]];

impl VoronoiShapes<3, 4> for Euclidean {
    type Polytope = Polyhedron;

    fn ring(complex: &Complex<'_, 3, 4>, v: u32, a: u32, t: usize, ring: &mut Vec<u32>) -> bool {
        ring.clear();
        // Of a positive tetrahedron (v, a, b, c), the next one counter-clockwise is across (v, a, c).
        let next = |t: usize, from: u32, to: u32| {
            let simplex = &complex.simplices[t];
            let place = |v: u32| simplex.iter().position(|&w| w == v);
            complex.across(t, THIRD[place(from)?][place(to)?])
        };
        let mut at = t;
        for _ in 0..=complex.simplices.len() {
            ring.push(at as u32);
            match next(at, v, a) {
                Some(t_next) if t_next == t => return true,
                Some(t_next) => at = t_next,
                None => break,
            }
        }
        // Clockwise from the first one, as counter-clockwise in the other direction.
        let forward = ring.len();
        let mut at = t;
        for _ in 0..=complex.simplices.len() {
            let Some(before) = next(at, a, v) else { break };
            ring.push(before as u32);
            at = before;
        }
        ring[forward..].reverse();
        ring.rotate_left(forward);
        false
    }

    fn arrange_star(_: &Complex<'_, 3, 4>, _: u32, star: &[u32], arranged: &mut Vec<u32>) {
        arranged.clear();
        arranged.extend(star);
    }

    const FACET_EDGES: usize = 3;

    fn plane(&[a, b, c]: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
        let normal = vector::cross(vector::minus(b, a), vector::minus(c, a));
        (normal, vector::dot(normal, a))
    }

    fn facet_measures(corners: &[[f64; 3]]) -> FacetMeasures<3> {
        let mut normal = [0.0; 3];
        let (mut volume, mut moment) = (0.0, [0.0; 3]);
        if let &[first, ref others @ ..] = corners {
            for pair in others.windows(2) {
                let (u, v) = (vector::minus(pair[0], first), vector::minus(pair[1], first));
                let twice = vector::cross(u, v);
                let share = vector::dot(first, twice) / 6.0;
                normal = vector::plus(normal, twice);
                volume += share;
                let corners = vector::plus(first, vector::plus(pair[0], pair[1]));
                moment = vector::plus(moment, vector::times(share / 4.0, corners));
            }
        }
        FacetMeasures { area: 0.5 * vector::norm(normal), volume, moment }
    }
}
