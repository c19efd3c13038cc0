//! The mark for the absence of an index.

/// Marks the absence of a simplex, point or cell in arrays of indices.
///
/// It stands in [`Mesh3::neighbors`](crate::Mesh3::neighbors) and
/// [`Mesh2::halfedges`](crate::Mesh2::halfedges) outside the hull, and in `duplicate_of` for points
/// that are not duplicates. In JavaScript's signed arrays and in files it is −1, which has the same
/// bits.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// // A single triangle has no neighbours.
/// assert_eq!(gdel::delaunay2d(&points)?.halfedges, [[gdel::NONE; 3]]);
/// # Ok::<(), gdel::Error>(())
/// ```
pub const NONE: u32 = u32::MAX;

/// Writes an entry of an array of indices for people: "none" in place of [`NONE`].
pub(crate) struct Entry(pub(crate) u32);

impl std::fmt::Display for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.0 == NONE { f.write_str("none") } else { self.0.fmt(f) }
    }
}
