//! Work on slices, shared among the machine's threads if it has several.

use crate::error::Error;
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
use std::sync::Arc;
use std::{
    cmp::Ordering,
    num::NonZeroUsize,
    ops::Range,
    sync::{Mutex, PoisonError},
};

#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
use rayon::prelude::*;

/// Which threads share a piece of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Threads {
    /// The calling thread only.
    One,
    /// The threads of rayon's pool, or the calling thread if there are no others, as in the
    /// browser.
    All,
}

/// The number of elements that is worth handing to another thread if the work per element is a few
/// instructions.
const CHUNK: usize = 1 << 13;

/// Fewer keys than this are compared.
const FEW: usize = 256;

/// As many keys one thread sorts sooner than several.
const SORTED_BY_ONE: usize = 1 << 17;

/// Calls `work` with every chunk of `items` and the index of its first element.
pub(crate) fn for_chunks<T: Send>(threads: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All && items.len() > CHUNK {
        return items.par_chunks_mut(CHUNK).enumerate().for_each(|(i, chunk)| work(i * CHUNK, chunk));
    }
    let _ = threads;
    work(0, items);
}

/// Calls `work` with as many parts of `items` as there are threads, each with the index of its first
/// element. For work that is the same for every part, however large.
pub(crate) fn for_parts<T: Send>(threads: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All && !items.is_empty() {
        let len = items.len().div_ceil(count(threads));
        return items.par_chunks_mut(len).enumerate().for_each(|(i, part)| work(i * len, part));
    }
    let _ = threads;
    work(0, items);
}

/// Returns a list of `len` times `value`: the system provides its memory to several threads at once.
pub(crate) fn filled<T: Copy + Send + Sync>(threads: Threads, len: usize, value: T) -> Vec<T> {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All && len > CHUNK {
        return rayon::iter::repeat_n(value, len).with_min_len(CHUNK).collect();
    }
    let _ = threads;
    vec![value; len]
}

/// Appends `items` to `list`.
pub(crate) fn extend<T: Copy + Send + Sync>(threads: Threads, list: &mut Vec<T>, items: &[T]) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All && items.len() > CHUNK {
        return list.par_extend(items.par_iter().with_min_len(CHUNK).copied());
    }
    let _ = threads;
    list.extend_from_slice(items);
}

/// Calls `work` with corresponding chunks of two lists of equal length, and the index of their
/// first elements.
pub(crate) fn for_chunk_pairs<T: Send, U: Send>(
    threads: Threads,
    (items, others): (&mut [T], &mut [U]),
    work: impl Fn(usize, (&mut [T], &mut [U])) + Sync,
) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All && items.len() > CHUNK {
        let chunks = items.par_chunks_mut(CHUNK).zip(others.par_chunks_mut(CHUNK));
        return chunks.enumerate().for_each(|(i, pair)| work(i * CHUNK, pair));
    }
    let _ = threads;
    work(0, (items, others));
}

/// Splits 0 … `len` into ranges of [`CHUNK`] elements and returns the results of `work` for each,
/// in order. For work of a few instructions per element.
pub(crate) fn map_ranges<R: Send>(threads: Threads, len: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    map_grains(threads, len, CHUNK, work)
}

/// Splits 0 … `len` into ranges of `grain` elements and returns the results of `work` for each, in
/// order.
pub(crate) fn map_grains<R: Send>(
    threads: Threads,
    len: usize,
    grain: usize,
    work: impl Fn(Range<usize>) -> R + Sync,
) -> Vec<R> {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All && len > grain {
        let range = |i: usize| i * grain..((i + 1) * grain).min(len);
        return (0..len.div_ceil(grain)).into_par_iter().with_max_len(1).map(|i| work(range(i))).collect();
    }
    let _ = (threads, grain);
    vec![work(0..len)]
}

/// Returns the items of all parts, in order; a single part as it is.
pub(crate) fn joined<T: Clone>(mut parts: Vec<Vec<T>>) -> Vec<T> {
    match parts.len() {
        1 => parts.remove(0),
        _ => parts.concat(),
    }
}

/// Values that threads take while they work, and give back: there are never more values than threads.
#[derive(Debug, Default)]
pub(crate) struct Pool<T>(Mutex<Vec<T>>);

impl<T: Default> Pool<T> {
    /// Calls `work` with a value that no other thread has; creates one if all are taken.
    pub(crate) fn with<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let free = lock().pop();
        let mut value = free.unwrap_or_default();
        let result = work(&mut value);
        lock().push(value);
        result
    }

    /// Returns the values.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn all(&mut self) -> &mut [T] {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Sorts items of which equal ones are indistinguishable.
pub(crate) fn sort<T: Ord + Send>(threads: Threads, items: &mut [T]) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All {
        return items.par_sort_unstable();
    }
    let _ = threads;
    items.sort_unstable();
}

/// Sorts entries by their upper halves; those with equal ones stay in their order, or come in that of
/// their lower halves.
pub(crate) fn sort_keyed(threads: Threads, entries: &mut [u64]) {
    if count(threads) > 1 && threads == Threads::All && entries.len() > SORTED_BY_ONE {
        return sort(threads, entries);
    }
    if entries.len() < FEW {
        // A WebAssembly module has the indirect sort anyway, and a sort of numbers is as large.
        let is_wasm = cfg!(target_arch = "wasm32");
        return if is_wasm { sort_indirectly(entries, &|i, j| i.cmp(&j)) } else { entries.sort_unstable() };
    }
    // A radix sort from the lowest digit.
    const DIGIT: u32 = 11;
    let digit = |entry: u64, shift: u32| (entry >> shift) as usize & ((1 << DIGIT) - 1);
    let mut others = vec![0; entries.len()];
    let (mut from, mut to) = (&mut *entries, &mut others[..]);
    let mut is_moved = false;
    for shift in [32, 32 + DIGIT, 32 + 2 * DIGIT] {
        let mut starts = [0usize; 1 << DIGIT];
        from.iter().for_each(|&entry| starts[digit(entry, shift)] += 1);
        if starts.contains(&from.len()) {
            continue;
        }
        let mut before = 0;
        for start in &mut starts {
            before += std::mem::replace(start, before);
        }
        for &entry in &*from {
            let start = &mut starts[digit(entry, shift)];
            to[*start] = entry;
            *start += 1;
        }
        (from, to) = (to, from);
        is_moved = !is_moved;
    }
    if is_moved {
        entries.copy_from_slice(&others);
    }
}

/// Sorts items by the keys that belong to them; those with equal keys stay in their order.
pub(crate) fn sort_by_keys<T: Copy>(threads: Threads, items: &mut Vec<T>, keys: Vec<u32>) {
    *items = order_of(threads, keys).into_iter().map(|i| items[i as usize]).collect();
}

/// Returns the indices of keys in ascending order of these; those of equal keys are ascending.
#[inline(never)]
pub(crate) fn order_of(threads: Threads, keys: Vec<u32>) -> Vec<u32> {
    let mut keyed: Vec<u64> = (0..).zip(keys).map(|(i, key)| u64::from(key) << 32 | i).collect();
    sort_keyed(threads, &mut keyed);
    keyed.into_iter().map(|entry| entry as u32).collect()
}

/// Sorts items of several numbers, of which equal ones are indistinguishable. A sort is large, so that there is one for all of
/// them in a WebAssembly module, which orders their indices.
pub(crate) fn sort_records<T: Ord + Copy + Send>(threads: Threads, records: &mut [T]) {
    if cfg!(not(target_arch = "wasm32")) {
        return sort(threads, records);
    }
    let given = records.to_vec();
    let mut order: Vec<u64> = (0..given.len() as u64).collect();
    sort_indirectly(&mut order, &|i, j| given[i as usize].cmp(&given[j as usize]));
    records.iter_mut().zip(order).for_each(|(record, i)| *record = given[i as usize]);
}

/// Sorts by a function behind a pointer, so that the sort is compiled once for all of them.
pub(crate) fn sort_indirectly(items: &mut [u64], compare: &dyn Fn(u64, u64) -> Ordering) {
    items.sort_unstable_by(|&i, &j| compare(i, j));
}

/// Sorts items by a total order.
pub(crate) fn sort_by<T: Send>(threads: Threads, items: &mut [T], compare: impl Fn(&T, &T) -> Ordering + Sync) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All {
        return items.par_sort_unstable_by(compare);
    }
    let _ = threads;
    items.sort_unstable_by(compare);
}

/// Returns the results of `work` for each item and its index, in order. For items that are each
/// worth handing to another thread.
pub(crate) fn map_mut<T: Send, R: Send>(
    threads: Threads,
    items: &mut [T],
    work: impl Fn(usize, &mut T) -> R + Sync,
) -> Vec<R> {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All {
        return items.par_iter_mut().enumerate().with_max_len(1).map(|(i, item)| work(i, item)).collect();
    }
    let _ = threads;
    items.iter_mut().enumerate().map(|(i, item)| work(i, item)).collect()
}

/// Returns how many threads can work at the same time.
pub(crate) fn count(threads: Threads) -> usize {
    match threads {
        Threads::One => 1,
        #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
        Threads::All => rayon::current_num_threads(),
        #[cfg(not(all(feature = "threads", not(target_arch = "wasm32"))))]
        Threads::All => 1,
    }
}

/// Calls `work` with what stands for `limit` threads, or for all if there is no limit.
///
/// # Errors
///
/// Returns [`Error::Threads`] if the system does not start so many threads.
pub(crate) fn with_threads<R: Send>(
    limit: Option<NonZeroUsize>,
    work: impl FnOnce(Threads) -> Result<R, Error> + Send,
) -> Result<R, Error> {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    {
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
    #[cfg(not(all(feature = "threads", not(target_arch = "wasm32"))))]
    {
        let _ = limit;
        work(Threads::One)
    }
}

/// Frees memory in many pieces, by another thread.
#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
pub(crate) fn dispose<T: Send + 'static>(garbage: T) {
    rayon::spawn(move || drop(garbage));
}

/// Frees memory: there is no other thread.
#[cfg(not(all(feature = "threads", not(target_arch = "wasm32"))))]
pub(crate) fn dispose<T>(garbage: T) {
    drop(garbage);
}

/// What a thread of the pool makes while the calling one does something else.
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
#[derive(Debug)]
pub(crate) struct Ahead<T>(Arc<Mutex<Option<T>>>);

#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
impl<T: Send + 'static> Ahead<T> {
    /// Has a thread begin, as soon as one is free.
    pub(crate) fn begin(make: impl FnOnce() -> T + Send + 'static) -> Self {
        let made = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&made);
        rayon::spawn(move || {
            let result = make();
            *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        });
        Ahead(made)
    }

    /// Returns what was made, if the thread is done. It is not waited for, because the calling thread
    /// may be the one that is to make it.
    pub(crate) fn take(&self) -> Option<T> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// Does two pieces of work, at the same time if `threads` share them, and returns both results.
pub(crate) fn both<S: Send, R: Send>(
    threads: Threads,
    one: impl FnOnce() -> S + Send,
    other: impl FnOnce() -> R + Send,
) -> (S, R) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    if threads == Threads::All {
        return rayon::join(one, other);
    }
    let _ = threads;
    (one(), other())
}

/// Returns whether the calling thread is none of the pool, so that it may wait for what these do.
#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
pub(crate) fn is_outside() -> bool {
    rayon::current_thread_index().is_none()
}

/// Runs `own` in the calling thread and the `others` in threads of the pool, at the same time as
/// far as these are free, and returns the results.
pub(crate) fn beside<S, R: Send>(own: impl FnOnce() -> S, others: Vec<impl FnOnce() -> R + Send>) -> (S, Vec<R>) {
    #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
    {
        let mut results: Vec<Option<R>> = others.iter().map(|_| None).collect();
        let result = rayon::in_place_scope(|scope| {
            for (other, result) in others.into_iter().zip(&mut results) {
                scope.spawn(move |_| *result = Some(other()));
            }
            own()
        });
        (result, results.into_iter().flatten().collect())
    }
    #[cfg(not(all(feature = "threads", not(target_arch = "wasm32"))))]
    (own(), others.into_iter().map(|other| other()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_sorted_by_their_upper_halves() {
        for len in [0u64, 1, 2, 1000, 5000] {
            for mask in [0, 7, 0xffff_0000, u64::from(u32::MAX)] {
                let key = |i: u64| (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32 & mask;
                let entries: Vec<u64> = (0..len).map(|i| key(i) << 32 | i).collect();
                let mut expected = entries.clone();
                expected.sort_unstable();
                for threads in [Threads::One, Threads::All] {
                    let mut sorted = entries.clone();
                    sort_keyed(threads, &mut sorted);
                    assert_eq!(sorted, expected);
                }
            }
        }
    }

    #[test]
    fn every_element_is_visited_once() {
        for len in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 5 * CHUNK + 7] {
            for threads in [Threads::One, Threads::All] {
                let mut items = vec![0usize; len];
                for_chunks(threads, &mut items, |start, chunk| {
                    chunk.iter_mut().zip(start..).for_each(|(x, i)| *x += i + 1);
                });
                assert!(items.iter().copied().eq(1..=len));
                for_parts(threads, &mut items, |start, part| {
                    part.iter_mut().zip(start..).for_each(|(x, i)| *x += i);
                });
                assert!(items.iter().copied().eq((0..len).map(|i| 2 * i + 1)));
                assert!(filled(threads, len, 7) == vec![7; len]);
                let mut list = vec![7];
                extend(threads, &mut list, &items);
                assert!(list[0] == 7 && list[1..] == items);
                let ranges = map_ranges(threads, len, |range| range);
                assert!(ranges.into_iter().flatten().eq(0..len));
            }
        }
    }
}
