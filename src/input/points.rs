//! Input points: the forms in which they come, and their validation.

use crate::{
    error::Error,
    parallel::{self, Threads},
};

/// Borrowed input points of `D` coordinates each: `[x, y, z]` in 3D, `[x, y]` in 2D.
///
/// Every finite `f32` and `f64` is taken at its exact value. Slices, vectors and arrays of
/// `[f32; D]` and `[f64; D]` convert into it, so functions that take `impl Into<Points>` accept
/// them directly. The features `glam` and `nalgebra` add these crates' points and vectors, and
/// `ndarray` adds `TryFrom` for arrays with one point per row; none of them copies. For points of
/// type [`mint`](https://docs.rs/mint) see [`from_mint3`](crate::from_mint3).
///
/// # Examples
///
/// ```
/// use gdel::Points;
///
/// let points: Points<'_, 2> = (&[[0.0, 0.0], [1.0, 0.5f32]]).into();
/// assert_eq!((points.len(), points.get(1)), (2, [1.0, 0.5]));
/// ```
#[derive(Debug, Clone, Copy)]
pub enum Points<'a, const D: usize> {
    /// Single precision.
    F32(&'a [[f32; D]]),
    /// Double precision.
    F64(&'a [[f64; D]]),
}

/// Borrowed input points in 2D.
///
/// # Examples
///
/// ```
/// use gdel::Points2;
///
/// let points = Points2::from_interleaved_f64(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0])?;
/// assert_eq!(gdel::delaunay2d(points)?.triangles.len(), 1);
/// # Ok::<(), gdel::Error>(())
/// ```
pub type Points2<'a> = Points<'a, 2>;

/// Borrowed input points in 3D.
///
/// # Examples
///
/// ```
/// use gdel::Points3;
///
/// let coordinates = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
/// let points = Points3::from_interleaved_f64(&coordinates)?;
/// assert_eq!(gdel::delaunay3d(points)?.tetrahedra.len(), 1);
/// # Ok::<(), gdel::Error>(())
/// ```
pub type Points3<'a> = Points<'a, 3>;

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

    /// Returns an iterator over all points in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [f64; D]> + '_ {
        let points = *self;
        (0..self.len()).map(move |i| points.get(i))
    }

    /// Returns the lowest and the highest corner of the smallest box that contains all points;
    /// `None` if there are none.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = gdel::Points::F64(&[[0.0, 5.0], [2.0, 1.0]]);
    /// assert_eq!(points.bounds(), Some([[0.0, 1.0], [2.0, 5.0]]));
    /// ```
    pub fn bounds(&self) -> Option<[[f64; D]; 2]> {
        self.iter().fold(None, |bounds, p| {
            let [mut low, mut high] = bounds.unwrap_or([p, p]);
            for axis in 0..D {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
            Some([low, high])
        })
    }

    /// Returns the factors that give each axis the same weight: those that scale the extents to 1, and 1
    /// where there is no extent. They are for [`scaled`](Self::scaled).
    ///
    /// # Examples
    ///
    /// ```
    /// // Metres and seconds.
    /// let points = gdel::Points::F64(&[[0.0, 100.0], [4.0, 100.5], [8.0, 100.25]]);
    /// assert_eq!(points.unit_factors(), [0.125, 2.0]);
    /// ```
    pub fn unit_factors(&self) -> [f64; D] {
        let [low, high] = self.bounds().unwrap_or([[0.0; D]; 2]);
        std::array::from_fn(|axis| {
            let extent = high[axis] - low[axis];
            if extent > 0.0 { 1.0 / extent } else { 1.0 }
        })
    }

    /// Returns the points with each coordinate times the factor of its axis, rounded. What is nearest, and
    /// so the triangulation, depends on how axes of different units compare: triangulate scaled points, and
    /// scale queries by the same factors.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Interpolation, Interpolator, Locator, Points};
    ///
    /// let points = Points::F64(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1e6], [1.0, 1e6]]);
    /// let factors = points.unit_factors();
    /// let scaled = points.scaled(factors);
    /// let mesh = gdel::delaunay2d(&scaled)?;
    /// let locator = Locator::new(&mesh, &scaled)?;
    /// let interpolator = Interpolator::new(&locator, &[0.0, 1.0, 2.0, 3.0])?;
    /// let queries = Points::F64(&[[0.5, 5e5]]).scaled(factors);
    /// assert_eq!(interpolator.interpolate_many(Interpolation::Linear, &queries)?.values, [1.5]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn scaled(&self, factors: [f64; D]) -> Vec<[f64; D]> {
        self.iter().map(|p| std::array::from_fn(|axis| p[axis] * factors[axis])).collect()
    }

    /// Returns the lowest and the highest corner of the smallest box that contains all points, as
    /// [`bounds`](Self::bounds) does, by `threads`; infinite ones the other way round if there are
    /// no points.
    ///
    /// # Errors
    ///
    /// Returns [`Error::NotFinite`] with the first point that has a coordinate that is not.
    pub(crate) fn finite_bounds(&self, threads: Threads) -> Result<[[f64; D]; 2], Error> {
        self.bounds_of(parallel::map_ranges(threads, self.len(), |range| self.range(range).box_of_all()), threads)
    }

    /// Returns the box of all points, in an array of three dimensions.
    fn box_of_all(&self) -> Box3 {
        match self {
            Points::F32(p) => box_of_f32(p.as_flattened(), D),
            Points::F64(p) => box_of_f64(p.as_flattened(), D),
        }
    }

    /// Returns the bounds of all points, given those of parts of them.
    fn bounds_of(&self, parts: Vec<Box3>, threads: Threads) -> Result<[[f64; D]; 2], Error> {
        if parts.iter().any(|&(_, is_finite)| !is_finite) {
            self.validate_by(threads)?;
        }
        let none = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
        Ok(parts.into_iter().fold(none, |[low, high], ([l, h], _)| {
            [std::array::from_fn(|a| low[a].min(l[a])), std::array::from_fn(|a| high[a].max(h[a]))]
        }))
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
        let bad = parallel::map_ranges(threads, self.len(), |range| {
            let start = range.start;
            let at = match self.range(range) {
                Points::F32(p) => p.iter().position(|p| !p.iter().all(|x| x.is_finite())),
                Points::F64(p) => p.iter().position(|p| !p.iter().all(|x| x.is_finite())),
            };
            at.map(|i| start + i)
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

/// The box of some points, of which the third axis has no meaning in 2D, and whether all
/// coordinates are finite.
type Box3 = ([[f64; 3]; 2], bool);

/// Returns the box of points in `D` ≤ 3 dimensions.
///
/// The comparisons stand for `f64::min` and `f64::max`, which take WebAssembly longer, since they
/// are exact about NaN. Most points are inside the box of those before them: to check that first, as
/// `checks_first` says, saves half of the time where the compiler does not use vectors. A difference has
/// the sign of the exact one, and so has a product that is positive; one that underflows, or is NaN,
/// decides nothing.
#[inline(always)]
fn box_in<T: Copy + Into<f64>, const D: usize>(coordinates: &[T]) -> Box3 {
    let points = coordinates.as_chunks::<D>().0;
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    let mut zero = [0.0; 3];
    for p in points {
        for axis in 0..D {
            let x: f64 = p[axis].into();
            low[axis] = if x < low[axis] { x } else { low[axis] };
            high[axis] = if x > high[axis] { x } else { high[axis] };
            // NaN from the first coordinate on that is not finite.
            zero[axis] += 0.0 * x;
        }
    }
    ([low, high], zero == [0.0; 3])
}

/// Returns the box of points whose coordinates are in double precision.
///
/// Not generic over the dimension, as generic functions are compiled with the crate that calls them,
/// which in WebAssembly is optimised for size.
fn box_of_f64(coordinates: &[f64], dimension: usize) -> Box3 {
    if dimension == 3 { box_in::<f64, 3>(coordinates) } else { box_in::<f64, 2>(coordinates) }
}

/// Returns the box of points whose coordinates are in single precision.
fn box_of_f32(coordinates: &[f32], dimension: usize) -> Box3 {
    if dimension == 3 { box_in::<f32, 3>(coordinates) } else { box_in::<f32, 2>(coordinates) }
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
from_slices!([f32; 2] => F32, 2; [f64; 2] => F64, 2; [f32; 3] => F32, 3; [f64; 3] => F64, 3);
#[cfg(feature = "glam")]
from_slices!(glam::Vec2 => F32, 2; glam::DVec2 => F64, 2; glam::Vec3 => F32, 3; glam::DVec3 => F64, 3);
#[cfg(feature = "nalgebra")]
from_slices!(
    nalgebra::Point2<f32> => F32, 2; nalgebra::Point2<f64> => F64, 2;
    nalgebra::Point3<f32> => F32, 3; nalgebra::Point3<f64> => F64, 3;
    nalgebra::Vector2<f32> => F32, 2; nalgebra::Vector2<f64> => F64, 2;
    nalgebra::Vector3<f32> => F32, 3; nalgebra::Vector3<f64> => F64, 3
);

#[cfg(feature = "ndarray")]
mod arrays {
    use super::{Points, whole_points};
    use crate::error::Error;
    use ndarray::{ArrayBase, ArrayView2, Data, Ix2};

    /// Returns the rows of an array that lie in memory one after the other.
    fn rows<'a, T, const D: usize>(array: ArrayView2<'a, T>) -> Result<&'a [[T; D]], Error> {
        let (rows, columns) = array.dim();
        if columns != D {
            return Err(Error::ArrayShape { rows, columns, dimension: D });
        }
        whole_points(array.to_slice().ok_or(Error::ArrayLayout)?)
    }

    /// The types of coordinates.
    pub trait Coordinate: Sized {
        fn points<const D: usize>(points: &[[Self; D]]) -> Points<'_, D>;
    }

    impl Coordinate for f32 {
        fn points<const D: usize>(points: &[[f32; D]]) -> Points<'_, D> {
            Points::F32(points)
        }
    }

    impl Coordinate for f64 {
        fn points<const D: usize>(points: &[[f64; D]]) -> Points<'_, D> {
            Points::F64(points)
        }
    }

    /// Takes one point per row, without a copy.
    ///
    /// Fails with [`Error::ArrayShape`] or [`Error::ArrayLayout`] if the rows are not contiguous
    /// points.
    impl<'a, T: Coordinate, const D: usize> TryFrom<ArrayView2<'a, T>> for Points<'a, D> {
        type Error = Error;

        fn try_from(array: ArrayView2<'a, T>) -> Result<Self, Error> {
            rows(array).map(T::points)
        }
    }

    /// Takes one point per row, without a copy.
    ///
    /// Fails with [`Error::ArrayShape`] or [`Error::ArrayLayout`] if the rows are not contiguous
    /// points.
    impl<'a, T: Coordinate, S: Data<Elem = T>, const D: usize> TryFrom<&'a ArrayBase<S, Ix2>> for Points<'a, D> {
        type Error = Error;

        fn try_from(array: &'a ArrayBase<S, Ix2>) -> Result<Self, Error> {
            rows(array.view()).map(T::points)
        }
    }
}

/// Copies 3D points of any type that converts into [`mint::Point3`], the type through which
/// mathematics libraries exchange points.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// let points = points.map(mint::Point3::from);
/// let mesh = gdel::delaunay3d(&gdel::from_mint3(points))?;
/// assert_eq!(mesh.tetrahedra.len(), 1);
/// # Ok::<(), gdel::Error>(())
/// ```
#[cfg(feature = "mint")]
pub fn from_mint3<T>(points: impl IntoIterator<Item = impl Into<mint::Point3<T>>>) -> Vec<[T; 3]> {
    points.into_iter().map(|point| point.into().into()).collect()
}

/// Copies 2D points of any type that converts into [`mint::Point2`], the type through which
/// mathematics libraries exchange points.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]].map(mint::Point2::from);
/// let mesh = gdel::delaunay2d(&gdel::from_mint2(points))?;
/// assert_eq!(mesh.triangles.len(), 1);
/// # Ok::<(), gdel::Error>(())
/// ```
#[cfg(feature = "mint")]
pub fn from_mint2<T>(points: impl IntoIterator<Item = impl Into<mint::Point2<T>>>) -> Vec<[T; 2]> {
    points.into_iter().map(|point| point.into().into()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::{collection::vec, prelude::*};

    fn check<const D: usize>(points: Points<'_, D>) -> Result<(), TestCaseError> {
        let none = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
        let expected = points.validate().map(|()| points.bounds().unwrap_or(none));
        prop_assert_eq!(points.finite_bounds(Threads::All), expected.clone());
        Ok(())
    }

    proptest! {
        #[test]
        fn finite_bounds_are_bounds_of_valid_points(
            mut coordinates in vec(-10i8..10, 0..40),
            bad in proptest::option::of((0usize..40, prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY]))),
        ) {
            coordinates.truncate(coordinates.len() / 6 * 6);
            let mut single: Vec<f32> = coordinates.iter().map(|&x| f32::from(x)).collect();
            if let Some((i, value)) = bad && let Some(x) = single.get_mut(i) {
                *x = value;
            }
            let double: Vec<f64> = single.iter().map(|&x| x.into()).collect();
            check(Points::<3>::from_interleaved_f32(&single).unwrap())?;
            check(Points::<2>::from_interleaved_f32(&single).unwrap())?;
            check(Points::<3>::from_interleaved_f64(&double).unwrap())?;
            check(Points::<2>::from_interleaved_f64(&double).unwrap())?;
        }

        #[test]
        fn finite_bounds_of_extreme_coordinates(
            mut coordinates in vec(prop::sample::select(vec![
                0.0, -0.0, 5e-324, -5e-324, 1e-200, -1e-200, 1.0, f64::MAX, f64::MIN, f64::NAN, f64::INFINITY,
            ]), 0..40),
            is_finite in any::<bool>(),
        ) {
            coordinates.retain(|x| x.is_finite() || !is_finite);
            coordinates.truncate(coordinates.len() / 6 * 6);
            check(Points::<3>::from_interleaved_f64(&coordinates).unwrap())?;
            check(Points::<2>::from_interleaved_f64(&coordinates).unwrap())?;
        }
    }
}
