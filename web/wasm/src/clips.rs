//! What cells of points are clipped to.

use crate::{objects::Thrown, points::zeros};
use gdel::{Clip, Points};
use js_sys::Float64Array;

/// Copies numbers.
pub(crate) fn numbers_of(array: &Float64Array) -> Result<Vec<f64>, Thrown> {
    let mut numbers = zeros(array.length())?;
    array.copy_to(&mut numbers);
    Ok(numbers)
}

/// Copies the corners of a shape.
pub(crate) fn corners_of<const D: usize>(numbers: &Float64Array) -> Result<Vec<[f64; D]>, Thrown> {
    let shape = numbers_of(numbers)?;
    let corner = |start: usize| {
        std::array::from_fn(|axis| if D == 2 && axis == 1 { -shape[start + axis] } else { shape[start + axis] })
    };
    Ok((0..shape.len() / D).map(|i| corner(D * i)).collect())
}

/// Returns what cells of points are clipped to: nothing, the hull, the smallest box, one with these corners, the
/// lowest, then the highest, or the convex shape with these corners.
pub(crate) fn clip_of<'c, const D: usize>(clip: &str, corners: &'c [[f64; D]], points: Points<'_, D>) -> Clip<'c, D> {
    match (clip, points.bounds()) {
        ("hull", _) => Clip::Hull,
        ("box", Some(bounds)) => Clip::Box(bounds),
        ("bounds", _) => {
            let (mut low, mut high) = (corners[0], corners[1]);
            if D == 2 {
                (low[1], high[1]) = (high[1], low[1]);
            }
            Clip::Box([low, high])
        }
        ("corners", _) => Clip::Convex(corners),
        _ => Clip::None,
    }
}
