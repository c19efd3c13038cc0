//! The height of a triangle at a place in it.

use crate::{
    geometry::vector::{cross2d, minus},
    predicates::big::{Big, common_exponent, quotient},
};
use std::ops::Add;

/// A triangle with less than this share of the square over its longest extent is evaluated in integers. For all others,
/// the result is off by less than 10⁻⁸ of the difference between the heights of the corners.
const FLAT: f64 = 1.0 / (1u64 << 20) as f64;

/// A triangle in space, which is not flat as seen from above.
pub(super) struct Face {
    corners: [[f64; 3]; 3],
    /// From the first corner to the others.
    sides: [[f64; 2]; 2],
    /// How far the others are above it, over twice the area; not finite if rounding could make heights wrong.
    slopes: [f64; 2],
}

impl Face {
    pub(super) fn new(corners: [[f64; 3]; 3]) -> Self {
        let [a, b, c] = corners.map(|[x, y, _]| [x, y]);
        let sides = [minus(b, a), minus(c, a)];
        let extent = sides.as_flattened().iter().fold(0.0f64, |extent, x| extent.max(x.abs()));
        let double_area = cross2d(sides[0], sides[1]);
        // False where numbers overflow or vanish.
        let is_precise = double_area >= FLAT * extent * extent && double_area.is_normal();
        let over = if is_precise { double_area } else { f64::NAN };
        let slopes = [1, 2].map(|k| (corners[k][2] - corners[0][2]) / over);
        Face { corners, sides, slopes }
    }

    /// Returns the height at a place in the triangle or on its border.
    pub(super) fn height(&self, place: [f64; 2]) -> f64 {
        let [x, y, z] = self.corners[0];
        let from = minus(place, [x, y]);
        let [ab, ac] = self.sides;
        let height = z + cross2d(from, ac) * self.slopes[0] + cross2d(ab, from) * self.slopes[1];
        if height.is_finite() { height } else { self.exact_height(place) }
    }

    /// Returns the height, rounded once.
    fn exact_height(&self, place: [f64; 2]) -> f64 {
        let planar = self.corners.map(|[x, y, _]| [x, y]);
        let heights = self.corners.map(|[_, _, z]| z);
        let exponent = common_exponent(planar.as_flattened().iter().chain(&place));
        let above = common_exponent(&heights);
        let big = |p: [f64; 2]| p.map(|x| Big::new(x, exponent));
        let to = planar.map(|p| {
            let ([x, y], [ox, oy]) = (big(p), big(place));
            [x - ox, y - oy]
        });
        let area = |k: usize| {
            let ([ux, uy], [vx, vy]) = (&to[(k + 1) % 3], &to[(k + 2) % 3]);
            ux * vy - uy * vx
        };
        let areas = [0, 1, 2].map(area);
        let moment =
            areas.iter().zip(heights).map(|(area, z)| area * &Big::new(z, above)).fold(Big::default(), Add::add);
        quotient(&moment, &areas.into_iter().fold(Big::default(), Add::add), above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_agree() {
        let face = Face::new([[0.0, 0.0, 1.0], [8.0, 1.0, 5.0], [3.0, 7.0, -2.0]]);
        assert!(face.slopes.iter().all(|x| x.is_finite()));
        for place in [[0.0, 0.0], [8.0, 1.0], [3.0, 7.0], [3.0, 2.0], [5.5, 4.0], [4.0, 0.5]] {
            let (height, exact) = (face.height(place), face.exact_height(place));
            assert!((height - exact).abs() < 1e-14, "{place:?}: {height}, {exact}");
        }
    }

    #[test]
    fn needles_and_extremes() {
        // A needle, in which differences of products lose all digits.
        let face = Face::new([[0.0, 0.0, 0.0], [1e8, 1.0, 4.0], [2e8, 2.0 + 1e-8, 8.0]]);
        assert!(!face.slopes[0].is_finite());
        assert_eq!((face.height([1e8, 1.0]), face.height([2e8, 2.0 + 1e-8])), (4.0, 8.0));
        // Products overflow or vanish; so do differences of heights.
        for size in [1e300, 1e-300] {
            let face = Face::new([[-size, -size, -1e308], [size, -size, 1e308], [-size, size, 1e308]]);
            assert_eq!(face.height([0.0, 0.0]), 1e308);
            assert_eq!(face.height([-size, 0.0]), 0.0);
        }
    }
}
