//! Indices, and the marks for the absence of one.

/// Marks the absence of a simplex or point in arrays of `i32`, such as [`Mesh3::neighbors`](crate::Mesh3::neighbors)
/// (outside the hull) and [`Mesh3::duplicate_of`](crate::Mesh3::duplicate_of) (not a duplicate).
pub const NONE: i32 = -1;
