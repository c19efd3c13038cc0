//! Indices, and the mark for the absence of one.

/// Marks the absence of a simplex or point in the arrays of a mesh:
/// [`Mesh3::neighbors`](crate::Mesh3::neighbors) and [`Mesh2::halfedges`](crate::Mesh2::halfedges)
/// outside the hull, `duplicate_of` for points that are not duplicates.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// // A single triangle has no neighbours.
/// assert_eq!(gdel::delaunay2d(&points)?.halfedges, [[gdel::NONE; 3]]);
/// # Ok::<(), gdel::Error>(())
/// ```
pub const NONE: i32 = -1;

/// Marks the absence of an index in internal arrays of `u32`: no point, no simplex, no neighbor.
pub const NO_INDEX: u32 = u32::MAX;
