//! The shapes of triangles: which are bad, and where a point improves one.
//!
//! All is in floating point, since no triangle becomes wrong by it, and without functions that differ between machines.
//! Coordinates are multiplied by a power of two, so that squares neither overflow nor vanish.

use super::{RefineOptions, Size};
use crate::geometry::vector::{cross2d, dot, minus};

/// An edge is refined no further if it is shorter than this many units in the last place of its coordinates.
const FINEST: f64 = 64.0;

/// The smallest angle for which points keep away from segments, in degrees: also where only the size is limited.
const LEAST_ANGLE: f64 = 20.0;

/// The share of the distance at which the new point and the shortest edge would make a triangle that has just the
/// smallest angle. A little less than 1 leaves room for rounding, as in Triangle.
const OFF_CENTER: f64 = 0.95;

type Point = [f64; 2];

/// What is measured of a triangle.
pub(super) struct Measures {
    /// The edge that is shortest; the first of several.
    pub(super) shortest: usize,
    /// The squares of the lengths of the edges.
    squares: [f64; 3],
    /// The squared sine of the smallest angle, which is opposite the shortest edge.
    pub(super) sine: f64,
    double_area: f64,
}

/// What shapes and sizes are allowed.
pub(super) struct Shape<'a> {
    scale: f64,
    /// The squared sine of the smallest angle that is allowed.
    sine: f64,
    /// The cosine of twice the angle, squared: a point from which a segment is seen under an angle larger than 180°
    /// less twice the smallest angle is too near.
    lens: f64,
    /// The distance of an off-centre from the shortest edge, in lengths of that.
    off_center: f64,
    largest_double_area: f64,
    size: Size<'a>,
}

impl<'a> Shape<'a> {
    pub(super) fn new(options: &RefineOptions<'a>, points: &[Point]) -> Self {
        let largest = points.as_flattened().iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
        // The power of two with which the largest coordinate is between 1 and 2; its reciprocal has to be a number, too.
        let exponent = ((largest.to_bits() >> 52) as i64 - 1023).clamp(-1000, 1000);
        let scale = if largest == 0.0 { 1.0 } else { f64::from_bits(((1023 - exponent) as u64) << 52) };
        let sine = libm::sin(options.min_angle.to_radians());
        let apart = options.min_angle.max(LEAST_ANGLE).to_radians();
        let (lens, half) = (libm::cos(2.0 * apart), 0.5 * apart);
        Shape {
            scale,
            sine: sine * sine,
            lens: lens * lens,
            off_center: 0.5 * OFF_CENTER * libm::cos(half) / libm::sin(half),
            largest_double_area: options.max_area.map_or(f64::INFINITY, |area| 2.0 * (area * scale * scale)),
            size: options.size,
        }
    }

    pub(super) fn scaled(&self, p: Point) -> Point {
        p.map(|x| x * self.scale)
    }

    fn unscaled(&self, p: Point) -> Point {
        p.map(|x| x * (1.0 / self.scale))
    }

    pub(super) fn square(&self, a: Point, b: Point) -> f64 {
        let ab = minus(self.scaled(b), self.scaled(a));
        dot(ab, ab)
    }

    /// Returns twice the area of a triangle, scaled.
    pub(super) fn double_area(&self, corners: [Point; 3]) -> f64 {
        let [a, b, c] = corners.map(|p| self.scaled(p));
        cross2d(minus(b, a), minus(c, a))
    }

    pub(super) fn measure(&self, corners: [Point; 3]) -> Measures {
        let corners = corners.map(|p| self.scaled(p));
        let edges = [0, 1, 2].map(|k| minus(corners[(k + 1) % 3], corners[k]));
        let squares = edges.map(|edge| dot(edge, edge));
        let [s, t, u] = squares;
        let shortest = if s <= t && s <= u { 0 } else { if t <= u { 1 } else { 2 } };
        let (after, before) = ((shortest + 1) % 3, (shortest + 2) % 3);
        let double_area = cross2d(edges[after], edges[before]);
        let sine = double_area / squares[after] * (double_area / squares[before]);
        Measures { shortest, squares, sine, double_area }
    }

    /// Returns whether the smallest angle is below the bound.
    pub(super) fn is_skinny(&self, measures: &Measures) -> bool {
        measures.sine < self.sine || measures.sine.is_nan()
    }

    /// Returns whether the triangle is larger than allowed.
    pub(super) fn is_large(&self, measures: &Measures, corners: [Point; 3], sizes: [f64; 3]) -> bool {
        if measures.double_area > self.largest_double_area {
            return true;
        }
        let [a, b, c] = corners;
        let third = 1.0 / 3.0;
        let size = match self.size {
            Size::Any => return false,
            Size::Uniform(size) => size,
            Size::PerPoint(_) => (sizes[0] + sizes[1] + sizes[2]) * third,
            Size::Field(field) => field([0, 1].map(|k| a[k] * third + b[k] * third + c[k] * third)),
        } * self.scale;
        let [s, t, u] = measures.squares;
        // No size, or one that is no number, is no limit.
        size > 0.0 && s.max(t).max(u) > size * size
    }

    /// Returns the length, scaled, below which nothing is refined near these points.
    fn finest(&self, points: &[Point]) -> f64 {
        let largest = points.as_flattened().iter().fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()));
        largest * f64::EPSILON * self.scale * FINEST
    }

    /// Returns whether a triangle is so flat that coordinates are too coarse for points in it.
    pub(super) fn is_flat(&self, measures: &Measures, corners: [Point; 3]) -> bool {
        let [s, t, u] = measures.squares;
        let least = self.finest(&corners);
        measures.double_area * measures.double_area < s.max(t).max(u) * least * least
    }

    /// Returns whether an edge is so short that coordinates are too coarse for points near it.
    pub(super) fn is_finest(&self, a: Point, b: Point) -> bool {
        let unit = self.finest(&[a, b]);
        let square = self.square(a, b);
        square < unit * unit || square < f64::MIN_POSITIVE / f64::EPSILON
    }

    /// Returns the key by which bad triangles are ordered: the larger, the longer the shortest edge.
    pub(super) fn key(measures: &Measures) -> usize {
        // The exponent and the first digit after it.
        (measures.squares[measures.shortest].to_bits() >> 51) as usize
    }

    /// Returns the point that improves a triangle: the centre of its circumcircle, or the off-centre if that is nearer
    /// (Üngör 2004), from which the shortest edge is seen under a little more than the smallest angle.
    pub(super) fn improving_point(&self, measures: &Measures, corners: [Point; 3]) -> Point {
        let [a, b, c] = [0, 1, 2].map(|k| self.scaled(corners[(measures.shortest + k) % 3]));
        let (ab, ac) = (minus(b, a), minus(c, a));
        let (b2, c2) = (dot(ab, ab), dot(ac, ac));
        let twice = 2.0 * measures.double_area;
        let (b_share, c_share) = (b2 / twice, c2 / twice);
        let center = [ac[1] * b_share - ab[1] * c_share, ab[0] * c_share - ac[0] * b_share];
        let off = [0.5 * ab[0] - self.off_center * ab[1], 0.5 * ab[1] + self.off_center * ab[0]];
        let nearer = if dot(off, off) < dot(center, center) { off } else { center };
        self.unscaled([a[0] + nearer[0], a[1] + nearer[1]])
    }

    /// Returns whether a point is too near a segment: in the lens around it from which it is seen under an angle larger
    /// than 180° less twice the smallest one (Shewchuk 2002, §3.4). A point so near that coordinates are too coarse for others
    /// between them is not: cuts would not end where segments almost coincide.
    pub(super) fn is_near(&self, [a, b]: [Point; 2], p: Point) -> bool {
        let least = self.finest(&[a, b]);
        let [a, b, p] = [a, b, p].map(|p| self.scaled(p));
        let (pa, pb) = (minus(a, p), minus(b, p));
        let (along, ab) = (dot(pa, pb), minus(b, a));
        let is_near = along < 0.0 && along / dot(pa, pa) * (along / dot(pb, pb)) >= self.lens;
        is_near && cross2d(pa, ab).abs() > least * dot(ab, ab).sqrt()
    }

    /// Returns whether a point is inside the circle with a segment as diameter.
    pub(super) fn is_in_diametral_circle(&self, [a, b]: [Point; 2], p: Point) -> bool {
        let [a, b, p] = [a, b, p].map(|p| self.scaled(p));
        dot(minus(a, p), minus(b, p)) < 0.0
    }

    /// Returns whether an angle is below 60°.
    pub(super) fn is_acute(&self, apex: Point, a: Point, b: Point) -> bool {
        let [apex, a, b] = [apex, a, b].map(|p| self.scaled(p));
        let (a, b) = (minus(a, apex), minus(b, apex));
        let along = dot(a, b);
        along > 0.0 && cross2d(a, b) > 0.0 && along / dot(a, a) * (along / dot(b, b)) > 0.25
    }

    /// Returns the middle of a piece.
    pub(super) fn middle(&self, [a, b]: [Point; 2]) -> Point {
        let (a, b) = (self.scaled(a), self.scaled(b));
        self.unscaled([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])])
    }

    /// Returns a place in the middle third of a piece whose distance from an end of its segment has as few binary digits as
    /// possible. So segments that meet there are cut at the same distances from it, wherever they are cut (after Ruppert
    /// 1995, whose powers of two are those of the first pieces).
    pub(super) fn on_shell(&self, piece: [Point; 2], center: Point, end: Point) -> Point {
        let (from, to) = (self.scaled(center), self.scaled(end));
        let along = minus(to, from);
        let length = dot(along, along).sqrt();
        let [near, far] = piece.map(|p| self.square(center, p).sqrt());
        let (near, far) = (near.min(far), near.max(far));
        let (low, high) = (near + (far - near) * (1.0 / 3.0), far - (far - near) * (1.0 / 3.0));
        let mut digit = f64::from_bits(high.to_bits() >> 52 << 52);
        let distance = loop {
            let distance = (high / digit).floor() * digit;
            if distance >= low || digit < far - near {
                break if distance >= low { distance } else { 0.5 * (near + far) };
            }
            digit *= 0.5;
        };
        let share = distance / length;
        self.unscaled([from[0] + along[0] * share, from[1] + along[1] * share])
    }

    /// Returns whether two points are at the same distance from a third, within a thousandth, and nearer to each other:
    /// whether they are on one shell around it, and seen from it under an angle below 60°.
    pub(super) fn are_on_shell(&self, center: Point, a: Point, b: Point) -> bool {
        let (to_a, to_b, across) = (self.square(center, a), self.square(center, b), self.square(a, b));
        to_a < 1.001 * to_b && to_b < 1.001 * to_a && across < to_a
    }
}
