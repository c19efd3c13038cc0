//! Tetrahedra.

use super::{Euclidean, Geometry, real::Double, vector};
use crate::{
    input::{hilbert, order::Curve},
    predicates::{
        Sign, exact, polynomial,
        polynomial::{Polynomial, Ring},
    },
};

impl Geometry<3, 4> for Euclidean {
    const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

    const FACET_NUMBERS: [usize; 4] = [0, 1, 2, 3];

    const CURVE: Curve<3> = hilbert::index3d;

    #[inline(always)]
    fn determinant([u, v, w]: &[[f64; 3]; 3]) -> f64 {
        u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])
    }

    /// The facets share two cross products.
    #[inline(always)]
    fn facet_determinants(&[a, b, c, d]: &[[f64; 3]; 4]) -> [f64; 4] {
        let (ab, cd) = (vector::cross(a, b), vector::cross(c, d));
        [vector::dot(b, cd), -vector::dot(a, cd), vector::dot(d, ab), -vector::dot(c, ab)]
    }

    #[inline]
    fn side(&[a, b, c]: &[[f64; 3]; 3], p: [f64; 3]) -> Sign {
        -exact::orient3d(a, b, c, p)
    }

    #[inline]
    fn in_sphere(&[a, b, c, d]: &[[f64; 3]; 4], p: [f64; 3]) -> Sign {
        exact::insphere(a, b, c, d, p)
    }

    fn is_below(&[a, b, c, d]: &[[f64; 3]; 4], weights: &[f64; 4], (p, of_p): ([f64; 3], f64)) -> Sign {
        let [of_a, of_b, of_c, of_d] = *weights;
        exact::power_sign([a, b, c, d, p], [of_a, of_b, of_c, of_d, of_p])
    }

    fn determinant_in<T: Ring>([u, v, w]: &[[T; 3]; 3]) -> T {
        polynomial::dot(u, &polynomial::cross(v, w))
    }

    fn center_fraction<T: Ring>([b, c, d]: &[[T; 3]; 3], squares: &[T; 3]) -> ([T; 3], T) {
        let normals = [(c, d), (d, b), (b, c)].map(|(u, v)| polynomial::cross(u, v));
        let numerator = std::array::from_fn(|axis| {
            let [x, y, z] = [0, 1, 2].map(|i| squares[i].clone() * normals[i][axis].clone());
            x + y + z
        });
        (numerator, T::from(2) * polynomial::dot(b, &normals[0]))
    }

    /// With ε = 2⁻⁵³, the lengths b, c, d of the edges, P = b·c·d and the radius R, the determinant
    /// has an error below 20·ε·P: the permanent is at most √3·P, and no term has more than ten
    /// roundings. The three numerators have errors below 12·ε·P·(b + c + d) ≤ 72·ε·P·R each. So the
    /// centre has one below 90·ε·P·R/|det|, which is less than 2⁻³⁷·R where P < 2⁹·|det|.
    #[inline]
    fn circumcenter_estimate(edges: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
        let &[b, c, d] = edges;
        let (cd, db, bc) = (vector::cross(c, d), vector::cross(d, b), vector::cross(b, c));
        let [bb, cc, dd] = [b, c, d].map(vector::squared_norm);
        let det = vector::dot(b, cd);
        let is_safe = [bb, cc, dd].iter().all(|x| (SMALL..LARGE).contains(x));
        if !is_safe || det * det * 262144.0 <= bb * cc * dd {
            return None;
        }
        let half = 0.5 / det;
        Some(std::array::from_fn(|axis| (bb * cd[axis] + cc * db[axis] + dd * bc[axis]) * half))
    }

    #[inline]
    fn facet_squared_radius(facet: &[[f64; 3]; 3]) -> f64 {
        vector::squared_norm(triangle_circumcenter_offset(facet))
    }

    fn squared_radius_fraction<T: Ring>(points: &[[T; 3]]) -> (T, T) {
        match points {
            [a, b] => super::edge_squared_radius(a, b),
            [a, b, c] => {
                let (u, v) = (polynomial::minus(b, a), polynomial::minus(c, a));
                let w = polynomial::minus(&u, &v);
                let normal = polynomial::cross(&u, &v);
                let [uu, vv, ww, nn] = [&u, &v, &w, &normal].map(|u| polynomial::dot(u, u));
                (uu * vv * ww, T::from(4) * nn)
            }
            [a, b, c, d] => {
                let (numerator, denominator) = Self::circumcenter_fraction(&[b, c, d].map(|p| polynomial::minus(p, a)));
                (polynomial::dot(&numerator, &numerator), denominator.clone() * denominator)
            }
            _ => (T::from(0), T::from(1)),
        }
    }

    fn in_smallest_sphere(&[a, b, c]: &[[f64; 3]; 3], p: [f64; 3]) -> bool {
        polynomial::sign(&InSmallestSphere, &[a, b, c, p]) < 0
    }

    #[inline]
    fn facet_normal(&[a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
        vector::cross(vector::minus(b, a), vector::minus(c, a))
    }

    fn boundary_measure(simplex: &[[f64; 3]; 4]) -> f64 {
        let area = |facet: [usize; 3]| {
            let [a, b, c] = facet.map(|corner| simplex[corner]);
            0.5 * vector::norm(vector::cross(vector::minus(b, a), vector::minus(c, a)))
        };
        Self::FACETS.into_iter().map(area).sum()
    }
}

/// Returns the centre of the circle through three points in 3D relative to the first one, with an
/// error of at most 2⁻³⁷ times the radius.
fn triangle_circumcenter_offset(&[a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (vector::minus(b, a), vector::minus(c, a));
    let normal = vector::cross(u, v);
    let [uu, vv, nn] = [u, v, normal].map(vector::squared_norm);
    let is_safe = [uu, vv].iter().all(|x| (SMALL..LARGE).contains(x));
    // The error is below 60·2⁻⁵³·|u|²·|v|²/|n|² times the radius, by the same count as for
    // tetrahedra.
    if is_safe && nn * 512.0 > uu * vv {
        let (to_v, to_u) = (vector::cross(normal, u), vector::cross(v, normal));
        let half = 0.5 / nn;
        return std::array::from_fn(|axis| (vv * to_v[axis] + uu * to_u[axis]) * half);
    }
    super::rounded(super::exact_offset(&[a, b, c], triangle_circumcenter_fraction))
}

/// Returns the same in twice the precision.
pub(crate) fn precise_triangle_circumcenter_offset(triangle: &[[f64; 3]; 3]) -> Option<[Double; 3]> {
    let (numerator, denominator, exponent) = super::exact_offset(triangle, triangle_circumcenter_fraction)?;
    Some(numerator.map(|x| Double::quotient(&x, &denominator, exponent)))
}

/// Returns the centre of the circle through the origin and two points, times the second result.
fn triangle_circumcenter_fraction<T: Ring>([u, v]: &[[T; 3]; 2]) -> ([T; 3], T) {
    let normal = polynomial::cross(u, v);
    let (uu, vv) = (polynomial::dot(u, u), polynomial::dot(v, v));
    let (to_v, to_u) = (polynomial::cross(&normal, u), polynomial::cross(v, &normal));
    let numerator = std::array::from_fn(|axis| vv.clone() * to_v[axis].clone() + uu.clone() * to_u[axis].clone());
    (numerator, T::from(2) * polynomial::dot(&normal, &normal))
}

/// Returns the dihedral angles at the edges between vertices 0 and 1, 0 and 2, 0 and 3, 1 and 2, 1
/// and 3, 2 and 3.
pub(crate) fn dihedral_angles(simplex: &[[f64; 3]; 4]) -> [f64; 6] {
    // The edge, and the other two vertices.
    [[0, 1, 2, 3], [0, 2, 1, 3], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 0, 2], [2, 3, 0, 1]].map(|corners| {
        let [a, b, c, d] = corners.map(|corner| simplex[corner]);
        let axis = vector::minus(b, a);
        let [u, v] = [c, d].map(|p| vector::cross(axis, vector::minus(p, a)));
        // Accurate for small angles too, unlike the arc cosine.
        libm::atan2(vector::norm(vector::cross(u, v)), vector::dot(u, v))
    })
}

/// For the points a, b, c and p: positive if p is outside the smallest sphere through a, b and c.
struct InSmallestSphere;

impl Polynomial<4, 3> for InSmallestSphere {
    fn value<T: Ring>(&self, [a, b, c, p]: &[[T; 3]; 4]) -> T {
        let (center, denominator) = triangle_circumcenter_fraction(&[polynomial::minus(b, a), polynomial::minus(c, a)]);
        let w = polynomial::minus(p, a);
        denominator * polynomial::dot(&w, &w) - T::from(2) * polynomial::dot(&w, &center)
    }
}

/// Between these squared lengths, no product of six lengths comes near the limits of `f64`.
const SMALL: f64 = 1e-80;
const LARGE: f64 = 1e80;
