//! Updates of meshes, and points that are inserted and removed.

use crate::{
    error::Error,
    input::points::Points,
    triangulator::{
        Triangulator,
        editable::{Editable, check_count},
        wait::wait,
    },
};
use std::ops::Range;

impl Triangulator {
    /// Makes `mesh` the Delaunay triangulation of `points`: those of the mesh, after they have
    /// moved. Blocks the thread. A mesh of weighted points becomes their regular triangulation with the same weights.
    ///
    /// The mesh is that of a run from scratch, except for the order of its simplices: also where
    /// points have become equal or coplanar, have left the hull, or are no duplicates any more.
    /// A mesh on the device is repaired there where that is faster. Otherwise the points are
    /// triangulated from scratch, and [`Stats::update`](crate::stats::Stats::update) says why.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let mut points: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i * i % 101), f64::from(i)]).collect();
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// for (i, [x, y]) in points.iter_mut().enumerate() {
    ///     *x += 0.1 * (i as f64).sin();
    ///     *y += 0.1 * (i as f64).cos();
    /// }
    /// triangulator.update(&mut mesh, &points)?;
    /// assert_eq!(mesh.canonical(), gdel::delaunay2d(&points)?.canonical());
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], and [`Error::PointCount`] if the mesh is
    /// not one of as many points, and [`Error::ConstrainedMesh`] if it has constraints. After an error the mesh is what it
    /// was before.
    pub fn update<'a, const D: usize, M: Editable<D>>(
        &self,
        mesh: &mut M,
        points: impl Into<Points<'a, D>>,
    ) -> Result<(), Error> {
        wait(mesh.update(&self.for_blocking()?, points.into()))
    }

    /// Does the same as [`update`](Triangulator::update) without blocking the thread while the GPU
    /// works.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::update`].
    pub async fn update_async<'a, const D: usize, M: Editable<D>>(
        &self,
        mesh: &mut M,
        points: impl Into<Points<'a, D>>,
    ) -> Result<(), Error> {
        mesh.update(self, points.into()).await
    }

    /// Makes `mesh`, which is one of `points`, their [regular triangulation](Triangulator::regular3d) for other weights,
    /// or for the first ones. The points may have moved. Blocks the thread.
    ///
    /// So far the points are triangulated from scratch, which takes as long as it did before. Points that the old
    /// weights hid come back, and with equal weights the mesh is the Delaunay triangulation again.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [2.0, 1.0f64]];
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let mut mesh = triangulator.regular2d(&points, &[0.0, 0.0, 0.0, 0.0, -9.0])?;
    /// assert_eq!(mesh.hidden, [4]);
    /// triangulator.update_weights(&mut mesh, &points, &[0.0, 0.0, 0.0, 0.0, 1.0])?;
    /// assert_eq!((mesh.triangles.len(), mesh.hidden.len()), (4, 0));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::regular3d`], and [`Error::PointCount`] if the mesh is not one of as many
    /// points, [`Error::ConstrainedMesh`] if it has constraints, and [`Error::WeightedMesh`] if points were removed from
    /// it, or if it is on a device. After an error the mesh is what it was before.
    pub fn update_weights<'a, const D: usize, M: Editable<D>>(
        &self,
        mesh: &mut M,
        points: impl Into<Points<'a, D>>,
        weights: &[f64],
    ) -> Result<(), Error> {
        mesh.update_weights(self, points.into(), weights)
    }

    /// Inserts the points `new` into a mesh, and appends them to `points`, which are those of the
    /// mesh. Returns their indices. Blocks the thread.
    ///
    /// The mesh is that of a run from scratch, except for the order of its simplices: also where new
    /// points lie outside the hull, equal others, or are the first that do not lie in a plane.
    ///
    /// To insert a few points takes time for what changes around them, and for one look at the
    /// coordinates of all. Where it is faster (with one thread, beyond about one point in forty), the
    /// points are triangulated from scratch by the backend, and
    /// [`Stats::update`](crate::stats::Stats::update) says why. The mesh has to be that of its points:
    /// only what is near the new ones is checked. A mesh on the device is read, changed by the host,
    /// and uploaded.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let mut points = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0f64]];
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// let inserted = triangulator.insert(&mut mesh, &mut points, &[[1.0, 1.0], [2.0, 2.0]])?;
    /// assert_eq!((inserted, points.len()), (4..6, 6));
    /// assert_eq!(mesh.canonical(), gdel::delaunay2d(&points)?.canonical());
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], and [`Error::PointCount`] if the mesh is not
    /// one of as many `points`, and [`Error::WeightedMesh`] or [`Error::ConstrainedMesh`] if it is
    /// not a Delaunay triangulation. After an error the mesh and `points` are what they were before.
    pub fn insert<const D: usize, T: Copy, M: Editable<D>>(
        &self,
        mesh: &mut M,
        points: &mut Vec<[T; D]>,
        new: &[[T; D]],
    ) -> Result<Range<u32>, Error>
    where
        for<'p> Points<'p, D>: From<&'p [[T; D]]>,
    {
        wait(self.for_blocking()?.insert_async(mesh, points, new))
    }

    /// Does the same as [`insert`](Triangulator::insert) without blocking the thread while the GPU
    /// works.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::insert`].
    pub async fn insert_async<const D: usize, T: Copy, M: Editable<D>>(
        &self,
        mesh: &mut M,
        points: &mut Vec<[T; D]>,
        new: &[[T; D]],
    ) -> Result<Range<u32>, Error>
    where
        for<'p> Points<'p, D>: From<&'p [[T; D]]>,
    {
        check_count(mesh, points.len())?;
        let first = points.len();
        let appended = Appended { points, first };
        appended.points.extend_from_slice(new);
        mesh.edit(self, appended.points.as_slice().into(), &[]).await?;
        Ok(appended.keep())
    }

    /// Removes the points with these indices from a mesh, which is one of `points`. Blocks the thread.
    ///
    /// The mesh is that of a run from scratch on the points that are left, except for the order of its
    /// simplices; if the removed point stood for others, the lowest of these takes its place. All
    /// points keep their indices. Those that were removed are *unused*: in
    /// [`duplicate_of`](crate::Mesh3::duplicate_of) they are their own duplicates. Their coordinates have to
    /// be finite, and nothing else depends on them. Later calls of [`update`](Triangulator::update),
    /// [`insert`](Triangulator::insert) and `remove` leave them unused. [`Mesh3::compact`](crate::Mesh3::compact) drops them.
    ///
    /// What it costs, and when it is done from scratch, is as for [`insert`](Triangulator::insert).
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator, stats::Restart};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [2.0, 1.0f64]];
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// triangulator.remove(&mut mesh, &points, &[4])?;
    /// assert_eq!((mesh.triangles.len(), mesh.is_unused(4)), (2, true));
    /// assert_eq!(mesh.stats.update.map(|update| (update.removed, update.restarted)), Some((1, None)));
    /// // What is left has no triangles.
    /// triangulator.remove(&mut mesh, &points, &[0, 1])?;
    /// assert_eq!((mesh.triangles.len(), mesh.dimension, mesh.hull.as_slice()), (0, 1, &[3, 2][..]));
    /// assert_eq!(mesh.stats.update.and_then(|update| update.restarted), Some(Restart::Degenerate));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`], [`Error::PointCount`] if the mesh is not
    /// one of as many points, and [`Error::BadIndex`] if an index is not below their number, is given
    /// twice, or was removed before; [`Error::WeightedMesh`] or [`Error::ConstrainedMesh`] if the
    /// mesh is not a Delaunay triangulation. After an error the mesh is what it was before.
    pub fn remove<'a, const D: usize, M: Editable<D>>(
        &self,
        mesh: &mut M,
        points: impl Into<Points<'a, D>>,
        indices: &[u32],
    ) -> Result<(), Error> {
        wait(self.for_blocking()?.remove_async(mesh, points, indices))
    }

    /// Does the same as [`remove`](Triangulator::remove) without blocking the thread while the GPU
    /// works.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::remove`].
    pub async fn remove_async<'a, const D: usize, M: Editable<D>>(
        &self,
        mesh: &mut M,
        points: impl Into<Points<'a, D>>,
        indices: &[u32],
    ) -> Result<(), Error> {
        let points = points.into();
        check_count(mesh, points.len())?;
        mesh.edit(self, points, indices).await
    }
}

/// Points with new ones at the end, which are taken off again unless they are kept.
struct Appended<'a, T> {
    points: &'a mut Vec<T>,
    first: usize,
}

impl<T> Appended<'_, T> {
    /// Keeps the new points. Returns their indices.
    fn keep(mut self) -> Range<u32> {
        let first = std::mem::replace(&mut self.first, self.points.len());
        first as u32..self.points.len() as u32
    }
}

impl<T> Drop for Appended<'_, T> {
    fn drop(&mut self) {
        self.points.truncate(self.first);
    }
}
