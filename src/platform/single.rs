//! Work on slices, in the calling thread.

use crate::{
    error::Error,
    platform::sharing::{CHUNK, Threads, in_pieces},
};
use std::{cmp::Ordering, num::NonZeroUsize, ops::Range};

/// Whether work is done in pieces, in functions that are called for each: not with the GPU backend, in the WebAssembly
/// modules that a page loads first. These would be 2 % larger, and do most of their work in functions of one point each.
const IN_PIECES: bool = !cfg!(feature = "gpu");

/// Calls `work` with every chunk of `items` and the index of its first element.
pub(crate) fn for_chunks<T: Send>(_: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    if !IN_PIECES {
        return work(0, items);
    }
    in_pieces(items.len(), CHUNK, &mut |range| work(range.start, &mut items[range]));
}

/// Calls `work` with `items` and the index of the first one.
pub(crate) fn for_parts<T: Send>(_: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    work(0, items);
}

/// Calls `work` with corresponding chunks of two lists of equal length, and the index of their first elements.
pub(crate) fn for_chunk_pairs<T: Send, U: Send>(
    _: Threads,
    (items, others): (&mut [T], &mut [U]),
    work: impl Fn(usize, (&mut [T], &mut [U])) + Sync,
) {
    if !IN_PIECES {
        return work(0, (items, others));
    }
    in_pieces(items.len(), CHUNK, &mut |range| work(range.start, (&mut items[range.clone()], &mut others[range])));
}

/// Returns a list of `len` times `value`.
pub(crate) fn filled<T: Copy + Send + Sync>(_: Threads, len: usize, value: T) -> Vec<T> {
    vec![value; len]
}

/// Appends `items` to `list`.
pub(crate) fn extend<T: Copy + Send + Sync>(_: Threads, list: &mut Vec<T>, items: &[T]) {
    list.extend_from_slice(items);
}

/// Splits 0 … `len` into ranges of `grain` elements and returns the results of `work` for each, in order.
pub(crate) fn map_grains<R: Send>(
    _: Threads,
    len: usize,
    grain: usize,
    work: impl Fn(Range<usize>) -> R + Sync,
) -> Vec<R> {
    if !IN_PIECES {
        return vec![work(0..len)];
    }
    let mut results = Vec::new();
    in_pieces(len, grain, &mut |range| results.push(work(range)));
    results
}

/// Returns the results of `work` for each item and its index, in order.
pub(crate) fn map_mut<T: Send, R: Send>(
    _: Threads,
    items: &mut [T],
    work: impl Fn(usize, &mut T) -> R + Sync,
) -> Vec<R> {
    if !IN_PIECES {
        return items.iter_mut().enumerate().map(|(i, item)| work(i, item)).collect();
    }
    let mut results = Vec::with_capacity(items.len());
    in_pieces(items.len(), 1, &mut |range| results.extend(range.map(|i| work(i, &mut items[i]))));
    results
}

/// Sorts items of which equal ones are indistinguishable.
pub(crate) fn sort<T: Ord + Send>(_: Threads, items: &mut [T]) {
    items.sort_unstable();
}

/// Sorts items by a total order.
pub(crate) fn sort_by<T: Send>(_: Threads, items: &mut [T], compare: impl Fn(&T, &T) -> Ordering + Sync) {
    items.sort_unstable_by(compare);
}

/// Does two pieces of work, one after the other, and returns both results.
pub(crate) fn both<S: Send, R: Send>(
    _: Threads,
    one: impl FnOnce() -> S + Send,
    other: impl FnOnce() -> R + Send,
) -> (S, R) {
    (one(), other())
}

/// Runs `own`, then the `others`, and returns the results.
pub(crate) fn beside<S, R: Send>(own: impl FnOnce() -> S, others: Vec<impl FnOnce() -> R + Send>) -> (S, Vec<R>) {
    (own(), others.into_iter().map(|other| other()).collect())
}

/// Returns how many threads work at the same time: one.
pub(crate) fn count(_: Threads) -> usize {
    1
}

/// Calls `work` with the one thread that there is, whatever the limit.
///
/// # Errors
///
/// Returns the errors of `work`.
pub(crate) fn with_threads<R: Send>(
    _limit: Option<NonZeroUsize>,
    work: impl FnOnce(Threads) -> Result<R, Error> + Send,
) -> Result<R, Error> {
    work(Threads::One)
}

/// Frees memory.
pub(crate) fn dispose<T>(garbage: T) {
    drop(garbage);
}

/// Stands for a value that no other thread makes.
#[cfg(feature = "gpu")]
#[derive(Debug)]
pub(crate) struct Ahead<T>(std::marker::PhantomData<T>);

#[cfg(feature = "gpu")]
impl<T> Ahead<T> {
    /// Does nothing.
    pub(crate) fn begin(_make: impl FnOnce() -> T) -> Self {
        Ahead(std::marker::PhantomData)
    }

    /// Returns `None`.
    pub(crate) fn take(&self) -> Option<T> {
        None
    }
}
