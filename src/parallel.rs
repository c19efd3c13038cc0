//! Work on slices, shared among the machine's threads if it has several.

pub use crate::platform::sharing::Threads;
pub(crate) use crate::platform::sharing::{CHUNK, in_pieces};
#[cfg(feature = "gpu")]
pub(crate) use crate::platform::threads::Ahead;
pub(crate) use crate::platform::threads::{
    beside, both, count, dispose, extend, filled, for_chunk_pairs, for_chunks, for_parts, map_grains, map_mut, sort,
    sort_by, with_threads,
};
use std::{
    ops::Range,
    sync::{Mutex, PoisonError},
};

/// With fewer keys than this, sorting by comparison is faster.
const FEW: usize = 256;

/// Up to this size, one thread sorts faster than several.
const SORTED_BY_ONE: usize = 1 << 17;

/// Splits 0 … `len` into ranges of [`CHUNK`] elements and returns the results of `work` for each,
/// in order. For work of a few instructions per element.
pub(crate) fn map_ranges<R: Send>(threads: Threads, len: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    map_grains(threads, len, CHUNK, work)
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
    pub(crate) fn all(&mut self) -> &mut [T] {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Sorts entries by their upper halves; those with equal ones stay in their order, or come in that of
/// their lower halves.
pub(crate) fn sort_keyed(threads: Threads, entries: &mut [u64]) {
    if count(threads) > 1 && threads == Threads::All && entries.len() > SORTED_BY_ONE {
        return sort(threads, entries);
    }
    if entries.len() < FEW {
        return entries.sort_unstable();
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
    fn results_come_in_order() {
        for threads in [Threads::One, Threads::All] {
            let mut items: Vec<String> = (0..1000).map(|i| i.to_string()).collect();
            let lengths = map_mut(threads, &mut items, |i, item| {
                item.push('!');
                (i, item.len())
            });
            assert!(lengths.into_iter().eq((0..1000).map(|i: usize| (i, i.to_string().len() + 1))));
            let (mut one, mut other) = (0, "left");
            let results = both(threads, || std::mem::replace(&mut one, 5), || std::mem::replace(&mut other, "right"));
            assert_eq!((results, one, other), ((0, "left"), 5, "right"));
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
