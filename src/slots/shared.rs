//! Slots that several threads fill at the same time, without locks on simplices.
//!
//! A thread *claims* vertices: it writes its number into their words, where no other thread's is.
//! It does so for the point that it inserts and for all vertices of the cavity, and gives up the
//! insertion, which so far has changed nothing, if another thread was first. So it never waits.
//! The infinite vertex needs no claim.
//!
//! 1. A simplex is replaced only by a thread that has claimed all its finite vertices. Therefore
//!    one of which a thread has claimed a single finite vertex stays, and the thread sees it as its
//!    maker left it: whoever made it had claimed that vertex too, and giving a claim back
//!    (`Release`) happens before the next claim of the same vertex (`Acquire`). All other accesses
//!    are `Relaxed`, which costs nothing on common processors.
//! 2. The simplices around a cavity share a facet with it, of whose vertices at most one is
//!    infinite, so that they stay, too. Any two facets of a tetrahedron have a finite vertex in
//!    common. So no two threads have the same tetrahedron beside their cavities, and none sees the
//!    marks of another. (In 2D a ghost may be beside two cavities, each of which changes the
//!    neighbour across its own edge, and there are no marks.)
//! 3. A walk reads simplices that may change under it, so that it may see any mixture of what was
//!    written into a slot. It only proposes where to begin: a thread claims the vertices that the
//!    walk has seen, and goes on if the slot still has the same ones, no mark, and is in conflict
//!    with the point. Then that simplex exists, by (1): every word of the slot with a finite vertex
//!    was written by a thread that had claimed this vertex before, so the newest of them is seen,
//!    and a thread that had removed the simplex since would have had to claim the same vertices.
//!    A slot that has not been written to has equal vertices, and so has one that is given back in 2D.

use crate::error::Error;
use crate::slots::{MarkedSlots, Places, Slots};
use std::{
    array,
    sync::atomic::{AtomicBool, AtomicU16, AtomicU32, AtomicUsize, Ordering::*},
};

/// The number of slots that a thread takes at a time.
const CHUNK: usize = 256;

/// A vertex's word: the place in the lower bits, the worker that has claimed it above them.
const PLACE_BITS: u32 = 6;
const PLACE: u16 = (1 << PLACE_BITS) - 1;

/// The maximum number of workers.
pub(crate) const MAX_WORKERS: usize = (1 << (16 - PLACE_BITS)) - 1;

/// Slots of simplices of `N` vertices that several threads fill.
pub(crate) struct SharedSlots<const N: usize> {
    /// `N` words per slot, as many as there is room for.
    simplices: Vec<AtomicU32>,
    neighbors: Vec<AtomicU32>,
    /// The number of slots that workers have taken, rounded up to what they wanted to take.
    taken: AtomicUsize,
    /// Whether a worker found no slot.
    full: AtomicBool,
    /// Slots that were taken and are not used.
    unused: Vec<u32>,
    claims: Vec<AtomicU16>,
    infinite: u32,
    limit: usize,
}

/// Returns `words` zeros, which take memory only where they are written to.
fn zeros(words: usize, slots: usize) -> Result<Vec<AtomicU32>, Error> {
    bytemuck::try_zeroed_vec(words).map(share).map_err(|()| Error::OutOfMemory { simplices: slots })
}

/// Returns the words of `vertices` vertices, none of which is claimed.
fn unclaimed(vertices: usize, slots: usize) -> Result<Vec<AtomicU16>, Error> {
    let words: Vec<u16> = bytemuck::try_zeroed_vec(vertices).map_err(|()| Error::OutOfMemory { simplices: slots })?;
    Ok(words.into_iter().map(AtomicU16::new).collect())
}

/// Returns the same words, where they are, for threads to share. The loop compiles to nothing.
pub(crate) fn share(words: Vec<u32>) -> Vec<AtomicU32> {
    words.into_iter().map(AtomicU32::new).collect()
}

/// Returns the same words, where they are, when no thread shares them any more.
pub(crate) fn unshare(words: Vec<AtomicU32>) -> Vec<u32> {
    words.into_iter().map(AtomicU32::into_inner).collect()
}

impl<const N: usize> SharedSlots<N> {
    /// Copies the slots of a triangulation, some of which are `unused`, to where there is room for
    /// `room`, in all at most `limit`, besides those that so many `workers` take before they use
    /// them.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfMemory`].
    pub(crate) fn new(
        [simplices, neighbors]: [&[[u32; N]]; 2],
        unused: Vec<u32>,
        infinite: u32,
        room: usize,
        limit: usize,
        workers: usize,
    ) -> Result<Self, Error> {
        let room = room + workers * CHUNK;
        let copy = |from: &[[u32; N]]| {
            let mut words = zeros(room.clamp(from.len(), limit) * N, room)?;
            words.iter_mut().zip(from.as_flattened()).for_each(|(word, &value)| *word = value.into());
            Ok::<_, Error>(words)
        };
        Ok(SharedSlots {
            taken: AtomicUsize::new(simplices.len()),
            simplices: copy(simplices)?,
            neighbors: copy(neighbors)?,
            full: AtomicBool::new(false),
            unused,
            claims: unclaimed(infinite as usize, room)?,
            infinite,
            limit,
        })
    }

    fn room(&self) -> usize {
        self.simplices.len() / N
    }

    /// Makes room for an eighth more slots if a worker found none. Returns whether it did.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
    pub(crate) fn grow(&mut self) -> Result<bool, Error> {
        if !std::mem::take(self.full.get_mut()) {
            return Ok(false);
        }
        let room = self.room();
        if room == self.limit {
            return Err(Error::TooManySimplices { limit: self.limit });
        }
        let slots = (room + room / 8 + CHUNK).min(self.limit);
        for words in [&mut self.simplices, &mut self.neighbors] {
            let mut more = unshare(std::mem::take(words));
            more.try_reserve_exact(slots * N - more.len()).map_err(|_| Error::OutOfMemory { simplices: slots })?;
            more.resize(slots * N, 0);
            *words = share(more);
        }
        // The others wanted to take slots beyond the end.
        let taken = self.taken.get_mut();
        *taken = room.min(*taken);
        Ok(true)
    }

    /// Returns what so many threads see, which must give back their unused slots to
    /// [`reclaim`](Self::reclaim).
    pub(crate) fn workers(&mut self, count: usize) -> Vec<Worker<'_, N>> {
        assert!(count <= MAX_WORKERS, "a claim has room for {MAX_WORKERS} workers");
        let mut unused = std::mem::take(&mut self.unused);
        let (simplices, neighbors) = (self.simplices.as_chunks().0, self.neighbors.as_chunks().0);
        let worker = |number: usize| Worker {
            simplices,
            neighbors,
            taken: &self.taken,
            full: &self.full,
            unused: std::mem::take(&mut unused),
            claims: &self.claims,
            me: (number as u16 + 1) << PLACE_BITS,
            claimed: Vec::new(),
            infinite: self.infinite,
        };
        (0..count).map(worker).collect()
    }

    /// Takes back the unused slots of a worker.
    pub(crate) fn reclaim(&mut self, unused: Vec<u32>) {
        self.unused.extend(unused);
    }

    /// Returns the vertices and the neighbours of all simplices, in slots without gaps.
    pub(crate) fn into_arrays(self) -> (Vec<[u32; N]>, Vec<[u32; N]>) {
        let taken = self.taken.into_inner().min(self.simplices.len() / N);
        let [mut simplices, mut neighbors]: [Vec<[u32; N]>; 2] =
            [self.simplices, self.neighbors].map(|words| bytemuck::cast_vec(unshare(words)));
        let mut unused = self.unused;
        unused.sort_unstable();
        // The last simplices move into the gaps before them.
        let (mut end, mut gaps) = (taken, unused.as_slice());
        while let Some((&last_gap, others)) = gaps.split_last() {
            end -= 1;
            if last_gap as usize == end {
                gaps = others;
                continue;
            }
            let (gap, others) = (gaps[0] as usize, &gaps[1..]);
            gaps = others;
            (simplices[gap], neighbors[gap]) = (simplices[end], neighbors[end]);
            for (k, across) in neighbors[gap].into_iter().enumerate() {
                neighbors[across as usize / 4][across as usize % 4] = (4 * gap + k) as u32;
            }
        }
        simplices.truncate(end);
        neighbors.truncate(end);
        (simplices, neighbors)
    }
}

/// The view of one thread of [`SharedSlots`], with its claims.
pub(crate) struct Worker<'a, const N: usize> {
    simplices: &'a [[AtomicU32; N]],
    neighbors: &'a [[AtomicU32; N]],
    taken: &'a AtomicUsize,
    full: &'a AtomicBool,
    /// Slots that this thread has taken and does not use.
    unused: Vec<u32>,
    claims: &'a [AtomicU16],
    /// The word of a vertex that this thread has claimed, without the place.
    me: u16,
    claimed: Vec<u32>,
    infinite: u32,
}

impl<const N: usize> Worker<'_, N> {
    /// Gives all claims back.
    pub(crate) fn release(&mut self) {
        for v in self.claimed.drain(..) {
            self.claims[v as usize].store(0, Release);
        }
    }

    /// Returns whether a thread found no slot, so that all have to stop.
    pub(crate) fn is_full(&self) -> bool {
        self.full.load(Relaxed)
    }

    /// Returns a slot that some thread has taken, by any number.
    pub(crate) fn any_slot(&self, number: usize) -> u32 {
        (number % self.taken.load(Relaxed).min(self.simplices.len())) as u32
    }

    /// Returns the unused slots, at the end.
    pub(crate) fn into_unused(mut self) -> Vec<u32> {
        self.release();
        self.unused
    }
}

impl<const N: usize> Slots<N> for Worker<'_, N> {
    const SHARED: bool = true;

    #[inline]
    fn infinite(&self) -> u32 {
        self.infinite
    }

    #[inline]
    fn simplex(&self, t: u32) -> [u32; N] {
        let words = &self.simplices[t as usize];
        array::from_fn(|k| words[k].load(Relaxed))
    }

    #[inline]
    fn set_simplex(&mut self, t: u32, vertices: [u32; N]) {
        self.simplices[t as usize].iter().zip(vertices).for_each(|(word, v)| word.store(v, Relaxed));
    }

    #[inline]
    fn neighbors(&self, t: u32) -> [u32; N] {
        let words = &self.neighbors[t as usize];
        array::from_fn(|k| words[k].load(Relaxed))
    }

    #[inline]
    fn set_neighbors(&mut self, t: u32, neighbors: [u32; N]) {
        self.neighbors[t as usize].iter().zip(neighbors).for_each(|(word, across)| word.store(across, Relaxed));
    }

    #[inline]
    fn set_neighbor(&mut self, facet: u32, across: u32) {
        self.neighbors[facet as usize / 4][facet as usize % 4].store(across, Relaxed);
    }

    /// # Panics
    ///
    /// Panics if it was not checked that there [is room](Slots::has_room).
    fn push(&mut self) -> Result<u32, Error> {
        Ok(self.unused.pop().expect("there is room"))
    }

    fn has_room(&mut self, slots: usize) -> bool {
        while self.unused.len() < slots {
            let start = self.taken.fetch_add(CHUNK, Relaxed);
            let end = (start + CHUNK).min(self.simplices.len());
            if start >= end {
                self.full.store(true, Relaxed);
                return false;
            }
            self.unused.extend((start as u32..end as u32).rev());
        }
        true
    }

    #[inline]
    fn claim(&mut self, v: u32) -> bool {
        if v == self.infinite {
            return true;
        }
        let word = &self.claims[v as usize];
        let seen = word.load(Relaxed);
        if seen & !PLACE == self.me {
            return true;
        }
        let is_mine = seen == 0 && word.compare_exchange(0, self.me, Acquire, Relaxed).is_ok();
        if is_mine {
            self.claimed.push(v);
        }
        is_mine
    }

    fn discard(&mut self, t: u32) {
        self.unused.push(t);
    }
}

impl<'a, const N: usize> MarkedSlots<N> for Worker<'a, N> {
    type Places = SharedPlaces<'a>;

    #[inline]
    fn first(&self, t: u32) -> u32 {
        self.simplices[t as usize][0].load(Relaxed)
    }

    #[inline]
    fn set_first(&mut self, t: u32, first: u32) {
        self.simplices[t as usize][0].store(first, Relaxed);
    }

    #[inline]
    fn first_and(&self, t: u32, k: usize) -> [u32; 2] {
        let words = &self.simplices[t as usize];
        [0, k % N].map(|k| words[k].load(Relaxed))
    }

    fn places(&self) -> SharedPlaces<'a> {
        SharedPlaces { claims: self.claims, me: self.me, of_infinite: 0 }
    }
}

/// Places in the words of vertices that one thread has claimed.
pub(crate) struct SharedPlaces<'a> {
    claims: &'a [AtomicU16],
    me: u16,
    /// The infinite vertex belongs to all threads.
    of_infinite: u32,
}

impl Places for SharedPlaces<'_> {
    #[inline]
    fn place(&self, v: u32) -> u32 {
        self.claims.get(v as usize).map_or(self.of_infinite, |word| u32::from(word.load(Relaxed) & PLACE))
    }

    #[inline]
    fn set_place(&mut self, v: u32, place: u32) {
        match self.claims.get(v as usize) {
            Some(word) => word.store(self.me | place as u16 & PLACE, Relaxed),
            None => self.of_infinite = place,
        }
    }
}
