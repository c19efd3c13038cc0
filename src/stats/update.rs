//! Statistics of updates, insertions and removals.

use crate::fields::{Field, Value, with_fields};

with_fields! {
    /// What an update, an insertion or a removal did to make a mesh from the one before.
    ///
    /// # Examples
    ///
    /// ```
    /// use gdel::{Backend, Triangulator};
    ///
    /// let triangulator = Triangulator::new().backend(Backend::Cpu);
    /// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.5], [0.0, 1.0], [1.0, 0.5f64]];
    /// let mut mesh = triangulator.delaunay2d(&points)?;
    /// triangulator.remove(&mut mesh, &points, &[4])?;
    /// let update = mesh.stats.update.expect("the mesh was changed");
    /// assert_eq!((update.removed, update.inserted, update.restarted), (1, 0, None));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
    #[cfg_attr(feature = "serde", derive(serde::Serialize))]
    #[non_exhaustive]
    pub struct UpdateStats {
        /// The number of tetrahedra, or triangles in 2D, that were flat or inverted at the new
        /// points. Like the next three, it is counted by updates of meshes on a device.
        pub inverted: usize,
        /// The number of facets, or edges in 2D, that were not locally Delaunay there.
        pub not_locally_delaunay: usize,
        /// The number of flips.
        pub flips: u64,
        /// The number of stars that were made convex; 3D only.
        pub stars: usize,
        /// The number of vertices that were removed because their points were.
        pub removed: usize,
        /// The number of points that were inserted: new ones, and former duplicates.
        pub inserted: usize,
        /// Whether a mesh on the device was read, changed on the host, and uploaded.
        pub on_host: bool,
        /// Why the points were triangulated from scratch, if they were. On a device, after two such
        /// updates in a row, only every fourth looks at the mesh; the others have the reason of the one
        /// before.
        pub restarted: Option<Restart>,
    }
}

impl UpdateStats {
    /// Returns the statistics of a run from scratch.
    pub(crate) fn from_scratch(why: Restart) -> Self {
        UpdateStats { restarted: Some(why), ..UpdateStats::default() }
    }
}

/// Why the points of a mesh were triangulated from scratch, and the mesh not changed.
///
/// # Examples
///
/// ```
/// use gdel::{Backend, Triangulator, stats::Restart};
///
/// let triangulator = Triangulator::new().backend(Backend::Cpu);
/// let mut mesh = triangulator.delaunay2d(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]])?;
/// triangulator.update(&mut mesh, &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0f64]])?;
/// // Only meshes on a device are repaired.
/// assert_eq!(mesh.stats.update.and_then(|update| update.restarted), Some(Restart::NotResident));
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum Restart {
    /// The points span fewer dimensions, or did before.
    #[error("the points span fewer dimensions, or did before")]
    Degenerate,
    /// More simplices are flat or inverted at the new points than it pays to repair.
    #[error("too many simplices are inverted")]
    Inverted,
    /// More has changed for other reasons than it pays to repair.
    #[error("too much has changed")]
    Changed,
    /// The repair did not lead to the Delaunay triangulation.
    #[error("flips and star splaying do not lead to the Delaunay triangulation")]
    Stuck,
    /// Points that were apart have the same coordinates now.
    #[error("points that were apart have the same coordinates")]
    Coincident,
    /// Too many duplicates have parted from their points: inserting them takes longer.
    #[error("too many duplicates have parted")]
    Parted,
    /// Only a mesh on the device that triangulates its points can be repaired: this one is in the
    /// host's memory or on another device, or the CPU triangulates the points.
    #[error("the mesh is not on the device that triangulates its points")]
    NotResident,
    /// The arrays of the mesh are not those of a triangulation of its points.
    #[error("the mesh is not a triangulation")]
    Broken,
    /// More points come or go than it pays to insert or remove one by one.
    #[error("too many points come or go")]
    Points,
}

impl Restart {
    /// Returns the name of the reason, such as `inverted`.
    pub fn name(self) -> &'static str {
        match self {
            Restart::Degenerate => "degenerate",
            Restart::Inverted => "inverted",
            Restart::Changed => "changed",
            Restart::Stuck => "stuck",
            Restart::Coincident => "coincident",
            Restart::Parted => "parted",
            Restart::NotResident => "not-resident",
            Restart::Broken => "broken",
            Restart::Points => "points",
        }
    }
}

impl Field for Restart {
    fn value(&self) -> Value<'_> {
        Value::Text(self.name().into())
    }

    fn typescript() -> Option<String> {
        Some("string".to_owned())
    }
}
