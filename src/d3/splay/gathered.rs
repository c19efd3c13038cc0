//! The stars that splaying asks for, as they come from the device.

use crate::{
    index::NONE,
    parallel::{self, Threads},
};

/// The number of every tetrahedron that is not in the region.
pub(super) const OUTSIDE: u32 = 0;

/// The bits of the slot, in [`Gathered::slots`].
pub const SLOT: u32 = (1 << NAMED_SHIFT) - 1;

/// Where the vertices start, in [`Gathered::slots`], of which it is the tetrahedron.
pub const NAMED_SHIFT: u32 = 28;

/// Tetrahedra of a triangulation, numbered in this order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Gathered {
    /// The vertices of each; a ghost has infinity last.
    pub tetrahedra: Vec<[u32; 4]>,
    /// The neighbours of each, 4·number + facet; below 4 where the neighbour has not been gathered.
    pub neighbors: Vec<[u32; 4]>,
    /// Where each is in the triangulation ([`SLOT`]); bit [`NAMED_SHIFT`] + *k* says that it is the
    /// tetrahedron of its vertex *k*. Every vertex has one, a ghost if it has any.
    pub slots: Vec<u32>,
}

impl Gathered {
    /// Adds others behind the first `len`. What is missing before has no slot. Returns memory that is not needed
    /// any more.
    pub(super) fn append(&mut self, len: usize, others: Gathered, threads: Threads) -> Gathered {
        if len == 0 && self.slots.is_empty() {
            return std::mem::replace(self, others);
        }
        self.tetrahedra.resize(len, [OUTSIDE; 4]);
        self.neighbors.resize(len, [OUTSIDE; 4]);
        self.slots.resize(len, NONE);
        parallel::extend(threads, &mut self.tetrahedra, &others.tetrahedra);
        parallel::extend(threads, &mut self.neighbors, &others.neighbors);
        parallel::extend(threads, &mut self.slots, &others.slots);
        others
    }

    /// Returns the vertices and neighbours of the tetrahedron with a number of the region, if it was
    /// gathered.
    pub(super) fn of(&self, number: usize) -> Option<(&[u32; 4], &[u32; 4])> {
        let i = number.wrapping_sub(1);
        (*self.slots.get(i)? != NONE).then_some((&self.tetrahedra[i], &self.neighbors[i]))
    }
}
