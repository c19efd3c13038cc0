//! In-sphere and in-circle tests of floating-point coordinates with ties broken, without filters.

use gdel::{
    Sign, incircle, insphere,
    internals::predicates::symbolic::{break_tie, without},
    orient2d, orient3d,
};

/// Returns the sign of [`insphere`] with ties broken: never zero for distinct points that are not
/// all coplanar.
///
/// `points` are input indices, all different, and coordinates.
pub fn insphere_symbolic(points: [(u32, [f64; 3]); 5]) -> Sign {
    let [a, b, c, d, e] = points.map(|(_, p)| p);
    match insphere(a, b, c, d, e) {
        0 => break_tie(points.map(|(i, _)| i), |k| {
            let [a, b, c, d] = without(points, k).map(|(_, p)| p);
            orient3d(a, b, c, d)
        }),
        sign => sign,
    }
}

/// Returns the sign of [`incircle`] with ties broken: never zero for distinct
/// points that are not all collinear.
///
/// `points` are input indices, all different, and coordinates.
pub fn incircle_symbolic(points: [(u32, [f64; 2]); 4]) -> Sign {
    let [a, b, c, d] = points.map(|(_, p)| p);
    match incircle(a, b, c, d) {
        0 => break_tie(points.map(|(i, _)| i), |k| {
            let [a, b, c] = without(points, k).map(|(_, p)| p);
            orient2d(a, b, c)
        }),
        sign => sign,
    }
}
