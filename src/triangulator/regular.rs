//! Weighted points.

use crate::{
    backend::Backend,
    cpu::{self, MeshOf},
    d2::Mesh2,
    d3::Mesh3,
    dimension::Dimension,
    error::Error,
    input::points::{Points, Points2, Points3},
    mesh::MeshInfo,
    stats::Fallback,
    triangulator::{Choice, Triangulator, wait::wait},
};

impl Triangulator {
    /// Returns the regular triangulation of weighted points, the dual of their power diagram. A point with weight *w* is a
    /// ball of radius √*w*; what counts is the power distance, |x − p|² − *w*. Blocks the thread.
    ///
    /// It is unique like the Delaunay triangulation, which it is if all weights are equal; then
    /// [`Mesh3::weights`] is empty. Otherwise points can be [`hidden`](Mesh3::hidden), which are no vertices.
    /// Weights may be negative, and are taken at their exact values. So far the CPU computes it, and
    /// [`Stats::fallback`](crate::stats::Stats::fallback) says so if another backend was set.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::Triangulator;
    ///
    /// let mut points = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0f64]];
    /// points.push([1.0, 1.0, 1.0]);
    /// let triangulator = Triangulator::new();
    /// let mesh = triangulator.regular3d(&points, &[0.0, 0.0, 0.0, 0.0, 1.0])?;
    /// assert_eq!((mesh.tetrahedra.len(), mesh.hidden.len()), (4, 0));
    /// // The balls around the corners cover the small one's part of space.
    /// let mesh = triangulator.regular3d(&points, &[16.0, 16.0, 16.0, 16.0, 1.0])?;
    /// assert_eq!((mesh.tetrahedra.len(), mesh.hidden), (1, vec![4]));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](crate::delaunay3d), [`Error::ValueCount`] unless there is one weight per
    /// point, and [`Error::BadWeight`] if one is not finite.
    pub fn regular3d<'a>(&self, points: impl Into<Points3<'a>>, weights: &[f64]) -> Result<Mesh3, Error> {
        self.regular(points.into(), weights)
    }

    /// Returns the regular triangulation of weighted points in 2D, as [`regular3d`](Triangulator::regular3d) does in 3D.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::regular3d`].
    pub fn regular2d<'a>(&self, points: impl Into<Points2<'a>>, weights: &[f64]) -> Result<Mesh2, Error> {
        self.regular(points.into(), weights)
    }

    pub(super) fn regular<const D: usize>(&self, points: Points<'_, D>, weights: &[f64]) -> Result<MeshOf<D>, Error>
    where
        Dimension<D>: Choice<D>,
    {
        let mut mesh = MeshOf::<D>::default();
        if cpu::are_equal(points.len(), weights)? {
            wait(self.for_blocking()?.triangulate(points, &mut mesh))?;
        } else {
            mesh = cpu::regular(points, weights, &self.options)?;
            if self.options.backend != Backend::Cpu {
                mesh.stats_mut().fallback = Some(Fallback::Weights);
            }
        }
        Ok(mesh)
    }
}
