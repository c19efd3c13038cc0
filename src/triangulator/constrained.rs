//! Points with constraints.

use crate::{
    constrained::{Constrained2, Constraints, Split, Unconstrained, constrain},
    error::Error,
    input::points::Points2,
    options::Winding,
    triangulator::{Triangulator, wait::wait},
};

/// How often crossings are split: segments that cross many others are cut in several rounds, and rounding can make new
/// crossings.
const MAX_ROUNDS: usize = 100;

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
        let points = points.into();
        constraints.check(points.len())?;
        let mut triangulator = self.clone();
        triangulator.options.winding = Winding::CounterClockwise;
        let pairs = match constrain(triangulator.delaunay2d_async(points).await?, points, constraints) {
            Ok(found) => return Ok(found),
            Err(Unconstrained::Error(error)) => return Err(error),
            Err(Unconstrained::Crossings(pairs)) if !constraints.splits() => {
                return Err(constraints.crossing_error(&pairs));
            }
            Err(Unconstrained::Crossings(pairs)) => pairs,
        };
        triangulator.split(Split::new(points.iter().collect(), constraints.clone()), pairs).await
    }

    /// Triangulates anew with points where pairs of segments cross, until none does.
    async fn split(&self, mut split: Split, mut pairs: Vec<[u32; 2]>) -> Result<Constrained2, Error> {
        for _ in 0..MAX_ROUNDS {
            split.cut(&pairs);
            let points = Points2::F64(&split.points);
            match constrain(self.delaunay2d_async(points).await?, points, &split.constraints) {
                Ok(mut found) => {
                    found.added = split.points.split_off(split.given);
                    found.moved = split.moved;
                    return Ok(found);
                }
                Err(Unconstrained::Error(error)) => return Err(error),
                Err(Unconstrained::Crossings(left)) => pairs = left,
            }
        }
        Err(split.constraints.crossing_error(&pairs))
    }
}
