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

/// How many balls the polynomials have, of which they look at fewer for most faces: so they are compiled once for all.
const BALLS: usize = 5;

/// For the vertices of a face, and a radius as the first coordinate of the last point: the square of the face's smallest
/// orthogonal sphere less the square of the radius. `N` is the number of vertices of a simplex.
struct Size<const N: usize> {
    /// The number of vertices of the face.
    vertices: usize,
}

impl<const D: usize, const N: usize> WeightedPolynomial<BALLS, D> for Size<N>
where
    Euclidean: Geometry<D, N>,
{
    fn value<T: Ring>(&self, points: &[[T; D]; BALLS], weights: &[T; BALLS]) -> T {
        let radius = &points[BALLS - 1][0];
        let own = weights[0].clone() + radius.clone() * radius.clone();
        let edge = |i: usize| minus(&points[i + 1], &points[0]);
        let number = |u: &[T; D], i: usize| dot(u, u) - (weights[i + 1].clone() - weights[0].clone());
        match self.vertices {
            1 => T::from(0) - own,
            // Of a simplex, without the square of a determinant.
            vertices if vertices == N => {
                let edges: [[T; D]; D] = std::array::from_fn(edge);
                let numbers = std::array::from_fn(|i| number(&edges[i], i));
                let (center, denominator) = Euclidean::center_fraction(&edges, &numbers);
                dot(&center, &center) - own * denominator.clone() * denominator
            }
            2 => {
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

/// For the vertices of a face that is no simplex, and one more point, the last one: the power of that ball and the face's
/// smallest orthogonal sphere. It is negative if the sphere and the ball intersect at more than a right angle, as if the
/// sphere contained an unweighted point.
struct Power {
    /// The number of vertices of the face.
    vertices: usize,
}

impl<const D: usize> WeightedPolynomial<BALLS, D> for Power {
    fn value<T: Ring>(&self, points: &[[T; D]; BALLS], weights: &[T; BALLS]) -> T {
        let number = |u: &[T; D], i: usize| dot(u, u) - (weights[i].clone() - weights[0].clone());
        let edge = |i: usize| minus(&points[i], &points[0]);
        let q = edge(BALLS - 1);
        let of_q = number(&q, BALLS - 1);
        match self.vertices {
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
pub(super) fn compare_size<const D: usize, const N: usize>(face: &[([f64; D], f64)], radius: f64) -> Sign
where
    Euclidean: Geometry<D, N>,
{
    if radius == f64::INFINITY {
        return -1;
    }
    let mut last = [0.0; D];
    last[0] = radius;
    sign(&Size { vertices: face.len() }, face, (last, 0.0))
}

/// Returns whether the smallest orthogonal sphere of a face that is no simplex intersects another ball at more than a
/// right angle.
pub(super) fn is_attached<const D: usize>(face: &[([f64; D], f64)], other: ([f64; D], f64)) -> bool {
    sign(&Power { vertices: face.len() }, face, other) < 0
}

fn sign<const D: usize>(
    polynomial: &impl WeightedPolynomial<BALLS, D>,
    face: &[([f64; D], f64)],
    last: ([f64; D], f64),
) -> Sign {
    let mut balls = [([0.0; D], 0.0); BALLS];
    balls[..face.len()].copy_from_slice(face);
    balls[BALLS - 1] = last;
    weighted_sign(polynomial, &balls.map(|(p, _)| p), &balls.map(|(_, weight)| weight))
}
