//! Memory of the host for results, before they are read.

use crate::parallel::{Ahead, Threads, for_chunks};
use bytemuck::Pod;

/// From this size on, it pays that threads allocate memory ahead.
const SHARED_FROM: usize = 1 << 20;

/// The size of a page of memory, or less.
const PAGE: usize = 1 << 12;

/// Memory for a large result, prepared while the device is at work.
#[derive(Debug)]
pub(crate) enum Room<T> {
    /// The memory of a list that is no longer needed.
    Used(Vec<T>),
    /// Fresh memory, which takes the system longer to provide than the result takes to copy.
    Ahead(Ahead<Vec<T>>),
}

/// Memory for the simplices of a mesh, and for their neighbours.
pub(crate) type Rooms<T> = [Option<Room<T>>; 2];

impl<T: Pod + Send> Room<T> {
    /// Returns room for about `len` elements: the memory of `used` if it holds at least half of them, otherwise
    /// memory that other threads allocate; `None` for small results.
    pub(crate) fn new(used: Vec<T>, len: usize) -> Option<Self> {
        if used.capacity() > len / 2 {
            return Some(Room::Used(used));
        }
        drop(used);
        let len = with_room(len);
        let pays = len.checked_mul(size_of::<T>())? >= SHARED_FROM;
        let touched = move || {
            // If this fails, the list is empty, and the reader allocates.
            let mut list: Vec<T> = bytemuck::try_zeroed_vec(len).unwrap_or_default();
            // The system provides a page when it is first written to.
            for_chunks(Threads::All, &mut list, |_, chunk| {
                let pages = chunk.chunks_mut(PAGE / size_of::<T>());
                pages.for_each(|page| page[0] = std::hint::black_box(T::zeroed()));
            });
            list
        };
        pays.then(|| Room::Ahead(Ahead::begin(touched)))
    }

    /// Returns the memory; an empty list if it is not ready.
    pub(crate) fn take(self) -> Vec<T> {
        match self {
            Room::Used(list) => list,
            Room::Ahead(ahead) => ahead.take().unwrap_or_default(),
        }
    }
}

/// Returns a list of `len` arbitrary elements with some room behind them, in the memory of `list`. What is
/// more than that is freed.
pub(crate) fn fitted<T: Pod>(mut list: Vec<T>, len: usize) -> Vec<T> {
    let wanted = with_room(len);
    if list.capacity() == 0 {
        list = bytemuck::zeroed_vec(wanted);
    }
    list.reserve(wanted.saturating_sub(list.len()));
    list.resize(len, T::zeroed());
    list.shrink_to(with_room(wanted));
    list
}

/// Returns the capacity for `len` elements that are read: splaying adds a few tetrahedra, and should not
/// have to move all others.
pub(super) fn with_room(len: usize) -> usize {
    len + len / 64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_have_their_length_whatever_room_there_was() {
        for room in [0, 1, 1000, 1015, 2000] {
            for len in [0, 1, 1000] {
                let list = fitted(vec![[7u32; 4]; room], len);
                assert_eq!(list.len(), len, "room for {room}");
                assert!(list.capacity() >= with_room(len), "room for {room}, {len} elements");
                assert!(list.capacity() <= with_room(with_room(len)).max(1), "room for {room}, {len} elements");
            }
        }
    }

    #[test]
    fn room_is_for_large_results() {
        assert!(Room::<u32>::new(Vec::new(), 1000).is_none());
        assert!(Room::<[u32; 4]>::new(Vec::new(), usize::MAX / 2).is_none());
        let ahead = match Room::<[u32; 4]>::new(vec![[0; 4]; 1000], SHARED_FROM) {
            Some(Room::Ahead(ahead)) => ahead,
            other => panic!("it is large, and the list is not: {other:?}"),
        };
        let room = loop {
            match ahead.take() {
                Some(room) => break room,
                None => std::thread::yield_now(),
            }
        };
        assert!(room.len() >= SHARED_FROM);
        let place = room.as_ptr();
        let room = Room::new(room, SHARED_FROM + 1).map(Room::take);
        assert_eq!(room.map(|room| room.as_ptr()), Some(place), "the list has room");
    }
}
