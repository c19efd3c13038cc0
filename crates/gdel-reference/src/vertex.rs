//! The vertices of the references.

/// A lattice point with its input index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Vertex<const D: usize> {
    /// Lattice coordinates, 0 ≤ q < 2^bits.
    pub position: [i64; D],
    /// The input index, which breaks ties; that of the interior point is above all others.
    pub index: u32,
}
