//! The number of coordinates as a type.

/// The marker that traits of a dimension are implemented for: triangulations of points with `D`
/// coordinates.
///
/// What the dimensions have in common is generic over `D`, and such a trait supplies what differs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Dimension<const D: usize>;
