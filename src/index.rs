//! Indices, and the values that stand for the absence of one.

/// Marks the absence of an index in the public arrays of `i32`: in
/// [`Mesh3::neighbors`](crate::Mesh3::neighbors) and [`Mesh2::halfedges`](crate::Mesh2::halfedges)
/// the outside of the hull, in [`Mesh3::duplicate_of`](crate::Mesh3::duplicate_of) a point that
/// duplicates no other.
pub const NONE: i32 = -1;

/// Marks the absence of an index in internal arrays of `u32`: no point, no simplex, no neighbor.
pub const NO_INDEX: u32 = u32::MAX;
