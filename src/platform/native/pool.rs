//! Work on slices, shared among the threads of rayon's pool.

use crate::{
    error::Error,
    platform::sharing::{CHUNK, Threads},
};
use rayon::prelude::*;
#[cfg(feature = "gpu")]
use std::sync::Arc;
use std::{
    cmp::Ordering,
    num::NonZeroUsize,
    ops::Range,
    sync::{Mutex, PoisonError},
};

/// Calls `work` with each number below `count`, on all threads. Compiled once: what is compiled for each kind of work stays
/// small, here and in every program that uses this crate.
fn for_each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().with_max_len(1).for_each(work);
}

/// Calls `work` with each item and its index, on all threads, and returns the results in order.
fn map_each<T: Send, R: Send>(items: impl Iterator<Item = T>, work: impl Fn(usize, T) -> R + Sync) -> Vec<R> {
    // Who comes to an item takes it and leaves the result.
    let slots: Vec<Mutex<Slot<T, R>>> = items.map(|item| Mutex::new(Slot::Item(item))).collect();
    for_each(slots.len(), &|i| {
        let slot = || slots[i].lock().unwrap_or_else(PoisonError::into_inner);
        let taken = std::mem::replace(&mut *slot(), Slot::Taken);
        if let Slot::Item(item) = taken {
            let result = work(i, item);
            *slot() = Slot::Result(result);
        }
    });
    let result = |slot: Mutex<_>| match slot.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Slot::Result(result) => Some(result),
        Slot::Item(_) | Slot::Taken => None,
    };
    slots.into_iter().filter_map(result).collect()
}

/// An item, then what has become of it.
enum Slot<T, R> {
    Item(T),
    Taken,
    Result(R),
}

/// Calls `work` with every chunk of `items` and the index of its first element.
pub(crate) fn for_chunks<T: Send>(threads: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    match threads {
        Threads::All if items.len() > CHUNK => {
            map_each(items.chunks_mut(CHUNK), |i, chunk| work(i * CHUNK, chunk));
        }
        _ => work(0, items),
    }
}

/// Calls `work` with one part of `items` per thread, and the index of its first element. For work that takes equally
/// long for every part.
pub(crate) fn for_parts<T: Send>(threads: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    match threads {
        Threads::All if !items.is_empty() => {
            let len = items.len().div_ceil(count(threads));
            map_each(items.chunks_mut(len), |i, part| work(i * len, part));
        }
        _ => work(0, items),
    }
}

/// Calls `work` with corresponding chunks of two lists of equal length, and the index of their
/// first elements.
pub(crate) fn for_chunk_pairs<T: Send, U: Send>(
    threads: Threads,
    (items, others): (&mut [T], &mut [U]),
    work: impl Fn(usize, (&mut [T], &mut [U])) + Sync,
) {
    match threads {
        Threads::All if items.len() > CHUNK => {
            let chunks = items.chunks_mut(CHUNK).zip(others.chunks_mut(CHUNK));
            map_each(chunks, |i, pair| work(i * CHUNK, pair));
        }
        _ => work(0, (items, others)),
    }
}

/// Returns a list of `len` times `value`. Several threads touch its memory at once.
pub(crate) fn filled<T: Copy + Send + Sync>(threads: Threads, len: usize, value: T) -> Vec<T> {
    match threads {
        Threads::All if len > CHUNK => rayon::iter::repeat_n(value, len).with_min_len(CHUNK).collect(),
        _ => vec![value; len],
    }
}

/// Appends `items` to `list`.
pub(crate) fn extend<T: Copy + Send + Sync>(threads: Threads, list: &mut Vec<T>, items: &[T]) {
    match threads {
        Threads::All if items.len() > CHUNK => list.par_extend(items.par_iter().with_min_len(CHUNK).copied()),
        _ => list.extend_from_slice(items),
    }
}

/// Splits 0 … `len` into ranges of `grain` elements and returns the results of `work` for each, in
/// order.
pub(crate) fn map_grains<R: Send>(
    threads: Threads,
    len: usize,
    grain: usize,
    work: impl Fn(Range<usize>) -> R + Sync,
) -> Vec<R> {
    match threads {
        Threads::All if len > grain => {
            let ranges = (0..len).step_by(grain).map(|start| start..(start + grain).min(len));
            map_each(ranges, |_, range| work(range))
        }
        _ => vec![work(0..len)],
    }
}

/// Returns the results of `work` for each item and its index, in order. For items that are each
/// worth handing to another thread.
pub(crate) fn map_mut<T: Send, R: Send>(
    threads: Threads,
    items: &mut [T],
    work: impl Fn(usize, &mut T) -> R + Sync,
) -> Vec<R> {
    match threads {
        Threads::All => map_each(items.iter_mut(), work),
        Threads::One => items.iter_mut().enumerate().map(|(i, item)| work(i, item)).collect(),
    }
}

/// Sorts items of which equal ones are indistinguishable.
pub(crate) fn sort<T: Ord + Send>(threads: Threads, items: &mut [T]) {
    match threads {
        Threads::All => items.par_sort_unstable(),
        Threads::One => items.sort_unstable(),
    }
}

/// Sorts items by a total order.
pub(crate) fn sort_by<T: Send>(threads: Threads, items: &mut [T], compare: impl Fn(&T, &T) -> Ordering + Sync) {
    match threads {
        Threads::All => items.par_sort_unstable_by(compare),
        Threads::One => items.sort_unstable_by(compare),
    }
}

/// Does two pieces of work, at the same time if `threads` share them, and returns both results.
pub(crate) fn both<S: Send, R: Send>(
    threads: Threads,
    one: impl FnOnce() -> S + Send,
    other: impl FnOnce() -> R + Send,
) -> (S, R) {
    if threads == Threads::One {
        return (one(), other());
    }
    let ((mut one, mut other), (mut first, mut second)) = ((Some(one), Some(other)), (None, None));
    join(&mut || first = one.take().map(|work| work()), &mut || second = other.take().map(|work| work()));
    first.zip(second).expect("both were called")
}

/// Calls both functions, at the same time.
fn join(one: &mut (dyn FnMut() + Send), other: &mut (dyn FnMut() + Send)) {
    rayon::join(one, other);
}

/// Runs `own` in the calling thread and the `others` in threads of the pool, at the same time as
/// far as these are free, and returns the results.
pub(crate) fn beside<S, R: Send>(own: impl FnOnce() -> S, others: Vec<impl FnOnce() -> R + Send>) -> (S, Vec<R>) {
    let mut results: Vec<Option<R>> = others.iter().map(|_| None).collect();
    let result = rayon::in_place_scope(|scope| {
        for (other, result) in others.into_iter().zip(&mut results) {
            scope.spawn(move |_| *result = Some(other()));
        }
        own()
    });
    (result, results.into_iter().flatten().collect())
}

/// Returns how many threads work at the same time.
pub(crate) fn count(threads: Threads) -> usize {
    match threads {
        Threads::One => 1,
        Threads::All => rayon::current_num_threads(),
    }
}

/// Calls `work` with [`Threads`] that stand for `limit` threads, or for all if there is no limit.
///
/// # Errors
///
/// Returns [`Error::Threads`] if the system does not start so many threads.
pub(crate) fn with_threads<R: Send>(
    limit: Option<NonZeroUsize>,
    work: impl FnOnce(Threads) -> Result<R, Error> + Send,
) -> Result<R, Error> {
    let all = count(Threads::All);
    let number = limit.map_or(all, NonZeroUsize::get);
    if number > 1 && number != all {
        // Rayon's functions use the pool in which they are called.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(number).build();
        let pool = pool.map_err(|error| Error::Threads { threads: number, reason: error.to_string() })?;
        return pool.install(|| work(Threads::All));
    }
    work(if number > 1 { Threads::All } else { Threads::One })
}

/// Frees memory that consists of many pieces, in another thread.
pub(crate) fn dispose<T: Send + 'static>(garbage: T) {
    rayon::spawn(move || drop(garbage));
}

/// A value that a thread of the pool makes while the calling thread does something else.
#[cfg(feature = "gpu")]
#[derive(Debug)]
pub(crate) struct Ahead<T>(Arc<Mutex<Option<T>>>);

#[cfg(feature = "gpu")]
impl<T: Send + 'static> Ahead<T> {
    /// Lets a thread make the value as soon as one is free.
    pub(crate) fn begin(make: impl FnOnce() -> T + Send + 'static) -> Self {
        let made = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&made);
        rayon::spawn(move || {
            let result = make();
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        });
        Ahead(made)
    }

    /// Returns the value if the thread is done. It does not wait, because the calling thread may be the one that is to
    /// make the value.
    pub(crate) fn take(&self) -> Option<T> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}
