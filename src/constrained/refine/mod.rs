//! Refinement: points are added until no angle is small and no triangle large.
//!
//! Ruppert's algorithm (*A Delaunay refinement algorithm for quality 2-dimensional mesh generation*, 1995) with what came
//! after it: segments are kept free by lenses, and what is near them is removed when they are cut, as in Chew's second
//! algorithm (1993; Shewchuk, *Delaunay refinement algorithms for triangular mesh generation*, 2002); points are put at
//! off-centres (Üngör 2004); and what small angles between segments need is done as Miller, Pav and Walkington say
//! (*When and why Ruppert's algorithm works*, 2003).
//!
//! 1. `shape`: which triangles are bad, and where a point improves one;
//! 2. `pieces`: segments, the pieces that they are cut into, and angles between them;
//! 3. `queue`: in which order triangles are improved;
//! 4. `improve`: one after the other, in the triangles of `growing`;
//! 5. `finish`: the mesh, and statistics.
//!
//! Shapes are measured in floating point; signs are exact, so the mesh is always the constrained Delaunay triangulation
//! of its points and pieces. Points are rounded. One that cuts a segment is beside it then, and the segment has a bend
//! there.

mod finish;
mod improve;
mod pieces;
mod queue;
mod shape;

use super::{Constrained2, growing::Growing};
use crate::{error::Error, index::NONE, input::points::Points2};
use improve::Improver;

/// The largest smallest angle that can be asked for, in degrees.
const MAX_ANGLE: f64 = 34.0;

/// How large triangles may be: the length of their longest edge.
///
/// # Examples
///
/// ```
/// use gdel::{Constraints, RefineOptions, Size, Triangulator};
///
/// let points = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0f64]];
/// let found = Triangulator::new().constrained2d(&points, &Constraints::new())?;
/// let mut options = RefineOptions::default();
/// // Small on the left, ten times as large on the right.
/// let size = |[x, _]: [f64; 2]| 0.2 + 0.225 * x;
/// options.size = Size::Field(&size);
/// let refined = found.refine(&points, &options)?;
/// assert!(refined.stats.points_inside > 100);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Clone, Copy, Default)]
#[non_exhaustive]
pub enum Size<'a> {
    /// As large as angles allow.
    #[default]
    Any,
    /// The same everywhere.
    Uniform(f64),
    /// A length for each point, linear in the triangles between them.
    PerPoint(&'a [f64]),
    /// A length for each place, which is asked for at the centroids of triangles. Where it is not positive, there is no
    /// limit.
    Field(&'a (dyn Fn([f64; 2]) -> f64 + Sync)),
}

impl std::fmt::Debug for Size<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Size::Any => f.write_str("Any"),
            Size::Uniform(size) => f.debug_tuple("Uniform").field(size).finish(),
            Size::PerPoint(sizes) => f.debug_tuple("PerPoint").field(sizes).finish(),
            Size::Field(_) => f.write_str("Field(..)"),
        }
    }
}

/// What [`Constrained2::refine`] is to reach.
///
/// # Examples
///
/// ```
/// let mut options = gdel::RefineOptions::default();
/// options.min_angle = 30.0;
/// options.max_area = Some(0.5);
/// ```
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct RefineOptions<'a> {
    /// The smallest angle that triangles may have, in degrees, from 0 to 34; by default 20. It is proven to be reached up
    /// to 20.7, and in practice it is up to about 33.
    pub min_angle: f64,
    /// The largest area that triangles may have; by default any.
    pub max_area: Option<f64>,
    /// The longest edge that triangles may have; by default any.
    pub size: Size<'a>,
    /// The largest number of points that are added. By default there are as many as are needed, up to what indices can
    /// name.
    pub max_points: Option<usize>,
}

impl Default for RefineOptions<'_> {
    fn default() -> Self {
        RefineOptions { min_angle: 20.0, max_area: None, size: Size::Any, max_points: None }
    }
}

impl RefineOptions<'_> {
    /// Checks that the options are in their ranges, for a mesh with as many points.
    fn check(&self, points: usize) -> Result<(), Error> {
        let bad = |option, range| Err(Error::BadOption { option, range });
        let is_positive = |x: &f64| *x > 0.0 && x.is_finite();
        if !(0.0..=MAX_ANGLE).contains(&self.min_angle) {
            return bad("the smallest angle", "a number of degrees from 0 to 34");
        }
        if !self.max_area.iter().all(|area| *area > 0.0) {
            return bad("the largest area", "a positive number");
        }
        match self.size {
            Size::Uniform(size) if !is_positive(&size) => bad("the size", "a positive number"),
            Size::PerPoint(sizes) if sizes.len() != points => Err(Error::ValueCount { values: sizes.len(), points }),
            Size::PerPoint(sizes) if !sizes.iter().all(is_positive) => bad("sizes", "positive numbers"),
            _ => Ok(()),
        }
    }
}

/// Why triangles of a refined mesh are not as asked for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct RefineLeft {
    /// Triangles with a smaller angle where segments meet under one of less than 60°.
    pub input_angle: usize,
    /// Those with a smaller angle because coordinates are too coarse for more points there.
    pub resolution: usize,
    /// Those with a smaller angle because there were to be no more points.
    pub limit: usize,
    /// Triangles that are larger than asked for, for either of the last two reasons.
    pub too_large: usize,
}

/// What refinement has done.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct RefineStats {
    /// The number of points added on segments, the hull's edges included.
    pub points_on_segments: usize,
    /// The number of points added beside segments.
    pub points_inside: usize,
    /// The number of points that were added and removed again.
    pub removed: usize,
    /// The smallest angle of the triangles inside, in degrees; 0 if there are none.
    pub min_angle: f64,
    /// The triangles that are not as asked for.
    pub left: RefineLeft,
    /// Whether more points were needed than allowed.
    pub limited: bool,
}

/// A refined mesh.
///
/// # Examples
///
/// ```
/// use gdel::{Constraints, Fill, RefineOptions, Triangulator};
///
/// // An L.
/// let points = [[0.0, 0.0], [6.0, 0.0], [6.0, 1.0], [1.0, 1.0], [1.0, 6.0], [0.0, 6.0f64]];
/// let ring = Constraints::new().ring(&[0, 1, 2, 3, 4, 5]).fill(Fill::EvenOdd);
/// let found = Triangulator::new().constrained2d(&points, &ring)?;
/// let mut options = RefineOptions::default();
/// options.min_angle = 30.0;
/// let refined = found.refine(&points, &options)?;
/// assert!(refined.stats.min_angle >= 30.0);
/// // Each piece of the boundary knows its side.
/// let sides: Vec<u32> = refined.constrained.segments.iter().flatten().copied().collect();
/// assert_eq!((sides[0], refined.segment_of[0], refined.segment_of.last()), (0, 0, Some(&5)));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Refined2 {
    /// The mesh, with the pieces of the segments as constraints. Points that were [added](Constrained2::added) come after
    /// those that were given, and [`segments`](Constrained2::segments) are the pieces: those of each segment in its direction, then
    /// edges of the hull where it bounds what is inside.
    pub constrained: Constrained2,
    /// The segment that each piece is a part of, by its place in the segments of the mesh that was refined;
    /// [`NONE`](crate::NONE) for edges of the hull.
    pub segment_of: Vec<u32>,
    /// What was done, and what is left.
    pub stats: RefineStats,
}

impl Constrained2 {
    /// Returns the mesh with points added on segments and inside, until all triangles inside have the shape and size that
    /// are asked for, as far as angles between segments allow.
    ///
    /// `points` are those that the mesh was made of. The same input has the same result, whatever backend made the mesh. Where
    /// the hull bounds what is inside, its edges count as segments. A mesh without triangles is returned as it is.
    ///
    /// Every mesh is refined in finite time: points are never nearer than 64 units in the last place of their coordinates.
    /// But segments that almost touch need many points, so [`max_points`](RefineOptions::max_points) can set a limit; the
    /// mesh is valid when it is reached.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Constraints, RefineOptions, Triangulator, verify2d};
    ///
    /// let points = [[0.0, 0.0], [9.0, 0.0], [9.0, 1.0], [0.0, 1.0f64]];
    /// let found = Triangulator::new().constrained2d(&points, &Constraints::new())?;
    /// let refined = found.refine(&points, &RefineOptions::default())?;
    /// assert!(refined.stats.min_angle >= 20.0);
    /// let all = [&points[..], &refined.constrained.added].concat();
    /// assert!(verify2d(&all, &refined.constrained.mesh)?.passed());
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::BadOption`], [`Error::ValueCount`] if there is not one size per point, [`Error::PointCount`] and
    /// [`Error::BrokenMesh`] if the points are not those of the mesh, and [`Error::WeightedMesh`].
    pub fn refine<'p>(&self, points: impl Into<Points2<'p>>, options: &RefineOptions<'_>) -> Result<Refined2, Error> {
        let points = points.into();
        let expected = self.mesh.duplicate_of.len() - self.added.len().min(self.mesh.duplicate_of.len());
        if points.len() != expected {
            return Err(Error::PointCount { points: points.len(), expected });
        }
        if !self.mesh.weights.is_empty() {
            return Err(Error::WeightedMesh);
        }
        points.validate()?;
        let all: Vec<[f64; 2]> = points.iter().chain(self.added.iter().copied()).collect();
        let count = all.len();
        options.check(count)?;
        self.check_indices(count)?;
        if self.mesh.triangles.is_empty() {
            let segment_of = (0..self.segments.len() as u32).collect();
            return Ok(Refined2 { constrained: self.clone(), segment_of, stats: RefineStats::default() });
        }
        let mesh = Growing::new(&self.mesh, &self.inside, all)?;
        let mut improver = Improver::new(mesh, &self.mesh.constraints, options);
        improver.improve()?;
        Ok(finish::finish(&improver, self, count))
    }

    /// Checks that all lists name points.
    ///
    /// # Errors
    ///
    /// [`Error::BadConstraint`] or [`Error::BrokenMesh`].
    fn check_indices(&self, points: usize) -> Result<(), Error> {
        let is_point = |&v: &u32| (v as usize) < points;
        let constraints = self.segments.iter().chain(&self.mesh.constraints);
        if let Some(&segment) = constraints.clone().find(|ends| !ends.iter().all(is_point)) {
            return Err(Error::BadConstraint { segment, points });
        }
        let vertices = self.mesh.triangles.as_flattened().iter().chain(&self.mesh.duplicate_of);
        match vertices.filter(|&&v| v != NONE).all(is_point) {
            true => Ok(()),
            false => Err(Error::BrokenMesh { reason: "a vertex is not a point" }),
        }
    }
}
