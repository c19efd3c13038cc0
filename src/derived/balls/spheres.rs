//! Signs of polynomials of balls: of the smallest spheres that are orthogonal to some of them.
//!
//! A sphere with the centre c and the square s of its radius is orthogonal to a ball with the centre p and the square w
//! if |c − p|² = s + w. Of those that are orthogonal to the balls of a face, the smallest one has its centre in the space
//! that the face spans: with the edges u from the first vertex to the others, the numbers l = |u|² − Δw and the matrix G
//! of the products u·v, its square is l·G⁻¹·l / 4 − w.

use crate::{
    geometry::{Euclidean, Geometry},
    predicates::{
        Sign,
        polynomial::{Ring, WeightedPolynomial, dot, minus, weighted_sign},
    },
};

/// For the vertices of a face, and a radius as the first coordinate of one more point: the square of the face's smallest
/// orthogonal sphere less the square of the radius. `N` is the number of vertices of a simplex.
struct Size<const N: usize>;

impl<const K: usize, const D: usize, const N: usize> WeightedPolynomial<K, D> for Size<N>
where
    Euclidean: Geometry<D, N>,
{
    fn value<T: Ring>(&self, points: &[[T; D]; K], weights: &[T; K]) -> T {
        let [first, .., radius] = &points[..] else { return T::from(0) };
        let own = weights[0].clone() + radius[0].clone() * radius[0].clone();
        let edge = |i: usize| minus(&points[i + 1], first);
        let number = |u: &[T; D], i: usize| dot(u, u) - (weights[i + 1].clone() - weights[0].clone());
        match K - 2 {
            0 => T::from(0) - own,
            // Of a simplex, without the square of a determinant.
            edges if edges == D => {
                let edges: [[T; D]; D] = std::array::from_fn(edge);
                let numbers = std::array::from_fn(|i| number(&edges[i], i));
                let (center, denominator) = Euclidean::center_fraction(&edges, &numbers);
                dot(&center, &center) - own * denominator.clone() * denominator
            }
            1 => {
                let u = edge(0);
                let l = number(&u, 0);
                l.clone() * l - T::from(4) * own * dot(&u, &u)
            }
            _ => {
                let (u, v) = (edge(0), edge(1));
                let numbers = [number(&u, 0), number(&v, 1)];
                let (form, determinant) = inverse_form(&u, &v, &numbers, &numbers);
                form - T::from(4) * own * determinant
            }
        }
    }
}

/// For the vertices of a face of a simplex, and one more point: the power of that ball and the face's smallest orthogonal
/// sphere. It is negative if the sphere and the ball intersect at more than a right angle, as if the sphere contained an
/// unweighted point.
struct Power;

impl<const K: usize, const D: usize> WeightedPolynomial<K, D> for Power {
    fn value<T: Ring>(&self, points: &[[T; D]; K], weights: &[T; K]) -> T {
        let number = |u: &[T; D], i: usize| dot(u, u) - (weights[i].clone() - weights[0].clone());
        let edge = |i: usize| minus(&points[i], &points[0]);
        let q = edge(K - 1);
        let of_q = number(&q, K - 1);
        match K - 1 {
            1 => of_q,
            2 => {
                let u = edge(1);
                of_q * dot(&u, &u) - number(&u, 1) * dot(&u, &q)
            }
            _ => {
                let (u, v) = (edge(1), edge(2));
                let numbers = [number(&u, 1), number(&v, 2)];
                let (form, determinant) = inverse_form(&u, &v, &numbers, &[dot(&u, &q), dot(&v, &q)]);
                of_q * determinant - form
            }
        }
    }
}

/// Returns l·G⁻¹·m times the determinant of G, the matrix of the products of two edges, and the determinant.
fn inverse_form<T: Ring, const D: usize>(u: &[T; D], v: &[T; D], [l, m]: &[T; 2], [g, h]: &[T; 2]) -> (T, T) {
    let [a, b, c] = [dot(u, u), dot(u, v), dot(v, v)];
    let first = c.clone() * g.clone() - b.clone() * h.clone();
    let second = a.clone() * h.clone() - b.clone() * g.clone();
    (l.clone() * first + m.clone() * second, a * c - b.clone() * b)
}

/// Returns the sign of the square of the smallest orthogonal sphere of a face less the square of `radius`.
pub(super) fn compare_size<const D: usize, const N: usize>(balls: &[([f64; D], f64)], radius: f64) -> Sign
where
    Euclidean: Geometry<D, N>,
{
    if radius == f64::INFINITY {
        return -1;
    }
    let mut last = [0.0; D];
    last[0] = radius;
    with_last(balls, (last, 0.0), &Size)
}

/// Returns whether the smallest orthogonal sphere of a face that is no simplex intersects another ball at more than a
/// right angle.
pub(super) fn is_attached<const D: usize>(face: &[([f64; D], f64)], other: ([f64; D], f64)) -> bool {
    with_last(face, other, &Power) < 0
}

/// Returns the sign of a polynomial of balls.
fn with_last<const D: usize>(
    balls: &[([f64; D], f64)],
    last: ([f64; D], f64),
    polynomial: &(
         impl WeightedPolynomial<2, D> + WeightedPolynomial<3, D> + WeightedPolynomial<4, D> + WeightedPolynomial<5, D>
     ),
) -> Sign {
    match *balls {
        [a] => sign(polynomial, [a, last]),
        [a, b] => sign(polynomial, [a, b, last]),
        [a, b, c] => sign(polynomial, [a, b, c, last]),
        [a, b, c, d] => sign(polynomial, [a, b, c, d, last]),
        _ => 0,
    }
}

fn sign<const K: usize, const D: usize>(
    polynomial: &impl WeightedPolynomial<K, D>,
    balls: [([f64; D], f64); K],
) -> Sign {
    weighted_sign(polynomial, &balls.map(|(p, _)| p), &balls.map(|(_, weight)| weight))
}
