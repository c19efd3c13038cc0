//! The slots of a triangulation under construction: the vertices and the neighbours of each
//! simplex.

mod shared;

pub(crate) use shared::{MAX_WORKERS, SharedSlots, Worker, share, unshare};

use crate::error::Error;

/// The slots of simplices of `N` vertices, as the insertion of a vertex sees them: its own, or
/// shared with other threads.
///
/// A neighbour is 4·(simplex) + (facet as it is numbered there), and so is a facet.
pub trait Slots<const N: usize> {
    /// Whether other threads change the slots at the same time. Then only a simplex of which the
    /// caller has claimed a vertex is sure to stay what it is, and only one of which it has claimed
    /// all vertices may be replaced.
    const SHARED: bool;

    /// Returns the infinite vertex: the number of vertices.
    fn infinite(&self) -> u32;

    /// Returns the vertices of simplex `t`, with marks if there are any.
    fn simplex(&self, t: u32) -> [u32; N];

    /// Sets the vertices of simplex `t`, with marks if there are any.
    fn set_simplex(&mut self, t: u32, vertices: [u32; N]);

    /// Returns the neighbours of simplex `t`.
    fn neighbors(&self, t: u32) -> [u32; N];

    /// Sets the neighbours of simplex `t`.
    fn set_neighbors(&mut self, t: u32, neighbors: [u32; N]);

    /// Sets what is across a facet.
    fn set_neighbor(&mut self, facet: u32, across: u32);

    /// Returns an unused slot.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`], unless
    /// [`has_room`](Slots::has_room).
    fn push(&mut self) -> Result<u32, Error>;

    /// Returns whether `slots` slots can be pushed without an error. With several threads that has to be
    /// known before anything is changed.
    fn has_room(&mut self, slots: usize) -> bool;

    /// Claims a vertex for the caller. Returns whether no other thread has it.
    fn claim(&mut self, v: u32) -> bool;

    /// Takes a slot back that is not used any more. Of several slots the last comes first.
    fn discard(&mut self, t: u32);
}

/// Implements [`Slots`] for a triangulation with an array of simplices of `$n` vertices, one of
/// `neighbors`, and the number `infinite`, which no other thread changes; `$discard` takes a slot back.
macro_rules! slots_of_arrays {
    ($triangulation:ty, $n:literal, $simplices:ident, $limit:expr, $discard:expr) => {
        impl $crate::slots::Slots<$n> for $triangulation {
            const SHARED: bool = false;

            #[inline]
            fn infinite(&self) -> u32 {
                self.infinite
            }

            #[inline]
            fn simplex(&self, t: u32) -> [u32; $n] {
                self.$simplices[t as usize]
            }

            #[inline]
            fn set_simplex(&mut self, t: u32, vertices: [u32; $n]) {
                self.$simplices[t as usize] = vertices;
            }

            #[inline]
            fn neighbors(&self, t: u32) -> [u32; $n] {
                self.neighbors[t as usize]
            }

            #[inline]
            fn set_neighbors(&mut self, t: u32, neighbors: [u32; $n]) {
                self.neighbors[t as usize] = neighbors;
            }

            #[inline]
            fn set_neighbor(&mut self, facet: u32, across: u32) {
                self.neighbors[facet as usize / 4][facet as usize % 4] = across;
            }

            #[inline]
            fn push(&mut self) -> Result<u32, $crate::error::Error> {
                $crate::slots::push(&mut self.$simplices, &mut self.neighbors, $limit)
            }

            #[inline]
            fn has_room(&mut self, _slots: usize) -> bool {
                true
            }

            #[inline]
            fn claim(&mut self, _v: u32) -> bool {
                true
            }

            fn discard(&mut self, t: u32) {
                let discard: fn(&mut Self, u32) = $discard;
                discard(self, t);
            }
        }
    };
}
pub(crate) use slots_of_arrays;

/// Slots with the marks and tables that 3D cavities need: their simplices are marked, their
/// vertices are numbered, and some of their slots stay empty.
pub trait MarkedSlots<const N: usize>: Slots<N> {
    /// A table of numbers below 64, one per vertex.
    type Places: Places;

    /// Returns what stands for the first vertex of simplex `t`.
    fn first(&self, t: u32) -> u32;

    /// Sets what stands for the first vertex of simplex `t`.
    fn set_first(&mut self, t: u32, first: u32);

    /// Returns what stands for the first vertex and for vertex `k` of simplex `t`.
    fn first_and(&self, t: u32, k: usize) -> [u32; 2];

    /// Creates a table for the vertices, the infinite one included. The places of vertices that
    /// others have claimed must not be used.
    fn places(&self) -> Self::Places;
}

/// A table of numbers below 64, one per vertex, which has arbitrary contents at first.
pub trait Places {
    /// Returns the number of vertex `v`.
    fn place(&self, v: u32) -> u32;

    /// Sets the number of vertex `v`.
    fn set_place(&mut self, v: u32, place: u32);
}

impl Places for Vec<u32> {
    #[inline]
    fn place(&self, v: u32) -> u32 {
        self[v as usize]
    }

    #[inline]
    fn set_place(&mut self, v: u32, place: u32) {
        self[v as usize] = place;
    }
}

/// Reserves memory for this many slots in all.
///
/// # Errors
///
/// Returns [`Error::OutOfMemory`].
pub(crate) fn reserve<const N: usize>(
    simplices: &mut Vec<[u32; N]>,
    neighbors: &mut Vec<[u32; N]>,
    slots: usize,
) -> Result<(), Error> {
    let more = slots.saturating_sub(simplices.len());
    simplices
        .try_reserve_exact(more)
        .and_then(|()| neighbors.try_reserve_exact(more))
        .map_err(|_| Error::OutOfMemory { simplices: slots })
}

/// Reserves memory for more simplices of a mesh, and for some that may follow.
///
/// # Errors
///
/// Returns [`Error::OutOfMemory`].
pub(crate) fn reserve_more<const N: usize>(
    simplices: &mut Vec<[u32; N]>,
    neighbors: &mut Vec<[u32; N]>,
    more: usize,
) -> Result<(), Error> {
    let all = simplices.len() + more;
    simplices
        .try_reserve(more)
        .and_then(|()| neighbors.try_reserve(all.saturating_sub(neighbors.len())))
        .map_err(|_| Error::OutOfMemory { simplices: all })
}

/// Appends an unused slot to fewer than `limit` ones, and returns its number.
///
/// # Errors
///
/// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
#[inline(always)]
pub(crate) fn push<const N: usize>(
    simplices: &mut Vec<[u32; N]>,
    neighbors: &mut Vec<[u32; N]>,
    limit: usize,
) -> Result<u32, Error> {
    let count = simplices.len();
    if count == limit {
        return Err(Error::TooManySimplices { limit });
    }
    if count == simplices.capacity() {
        reserve(simplices, neighbors, (count + count / 2).min(limit))?;
    }
    simplices.push([0; N]);
    neighbors.push([0; N]);
    Ok(count as u32)
}
