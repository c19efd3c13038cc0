//! Weights with which cells have given volumes.

use crate::{
    derived::{Clip, Transport, TransportOptions, transport},
    error::Error,
    input::points::{Points2, Points3},
    triangulator::Triangulator,
};

impl Triangulator {
    /// Finds the weights with which each point's cell of the power diagram has a given volume: its mass. The cells are
    /// the parts of the shape that go to the points if it is divided among them at the least sum of squared distances
    /// (semi-discrete optimal transport). Blocks the thread.
    ///
    /// The volumes are as exact as [`TransportOptions::tolerance`] demands. They are those that [`Voronoi`](crate::Voronoi)
    /// has for the [regular triangulation](Triangulator::regular3d) with these weights. Points may be outside the shape, in
    /// a plane or on a line. Equal points share a cell, and count as one with the sum of their masses. Weights are unique
    /// up to a constant, and the same for any number of threads; the least is 0. So far the CPU does all of it. Progress
    /// is that of the logarithm of the error, in the phase [`Transport`](crate::stats::Phase::Transport).
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Clip, TransportOptions, Triangulator, Voronoi};
    ///
    /// let points = [[0.1, 0.1, 0.2], [0.9, 0.2, 0.1], [0.2, 0.8, 0.3], [0.3, 0.3, 0.9], [0.8, 0.7, 0.8f64]];
    /// let clip = Clip::Box([[0.0; 3], [1.0; 3]]);
    /// let mut options = TransportOptions::default();
    /// options.masses = Some(&[0.1, 0.1, 0.2, 0.2, 0.4]);
    /// let triangulator = Triangulator::new();
    /// let found = triangulator.transport3d(&points, clip, &options)?;
    ///
    /// let mesh = triangulator.regular3d(&points, &found.weights)?;
    /// let volumes = Voronoi::new(&mesh, &points, clip)?.volumes();
    /// assert!((volumes[1] - 0.1).abs() < 1e-4 && (volumes[4] - 0.4).abs() < 4e-4);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`delaunay3d`](crate::delaunay3d) and [`Voronoi::new`](crate::Voronoi::new);
    /// [`Error::ValueCount`] unless there is one mass per point, [`Error::BadMass`] if one is not positive,
    /// [`Error::MassSum`] if their sum is not the volume of the shape; [`Error::BadOption`] for [`Clip::None`], a tolerance
    /// that is not between 0 and 1, and coordinates whose squares are out of range; [`Error::TransportStopped`] if
    /// rounding keeps cells from being as exact as that.
    pub fn transport3d<'a>(
        &self,
        points: impl Into<Points3<'a>>,
        clip: Clip<'_, 3>,
        options: &TransportOptions<'_>,
    ) -> Result<Transport, Error> {
        transport(points.into(), clip, options, &self.options)
    }

    /// Finds the weights with which each point's cell has a given area, as [`transport3d`](Triangulator::transport3d) does
    /// in 3D.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::transport3d`].
    pub fn transport2d<'a>(
        &self,
        points: impl Into<Points2<'a>>,
        clip: Clip<'_, 2>,
        options: &TransportOptions<'_>,
    ) -> Result<Transport, Error> {
        transport(points.into(), clip, options, &self.options)
    }
}
