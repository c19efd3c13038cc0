//! Points, facets and simplices of both dimensions as coordinates, without a mesh.
//!
//! [`Geometry`] supplies what differs between the dimensions to what is written once for both:
//! `impl<const D: usize, const N: usize> … where Euclidean: Geometry<D, N>`, where `N` is `D` + 1.

mod d2;
mod d3;
mod power;
pub(crate) mod real;
pub(crate) mod vector;

pub(crate) use d2::angles;
pub(crate) use d3::{dihedral_angles, precise_triangle_circumcenter_offset};
pub(crate) use power::{Power, below_on_line, exact_power_center_offset, power_center_offset};

use crate::{
    input::order::Curve,
    input::points::Points,
    predicates::{
        Sign,
        big::{Big, common_exponent, precise_quotient, quotient},
        polynomial::{Polynomial, Ring, dot, exact_sign, minus},
    },
};

/// The marker that [`Geometry`] is implemented for, in 2D and 3D.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Euclidean;

/// The geometry of simplices with `N` = `D` + 1 vertices, as far as it depends on the dimension.
#[doc(hidden)]
pub trait Geometry<const D: usize, const N: usize>: Copy + Send + Sync + 'static {
    /// The corners of the facet opposite vertex *k* of a positively oriented simplex:
    /// counter-clockwise as seen from outside in 3D, in the direction that has the triangle on its
    /// left in 2D.
    const FACETS: [[usize; D]; N];

    /// The number that a mesh gives to the facet opposite vertex *k*.
    const FACET_NUMBERS: [usize; N];

    /// The Hilbert curve.
    const CURVE: Curve<D>;

    /// Returns the determinant of the rows, rounded. If they are differences of points, its error
    /// is below
    /// [`unscaled_orientation_bound`](crate::predicates::filter::unscaled_orientation_bound) of the
    /// largest absolute entry of each column.
    fn determinant(rows: &[[f64; D]; D]) -> f64;

    /// Returns the determinants of the rows of each facet in [`FACETS`](Self::FACETS), with the
    /// error of [`determinant`](Self::determinant).
    fn facet_determinants(rows: &[[f64; D]; N]) -> [f64; N];

    /// Returns which side of a facet a point is on, exactly: 1 on the side that the facet is
    /// clockwise from, which is the inner side of the facets in [`FACETS`](Self::FACETS), −1 on the
    /// other, 0 on the facet's plane.
    fn side(facet: &[[f64; D]; D], p: [f64; D]) -> Sign;

    /// Returns 1 if a point is inside the circumsphere of a positively oriented simplex, −1
    /// outside, 0 on it; exactly.
    fn in_sphere(simplex: &[[f64; D]; N], p: [f64; D]) -> Sign;

    /// Returns 1 if a point with its weight is below a positively oriented simplex with weights when all are lifted, −1
    /// above, 0 on it; exactly. With equal weights it is [`in_sphere`](Self::in_sphere).
    fn is_below(simplex: &[[f64; D]; N], weights: &[f64; N], apex: ([f64; D], f64)) -> Sign;

    /// Returns the determinant of the rows, exactly if the ring is exact.
    fn determinant_in<T: Ring>(rows: &[[T; D]; D]) -> T;

    /// Returns the circumcentre relative to the origin, which is a vertex of the simplex, times the
    /// second result. The edges lead to the other vertices.
    fn circumcenter_fraction<T: Ring>(edges: &[[T; D]; D]) -> ([T; D], T) {
        Self::center_fraction(edges, &std::array::from_fn(|k| dot(&edges[k], &edges[k])))
    }

    /// Returns the point c with 2·c·u = s for each edge u and its number s, times the second result: the circumcentre
    /// if these are the squared lengths of the edges, and the power centre if the differences of the weights to that of
    /// the origin are subtracted.
    fn center_fraction<T: Ring>(edges: &[[T; D]; D], squares: &[T; D]) -> ([T; D], T);

    /// Returns the circumcentre relative to the first vertex, from the edges that lead to the
    /// others, if rounding surely did not move it by more than 2⁻³⁷ times the circumradius.
    fn circumcenter_estimate(edges: &[[f64; D]; D]) -> Option<[f64; D]>;

    /// Returns the squared radius of the smallest sphere through the vertices of a face with `D`
    /// vertices, up to rounding.
    fn facet_squared_radius(facet: &[[f64; D]; D]) -> f64;

    /// Returns the squared radius of the smallest sphere through the vertices of a simplex or a
    /// face of it, as a fraction with a denominator that is not negative.
    fn squared_radius_fraction<T: Ring>(points: &[[T; D]]) -> (T, T);

    /// Returns whether a point is inside the smallest sphere through the vertices of a facet,
    /// exactly.
    fn in_smallest_sphere(facet: &[[f64; D]; D], p: [f64; D]) -> bool;

    /// Returns the normal of a facet that points to where the facet is counter-clockwise from: out of
    /// the simplex for those in [`FACETS`](Self::FACETS). In 2D, it points to the right of the edge.
    /// Its length is the facet's measure times (`D` − 1)!.
    fn facet_normal(facet: &[[f64; D]; D]) -> [f64; D];

    /// Returns the sum of the measures of a simplex's facets.
    fn boundary_measure(simplex: &[[f64; D]; N]) -> f64;
}

/// Returns the coordinates of the vertices of each simplex.
///
/// # Panics
///
/// The iterator panics at a vertex that is not among the points.
pub(crate) fn coordinates<'a, const D: usize, const N: usize>(
    points: Points<'a, D>,
    simplices: &'a [[u32; N]],
) -> impl ExactSizeIterator<Item = [[f64; D]; N]> + Clone + 'a {
    simplices.iter().map(move |simplex| simplex.map(|v| points.get(v as usize)))
}

/// Returns the vertices of the facet opposite vertex `k`.
#[inline]
pub(crate) fn facet<T: Copy, const D: usize, const N: usize>(simplex: &[T; N], k: usize) -> [T; D]
where
    Euclidean: Geometry<D, N>,
{
    let facet = &<Euclidean as Geometry<D, N>>::FACETS[k];
    let mut corners = [simplex[0]; D];
    for (to, &corner) in corners.iter_mut().zip(facet) {
        *to = simplex[corner];
    }
    corners
}

/// Returns the edges from the first vertex to the others.
fn edges<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> [[f64; D]; D] {
    let mut edges = [[0.0; D]; D];
    for (edge, &corner) in edges.iter_mut().zip(&simplex[1..]) {
        *edge = vector::minus(corner, simplex[0]);
    }
    edges
}

/// Returns the squared radius of the smallest sphere through two points, as a fraction.
fn edge_squared_radius<T: Ring, const D: usize>(a: &[T; D], b: &[T; D]) -> (T, T) {
    let u = minus(a, b);
    (dot(&u, &u), T::from(4))
}

/// Returns the circumcentre relative to the first vertex.
///
/// The error is at most 2⁻³⁷ times the circumradius, however flat the simplex is. Coordinates
/// beyond the range of `f64` are infinite.
pub(crate) fn circumcenter_offset<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> [f64; D]
where
    Euclidean: Geometry<D, N>,
{
    match Euclidean::circumcenter_estimate(&edges(simplex)) {
        Some(offset) => offset,
        None => exact_circumcenter_offset(simplex),
    }
}

/// Returns the circumcentre relative to the first vertex, correctly rounded unless a coordinate is
/// subnormal.
#[inline(never)]
fn exact_circumcenter_offset<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> [f64; D]
where
    Euclidean: Geometry<D, N>,
{
    real::rounded_circumcenter_offset(simplex)
        .unwrap_or_else(|| rounded(exact_offset::<D, N, D>(simplex, Euclidean::circumcenter_fraction)))
}

/// A point as numerators, a positive denominator, and the exponent of a power of two.
type Fraction<const D: usize> = ([Big; D], Big, i32);

/// Returns a point relative to the first of the given points, exactly; `fraction` finds it from the
/// differences of the others to the first. There is none if the denominator is 0.
#[inline(never)]
fn exact_offset<const D: usize, const K: usize, const E: usize>(
    points: &[[f64; D]; K],
    fraction: impl Fn(&[[Big; D]; E]) -> ([Big; D], Big),
) -> Option<Fraction<D>> {
    let exponent = common_exponent(points.as_flattened());
    let integers = points.map(|p| p.map(|x| Big::new(x, exponent)));
    let (numerator, denominator) = fraction(&std::array::from_fn(|i| minus(&integers[i + 1], &integers[0])));
    positive(numerator, denominator, exponent)
}

/// Returns a fraction with a positive denominator, if it has a denominator.
fn positive<const D: usize>(numerator: [Big; D], denominator: Big, exponent: i32) -> Option<Fraction<D>> {
    match denominator.sign() {
        1 => Some((numerator, denominator, exponent)),
        -1 => Some((numerator.map(|x| Big::from(0) - x), Big::from(0) - denominator, exponent)),
        _ => None,
    }
}

/// Returns the coordinates of a point, correctly rounded unless they are subnormal; infinite ones
/// if there is no point.
fn rounded<const D: usize>(fraction: Option<Fraction<D>>) -> [f64; D] {
    fraction.map_or([f64::INFINITY; D], |(numerator, denominator, exponent)| {
        numerator.map(|x| quotient(&x, &denominator, exponent))
    })
}

/// Returns the barycentric coordinates of a point that a simplex contains. Their errors are below
/// 2⁻³⁷, however flat the simplex is, and their sum is 1 up to rounding.
pub(crate) fn barycentric<const D: usize, const N: usize>(simplex: &[[f64; D]; N], p: [f64; D]) -> [f64; N]
where
    Euclidean: Geometry<D, N>,
{
    let rows = vector::relative(simplex, p);
    // None is negative for a point inside.
    let shares: [f64; N] = std::array::from_fn(|k| Euclidean::determinant(&facet(&rows, k)).max(0.0));
    let sum: f64 = shares.iter().sum();
    // The errors are at most 10·D!·2⁻⁵³·extentᴰ.
    let extent = rows.as_flattened().iter().fold(0.0f64, |extent, x| extent.max(x.abs()));
    if (1e-90..1e90).contains(&extent) && sum * 1024.0 > extent.powi(D as i32) {
        return shares.map(|share| share / sum);
    }
    exact_barycentric(simplex, p)
}

#[inline(never)]
fn exact_barycentric<const D: usize, const N: usize>(simplex: &[[f64; D]; N], p: [f64; D]) -> [f64; N]
where
    Euclidean: Geometry<D, N>,
{
    let exponent = common_exponent(simplex.as_flattened()).min(common_exponent(&p));
    let integer = |p: [f64; D]| p.map(|x| Big::new(x, exponent));
    let origin = integer(p);
    let rows = simplex.map(|corner| minus(&integer(corner), &origin));
    let shares: [Big; N] = std::array::from_fn(|k| {
        Euclidean::determinant_in(&<Euclidean as Geometry<D, N>>::FACETS[k].map(|corner| rows[corner].clone()))
    });
    let sum = shares.iter().cloned().fold(Big::from(0), |sum, share| sum + share);
    if sum.sign() <= 0 {
        return [f64::NAN; N];
    }
    shares.map(|share| quotient(&share, &sum, 0))
}

/// Returns the centre of the sphere through the vertices of a simplex: see [`circumcenter_offset`].
pub(crate) fn circumcenter<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> [f64; D]
where
    Euclidean: Geometry<D, N>,
{
    vector::plus(simplex[0], circumcenter_offset(simplex))
}

/// Returns the centre of the sphere through the vertices of a simplex relative to the first one,
/// and the radius: see [`circumcenter_offset`] and [`circumradius`].
pub fn circumsphere<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> ([f64; D], f64)
where
    Euclidean: Geometry<D, N>,
{
    let offset = circumcenter_offset(simplex);
    (offset, vector::norm(offset))
}

/// Returns the radius of the sphere through the vertices of a simplex, with a relative error below
/// 2⁻³⁶.
pub(crate) fn circumradius<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    circumsphere(simplex).1
}

/// Returns the volume of a positively oriented tetrahedron or the area of a counter-clockwise
/// triangle.
pub(crate) fn measure<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    Euclidean::determinant(&edges(simplex)) / factorial(D)
}

/// Returns the ratio of the inradius to the circumradius, times `D`: 1 for the regular simplex,
/// near 0 for flat ones.
pub(crate) fn radius_ratio<const D: usize, const N: usize>(simplex: &[[f64; D]; N]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let d = D as f64;
    // A simplex is D pyramids' worth: measure = inradius · boundary / D.
    d * d * measure(simplex) / Euclidean::boundary_measure(simplex) / circumradius(simplex)
}

pub(crate) fn factorial(n: usize) -> f64 {
    (1..=n).map(|i| i as f64).product()
}

/// (a − p)·(b − p).
pub(crate) struct Angle;

impl<const D: usize> Polynomial<3, D> for Angle {
    fn value<T: Ring>(&self, [p, a, b]: &[[T; D]; 3]) -> T {
        dot(&minus(a, p), &minus(b, p))
    }
}

/// Returns whether p is inside the smallest sphere through a and b, exactly: whether it sees them
/// at an obtuse angle.
///
/// With the differences and the products at most three roundings are in each term of the dot
/// product, and two in its sum, so that its error is below 6·2⁻⁵³ times the sum of the terms'
/// magnitudes, and 2⁻¹⁰⁷⁰ where terms underflow.
#[inline]
pub(crate) fn is_obtuse<const D: usize>(p: [f64; D], a: [f64; D], b: [f64; D]) -> bool {
    let (u, v) = (vector::minus(a, p), vector::minus(b, p));
    let (mut dot, mut magnitude) = (0.0, 0.0);
    for axis in 0..D {
        let term = u[axis] * v[axis];
        dot += term;
        magnitude += term.abs();
    }
    if dot.abs() > RELATIVE_MARGIN * magnitude + ABSOLUTE_MARGIN {
        dot < 0.0
    } else {
        exact_sign(&Angle, &[p, a, b]) < 0
    }
}

/// The difference of two squared radii times their denominators: those of two faces, or of a face
/// and a number, which is the first coordinate of the fifth point if the second face has no
/// vertices.
struct RadiusDifference<const N: usize> {
    /// The numbers of vertices.
    first: usize,
    second: usize,
}

impl<const D: usize, const N: usize> Polynomial<8, D> for RadiusDifference<N>
where
    Euclidean: Geometry<D, N>,
{
    fn value<T: Ring>(&self, points: &[[T; D]; 8]) -> T {
        let (first, second) = points.split_at(4);
        let (numerator, denominator) = Euclidean::squared_radius_fraction(&first[..self.first]);
        let (other, other_denominator) = match self.second {
            0 => (second[0][0].clone() * second[0][0].clone(), T::from(1)),
            count => Euclidean::squared_radius_fraction(&second[..count]),
        };
        numerator * other_denominator - other * denominator
    }
}

/// Returns the sign of the difference of the radii of two faces, exactly.
#[inline(never)]
pub(crate) fn compare_radii<const D: usize, const N: usize>(a: &[[f64; D]], b: &[[f64; D]]) -> Sign
where
    Euclidean: Geometry<D, N>,
{
    let mut points = [[0.0; D]; 8];
    points[..a.len()].copy_from_slice(a);
    points[4..4 + b.len()].copy_from_slice(b);
    exact_sign(&RadiusDifference::<N> { first: a.len(), second: b.len() }, &points)
}

/// Returns the sign of the difference of the radius of a face and a number that is not negative,
/// exactly.
#[inline(never)]
pub(crate) fn compare_radius<const D: usize, const N: usize>(face: &[[f64; D]], radius: f64) -> Sign
where
    Euclidean: Geometry<D, N>,
{
    let mut points = [[0.0; D]; 8];
    points[..face.len()].copy_from_slice(face);
    points[4][0] = radius;
    exact_sign(&RadiusDifference::<N> { first: face.len(), second: 0 }, &points)
}

/// Returns the squared radius of a face, times the square of a power of two, as the sum of two
/// numbers with a relative error below 2⁻⁹⁸, the larger one first. It must be far from the limits of
/// `f64`.
#[inline(never)]
pub(crate) fn precise_squared_radius<const D: usize, const N: usize>(face: &[[f64; D]], scale: f64) -> [f64; 2]
where
    Euclidean: Geometry<D, N>,
{
    let exponent = common_exponent(face.as_flattened());
    let integers: Vec<[Big; D]> = face.iter().map(|p| p.map(|x| Big::new(x, exponent))).collect();
    let (numerator, denominator) = Euclidean::squared_radius_fraction(&integers);
    precise_quotient(&numerator, &denominator, 2 * (exponent + libm::ilogb(scale)))
}

/// Returns the smallest `f64` that is not less than the radius of a face; infinity if that is flat.
pub(crate) fn radius_rounded_up<const D: usize, const N: usize>(face: &[[f64; D]]) -> f64
where
    Euclidean: Geometry<D, N>,
{
    let exponent = common_exponent(face.as_flattened());
    let integers: Vec<[Big; D]> = face.iter().map(|p| p.map(|x| Big::new(x, exponent))).collect();
    let (numerator, denominator) = Euclidean::squared_radius_fraction(&integers);
    if denominator.sign() == 0 {
        return f64::INFINITY;
    }
    // The root of a number between 1/4 and 4, times a power of two: right up to a few units in the
    // last place.
    let half = ((numerator.bits() - denominator.bits()) / 2) as i32;
    let mut radius = libm::ldexp(quotient(&numerator, &denominator, -2 * half).sqrt(), half + exponent);
    while compare_radius::<D, N>(face, radius) <= 0 && radius > 0.0 {
        radius = radius.next_down();
    }
    while compare_radius::<D, N>(face, radius) > 0 {
        radius = radius.next_up();
    }
    radius
}

/// |q − a|² − |q − b|².
struct DistanceDifference;

impl<const D: usize> Polynomial<3, D> for DistanceDifference {
    fn value<T: Ring>(&self, [q, a, b]: &[[T; D]; 3]) -> T {
        let squared = |p: &[T; D]| {
            let u = minus(q, p);
            dot(&u, &u)
        };
        squared(a) - squared(b)
    }
}

/// Returns the sign of |q − a| − |q − b|, exactly.
#[inline]
pub(crate) fn compare_distances<const D: usize>(q: [f64; D], a: [f64; D], b: [f64; D]) -> Sign {
    let [to_a, to_b] = [a, b].map(|p| vector::squared_norm(vector::minus(q, p)));
    match certain_difference(to_a, to_b) {
        0 => exact_sign(&DistanceDifference, &[q, a, b]),
        sign => sign,
    }
}

/// Returns the sign of the difference of two rounded squared distances, or 0 if rounding may have
/// changed it.
///
/// Three roundings for each of at most three squares and two for their sum leave a relative error
/// below 6·2⁻⁵³, and underflow an absolute one below 2⁻¹⁰⁷⁰.
#[inline]
pub(crate) fn certain_difference(a: f64, b: f64) -> Sign {
    let margin = RELATIVE_MARGIN * (a + b) + ABSOLUTE_MARGIN;
    (a - b > margin) as Sign - (b - a > margin) as Sign
}

/// Returns a number such that rounded squared distances above it are those of points that are surely
/// further apart than those whose rounded squared distance is given.
#[inline]
pub(crate) fn surely_larger(squared: f64) -> f64 {
    squared * (1.0 + 4.0 * RELATIVE_MARGIN) + ABSOLUTE_MARGIN
}

/// Above the errors of sums of rounded products of differences of coordinates.
const RELATIVE_MARGIN: f64 = 16.0 * f64::EPSILON;
const ABSOLUTE_MARGIN: f64 = f64::from_bits((1023 - 1000) << 52);

/// A squared distance, rounded, and whether nothing was rounded.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SquaredLength {
    /// The squared distance, with a minus where it was rounded.
    value: f64,
}

impl SquaredLength {
    /// Returns the squared distance of two points. On grids nothing is rounded, and that is
    /// noticed.
    #[inline]
    pub(crate) fn new<const D: usize>(a: [f64; D], b: [f64; D]) -> Self {
        let (mut value, mut is_exact) = (0.0, true);
        for axis in 0..D {
            let difference = a[axis] - b[axis];
            let square = difference * difference;
            let sum = value + square;
            // A difference is exact if both numbers can be had back from it, a square if the number
            // has few digits and is not tiny, and a sum if both terms can be had back from it.
            is_exact &= difference + b[axis] == a[axis] && a[axis] - difference == b[axis];
            let is_short = f64::from(difference as f32) == difference;
            is_exact &= difference == 0.0 || (is_short && square >= f64::from(f32::MIN_POSITIVE));
            is_exact &= sum - value == square && sum - square == value;
            value = sum;
        }
        SquaredLength { value: if is_exact { value } else { -value } }
    }

    #[inline(always)]
    fn is_exact(self) -> bool {
        self.value.is_sign_positive()
    }

    /// Returns the distance, unless the square came near the limits of `f64`.
    pub(crate) fn root(self) -> Option<f64> {
        let squared = self.value.abs();
        (1e-280..1e280).contains(&squared).then(|| squared.sqrt())
    }

    /// Returns the sign of the difference of two squared distances, or 0 if rounding may have
    /// changed it.
    #[inline]
    pub(crate) fn certain_difference(self, other: Self) -> Sign {
        let (a, b) = (self.value.abs(), other.value.abs());
        if self.is_exact() && other.is_exact() {
            return (a > b) as Sign - (a < b) as Sign;
        }
        certain_difference(a, b)
    }
}

/// |a − b|² − |c − d|².
struct LengthDifference;

impl<const D: usize> Polynomial<4, D> for LengthDifference {
    fn value<T: Ring>(&self, [a, b, c, d]: &[[T; D]; 4]) -> T {
        let (u, v) = (minus(a, b), minus(c, d));
        dot(&u, &u) - dot(&v, &v)
    }
}

/// Returns the sign of the difference of the lengths of two edges, exactly.
#[inline]
pub(crate) fn compare_lengths<const D: usize>(
    ([a, b], first): ([[f64; D]; 2], SquaredLength),
    ([c, d], second): ([[f64; D]; 2], SquaredLength),
) -> Sign {
    match first.certain_difference(second) {
        0 if !(first.is_exact() && second.is_exact()) => exact_sign(&LengthDifference, &[a, b, c, d]),
        sign => sign,
    }
}
