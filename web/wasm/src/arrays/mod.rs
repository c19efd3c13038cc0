//! Meshes in the memory of this module as typed arrays.

#[cfg(any(feature = "d2", feature = "edit"))]
pub(crate) mod d2;
#[cfg(any(feature = "d3", feature = "edit"))]
pub(crate) mod d3;
