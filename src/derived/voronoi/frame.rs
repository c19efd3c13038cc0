//! Coordinates in which a diagram is computed where those of the points are too large, too small or
//! too far from the origin.

use super::cell::Cell;
use crate::{geometry::vector, input::points::Points};

/// From this ratio of the largest coordinate to the extent on, coordinates are relative to a corner.
const FAR: f64 = (1u32 << 16) as f64;

/// Maps coordinates to smaller ones and back. Neither subtraction nor multiplication rounds the
/// coordinates of the points, unless they are 2⁹⁰⁰ times smaller than others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame<const D: usize> {
    origin: [f64; D],
    /// A power of two.
    scale: f64,
}

impl<const D: usize> Frame<D> {
    /// Returns the frame for points within these bounds; `None` if their coordinates are good as
    /// they are.
    pub(super) fn of(bounds: [[f64; D]; 2]) -> Option<Self> {
        let [low, high] = bounds;
        let scale = vector::scale_of(bounds);
        let most = |f: fn(f64, f64) -> f64| (0..D).map(|axis| f(low[axis], high[axis])).fold(0.0, f64::max);
        let extent = most(|low, high| high - low);
        let is_far = most(|low, high| low.abs().max(high.abs())) > FAR * extent;
        // The difference of numbers of which none is more than twice the other is exact.
        let is_exact = |axis: usize| {
            let (near, far) = (low[axis].abs().min(high[axis].abs()), low[axis].abs().max(high[axis].abs()));
            low[axis].signum() == high[axis].signum() && far / 2.0 <= near
        };
        let origin = std::array::from_fn(|axis| if is_far && is_exact(axis) { low[axis] } else { 0.0 });
        (scale != 1.0 || origin != [0.0; D]).then_some(Frame { origin, scale })
    }

    /// Returns the power of two that coordinates are multiplied by.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns a point in the frame.
    pub(super) fn inner(&self, p: [f64; D]) -> [f64; D] {
        std::array::from_fn(|axis| (p[axis] - self.origin[axis]) * self.scale)
    }

    /// Returns the points in the frame.
    pub(super) fn inner_points(&self, points: Points<'_, D>) -> Vec<[f64; D]> {
        points.iter().map(|p| self.inner(p)).collect()
    }

    /// Returns a point of the frame in the coordinates of the input.
    pub(super) fn outer(&self, p: [f64; D]) -> [f64; D] {
        std::array::from_fn(|axis| p[axis] / self.scale + self.origin[axis])
    }

    /// Returns the measure of something of `dimension` dimensions in units of the input. What is
    /// positive stays so, if need be as the smallest number.
    fn outer_measure(&self, measure: f64, dimension: usize) -> f64 {
        let outer = (0..dimension).fold(measure, |measure, _| measure / self.scale);
        if measure > 0.0 { outer.max(f64::from_bits(1)) } else { outer }
    }

    /// Gives a cell the coordinates and the units of the input.
    pub(super) fn restore(&self, cell: &mut Cell<D>) {
        cell.vertices.iter_mut().for_each(|vertex| *vertex = self.outer(*vertex));
        cell.areas.iter_mut().for_each(|area| *area = self.outer_measure(*area, D - 1));
        cell.volume = self.outer_measure(cell.volume, D);
        cell.centroid = self.outer(cell.centroid);
    }
}
