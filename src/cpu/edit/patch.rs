//! What an edit changes of a mesh.

/// The vertices of a simplex, and its neighbours as [`Slots`](crate::slots::Slots) number them.
pub type Row<const N: usize> = ([u32; N], [u32; N]);

/// The changes of a mesh.
pub struct Patch<const N: usize, Hull> {
    /// The number of simplices afterwards.
    pub(crate) count: usize,
    /// The new rows of the simplices that change, by their numbers. Outside the hull the neighbour
    /// is [`NONE`](crate::index::NONE).
    pub(crate) rows: Vec<(u32, Row<N>)>,
    /// The new hull, if it changes.
    pub(crate) hull: Option<Hull>,
}
