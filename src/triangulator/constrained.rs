//! Points with constraints.

use crate::{
    constrained::{Constrained2, Constraining, Constraints},
    error::Error,
    input::points::Points2,
    options::Winding,
    triangulator::{Triangulator, wait::wait},
};

impl Triangulator {
    /// Returns the constrained Delaunay triangulation of `points`: the one that has the constraints as edges, and whose
    /// other edges are locally Delaunay. Blocks the thread.
    ///
    /// It is unique, whatever the order of the constraints, and without any it is the
    /// [Delaunay triangulation](Triangulator::delaunay2d). A segment that leads through a point is two segments there,
    /// exactly. Segments may overlap, and may be given several times. The ends of a segment may be duplicates of other
    /// points. The backend makes the triangulation of the points; the host inserts the segments.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Constraints, Fill, Triangulator};
    ///
    /// // A square with a square hole, and a point in the hole.
    /// let mut points = vec![[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0f64]];
    /// points.extend([[3.0, 3.0], [6.0, 3.0], [6.0, 6.0], [3.0, 6.0], [5.0, 5.0]]);
    /// let constraints = Constraints::new().ring(&[0, 1, 2, 3]).ring(&[4, 5, 6, 7]).fill(Fill::EvenOdd);
    /// let found = Triangulator::new().constrained2d(&points, &constraints)?;
    /// assert_eq!((found.mesh.triangles.len(), found.inside_triangles().count()), (12, 8));
    /// assert!(found.mesh.is_constrained([4, 7]));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay2d`](crate::delaunay2d), [`Error::BadConstraint`] for an index that is not that
    /// of a point, [`Error::CrossingConstraints`] if segments cross where there is no point, and [`Error::OpenBoundary`]
    /// where a fill rule needs closed boundaries.
    pub fn constrained2d<'a>(
        &self,
        points: impl Into<Points2<'a>>,
        constraints: &Constraints,
    ) -> Result<Constrained2, Error> {
        wait(self.for_blocking()?.constrained2d_async(points, constraints))
    }

    /// Does the same as [`constrained2d`](Triangulator::constrained2d) without blocking the thread while the GPU works.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::constrained2d`].
    pub async fn constrained2d_async<'a>(
        &self,
        points: impl Into<Points2<'a>>,
        constraints: &Constraints,
    ) -> Result<Constrained2, Error> {
        let mut triangulator = self.clone();
        triangulator.options.winding = Winding::CounterClockwise;
        let mut left = Constraining::new(points.into(), constraints, self.options.threads)?;
        loop {
            let mesh = triangulator.delaunay2d_async(left.points()).await?;
            if let Some(found) = left.constrain(mesh)? {
                return Ok(found);
            }
        }
    }
}
