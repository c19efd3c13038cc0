//! Phase 1: parallel insertion and flipping (§3.1).

/// Which of its waiting points a tetrahedron inserts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum Pick {
    /// The one nearest to the circumcentre.
    #[default]
    Circumcenter = 0,
    /// The one nearest to the centroid.
    Centroid = 1,
    /// Any.
    Random = 2,
}
