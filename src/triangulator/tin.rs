//! Terrain.

use crate::{
    constrained::{Constraints, Tin, TinOptions, tin},
    error::Error,
    input::points::Points3,
    triangulator::Triangulator,
};

impl Triangulator {
    /// Returns the terrain of points: a surface of triangles between as few of them as it takes for all to be near to it,
    /// above or below. Blocks the thread.
    ///
    /// The surface begins with the corners of the convex hull, as seen from above, and with the ends of the segments, which
    /// become edges: breaklines, such as the crest of a dam. Then the point that is farthest from it becomes a vertex, until
    /// none is farther than [`TinOptions::max_error`] or there are [`TinOptions::max_points`] vertices (greedy insertion:
    /// Garland and Heckbert 1997). As seen from above it is always the constrained Delaunay triangulation of its vertices,
    /// exactly. Distances are vertical, and as exact as floating point.
    ///
    /// Of points with the same x and y, one counts: an end of a segment if there is one, and of several the lowest, since
    /// what a scanner has seen above the ground is not the ground. Points outside the boundaries, as the fill rule says,
    /// do not count; neither do points on one line, which have no triangles. The result is the same for any number of
    /// threads. So far the CPU does all of it. Progress is that of the logarithm of the error, in the phase
    /// [`Tin`](crate::stats::Phase::Tin).
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Constraints, TinOptions, Triangulator};
    ///
    /// // Hills, by ten thousand points, and a road across them.
    /// let hills = |x: f64, y: f64| (x / 9.0).sin() * (y / 14.0).cos();
    /// let mut points: Vec<[f64; 3]> = (0..10_000)
    ///     .map(|i| [f64::from(i % 100), f64::from(i / 100)])
    ///     .map(|[x, y]| [x, y, hills(x, y)])
    ///     .collect();
    /// points.extend([[3.5, 8.5, 0.5], [90.5, 70.5, 0.5]]);
    /// let road = Constraints::new().edges(&[[10_000, 10_001]]);
    /// let mut options = TinOptions::default();
    /// options.max_error = 0.05;
    /// let tin = Triangulator::new().tin(&points, &road, &options)?;
    /// assert!(tin.max_error <= 0.05 && tin.vertices.len() < 3000);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`], [`Error::TooManyPoints`], [`Error::BadOption`] if the error is negative or NaN,
    /// [`Error::Cancelled`], and the errors of constraints that [`constrained2d`](Triangulator::constrained2d) returns.
    pub fn tin<'a>(
        &self,
        points: impl Into<Points3<'a>>,
        constraints: &Constraints,
        options: &TinOptions,
    ) -> Result<Tin, Error> {
        tin(points.into(), constraints, options, &self.options)
    }
}
