//! Input points: the forms in which they come, and their validation.

use crate::{
    Error,
    parallel::{self, Threads},
};

/// Borrowed input points of `D` coordinates each: `[x, y, z]`, or `[x, y]` in 2D. Every finite
/// `f32` and `f64` is taken at its exact value.
#[derive(Debug, Clone, Copy)]
pub enum Points<'a, const D: usize = 3> {
    /// Single precision.
    F32(&'a [[f32; D]]),
    /// Double precision.
    F64(&'a [[f64; D]]),
}

/// Borrowed 2D input points.
pub type Points2<'a> = Points<'a, 2>;

impl<'a, const D: usize> Points<'a, D> {
    /// Borrows points from x, y, z, x, y, z, …, or from x, y, x, y, … in 2D.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotWholePoints`] if the length is not a multiple of `D`.
    pub fn from_interleaved_f32(coordinates: &'a [f32]) -> Result<Self, Error> {
        whole_points(coordinates).map(Points::F32)
    }

    /// Borrows points from x, y, z, x, y, z, …, or from x, y, x, y, … in 2D.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotWholePoints`] if the length is not a multiple of `D`.
    pub fn from_interleaved_f64(coordinates: &'a [f64]) -> Result<Self, Error> {
        whole_points(coordinates).map(Points::F64)
    }

    /// Returns the number of points, duplicates included.
    pub fn len(&self) -> usize {
        match self {
            Points::F32(p) => p.len(),
            Points::F64(p) => p.len(),
        }
    }

    /// Returns whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the exact coordinates of point `i`.
    ///
    /// # Panics
    ///
    /// Panics if `i` is not below [`len`](Self::len).
    #[inline]
    pub fn get(&self, i: usize) -> [f64; D] {
        match self {
            Points::F32(p) => p[i].map(f64::from),
            Points::F64(p) => p[i],
        }
    }

    /// Returns the points with the indices in `range`.
    ///
    /// # Panics
    ///
    /// Panics if `range` does not lie within the points.
    pub(crate) fn range(&self, range: std::ops::Range<usize>) -> Points<'a, D> {
        match self {
            Points::F32(p) => Points::F32(&p[range]),
            Points::F64(p) => Points::F64(&p[range]),
        }
    }

    /// Iterates over all points in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [f64; D]> + '_ {
        let points = *self;
        (0..self.len()).map(move |i| points.get(i))
    }

    /// Checks that every coordinate is a finite number.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotFinite`] with the first point that has a coordinate that is not.
    pub fn validate(&self) -> Result<(), Error> {
        self.validate_by(Threads::One)
    }

    /// Checks that every coordinate is a finite number, by `threads`.
    pub(crate) fn validate_by(&self, threads: Threads) -> Result<(), Error> {
        let is_finite = |p: &[f64; D]| p.iter().all(|x| x.is_finite());
        let bad = parallel::map_ranges(threads, self.len(), |range| {
            let start = range.start;
            self.range(range).iter().position(|p| !is_finite(&p)).map(|i| start + i)
        });
        let Some(index) = bad.into_iter().flatten().next() else { return Ok(()) };
        let p = self.get(index);
        let axis = (0..D).find(|&axis| !p[axis].is_finite()).unwrap_or(0);
        let value = match p[axis] {
            v if v.is_nan() => "NaN",
            v if v > 0.0 => "inf",
            _ => "-inf",
        };
        Err(Error::NotFinite { index, axis: ['x', 'y', 'z'][axis], value })
    }
}

fn whole_points<T, const D: usize>(coordinates: &[T]) -> Result<&[[T; D]], Error> {
    let (points, rest) = coordinates.as_chunks::<D>();
    if rest.is_empty() { Ok(points) } else { Err(Error::NotWholePoints { length: coordinates.len(), dimension: D }) }
}

macro_rules! from_slices {
    ($($element:ty => $variant:ident, $dimension:literal);*) => {$(
        impl<'a> From<&'a [$element]> for Points<'a, $dimension> {
            fn from(points: &'a [$element]) -> Self {
                Points::$variant(bytemuck::cast_slice(points))
            }
        }
        impl<'a> From<&'a Vec<$element>> for Points<'a, $dimension> {
            fn from(points: &'a Vec<$element>) -> Self {
                points.as_slice().into()
            }
        }
        impl<'a, const N: usize> From<&'a [$element; N]> for Points<'a, $dimension> {
            fn from(points: &'a [$element; N]) -> Self {
                points.as_slice().into()
            }
        }
    )*};
}
from_slices!(
    [f32; 3] => F32, 3; [f64; 3] => F64, 3; glam::Vec3 => F32, 3; glam::DVec3 => F64, 3;
    [f32; 2] => F32, 2; [f64; 2] => F64, 2; glam::Vec2 => F32, 2; glam::DVec2 => F64, 2
);
