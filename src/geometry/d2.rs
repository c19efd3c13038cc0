//! Triangles.

use super::{Euclidean, Geometry, vector};
use crate::{
    input::{hilbert, order::Curve},
    predicates::{Sign, exact, polynomial, polynomial::Ring},
};

impl Geometry<2, 3> for Euclidean {
    const FACETS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

    // Edge k of a 2D mesh leads from vertex k to the next.
    const FACET_NUMBERS: [usize; 3] = [1, 2, 0];

    const CURVE: Curve<2> = hilbert::index2d;

    #[inline(always)]
    fn determinant([u, v]: &[[f64; 2]; 2]) -> f64 {
        u[0] * v[1] - u[1] * v[0]
    }

    #[inline(always)]
    fn facet_determinants(&[a, b, c]: &[[f64; 2]; 3]) -> [f64; 3] {
        [[b, c], [c, a], [a, b]].map(|facet| Self::determinant(&facet))
    }

    #[inline]
    fn side(&[a, b]: &[[f64; 2]; 2], p: [f64; 2]) -> Sign {
        exact::orient2d(a, b, p)
    }

    #[inline]
    fn in_sphere(&[a, b, c]: &[[f64; 2]; 3], p: [f64; 2]) -> Sign {
        exact::incircle(a, b, c, p)
    }

    fn is_below(&[a, b, c]: &[[f64; 2]; 3], &[of_a, of_b, of_c]: &[f64; 3], (p, of_p): ([f64; 2], f64)) -> Sign {
        exact::power_sign([a, b, c, p], [of_a, of_b, of_c, of_p])
    }

    fn determinant_in<T: Ring>([u, v]: &[[T; 2]; 2]) -> T {
        u[0].clone() * v[1].clone() - u[1].clone() * v[0].clone()
    }

    fn center_fraction<T: Ring>([b, c]: &[[T; 2]; 2], squares: &[T; 2]) -> ([T; 2], T) {
        let [bb, cc] = squares.clone();
        let [[bx, by], [cx, cy]] = [b.clone(), c.clone()];
        let x = cy.clone() * bb.clone() - by.clone() * cc.clone();
        let y = bx.clone() * cc - cx.clone() * bb;
        ([x, y], T::from(2) * (bx * cy - by * cx))
    }

    #[inline]
    fn circumcenter_estimate(edges: &[[f64; 2]; 2]) -> Option<[f64; 2]> {
        let &[b, c] = edges;
        let (bb, cc) = (vector::squared_norm(b), vector::squared_norm(c));
        let det = b[0] * c[1] - b[1] * c[0];
        // As in 3D, with smaller constants.
        let is_safe = (SMALL..LARGE).contains(&bb) && (SMALL..LARGE).contains(&cc);
        if !is_safe || det * det * 262144.0 <= bb * cc {
            return None;
        }
        Some([(c[1] * bb - b[1] * cc) / (2.0 * det), (b[0] * cc - c[0] * bb) / (2.0 * det)])
    }

    #[inline]
    fn facet_squared_radius(&[a, b]: &[[f64; 2]; 2]) -> f64 {
        0.25 * vector::squared_norm(vector::minus(a, b))
    }

    fn squared_radius_fraction<T: Ring>(points: &[[T; 2]]) -> (T, T) {
        match points {
            [a, b] => super::edge_squared_radius(a, b),
            [a, b, c] => {
                let edges = [polynomial::minus(b, a), polynomial::minus(c, a)];
                let (numerator, denominator) = Self::circumcenter_fraction(&edges);
                (polynomial::dot(&numerator, &numerator), denominator.clone() * denominator)
            }
            _ => (T::from(0), T::from(1)),
        }
    }

    #[inline]
    fn in_smallest_sphere(&[a, b]: &[[f64; 2]; 2], p: [f64; 2]) -> bool {
        super::is_obtuse(p, a, b)
    }

    #[inline]
    fn facet_normal(&[a, b]: &[[f64; 2]; 2]) -> [f64; 2] {
        [b[1] - a[1], a[0] - b[0]]
    }

    fn boundary_measure(&[a, b, c]: &[[f64; 2]; 3]) -> f64 {
        [[a, b], [b, c], [c, a]].iter().map(|&[p, q]| vector::norm(vector::minus(p, q))).sum()
    }
}

/// Returns the angles at the vertices.
pub(crate) fn angles(simplex: &[[f64; 2]; 3]) -> [f64; 3] {
    [[0, 1, 2], [1, 2, 0], [2, 0, 1]].map(|corners| {
        let [a, b, c] = corners.map(|corner| simplex[corner]);
        let (u, v) = (vector::minus(b, a), vector::minus(c, a));
        // Accurate for small angles too, unlike the arc cosine.
        libm::atan2((u[0] * v[1] - u[1] * v[0]).abs(), vector::dot(u, v))
    })
}

/// Between these squared lengths, no product of four lengths comes near the limits of `f64`.
const SMALL: f64 = 1e-120;
const LARGE: f64 = 1e120;
