//! Work on slices, shared among the machine's threads if it has several.

use std::ops::Range;

#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
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

/// Calls `work` with every chunk of `items` and the index of its first element.
pub(crate) fn for_chunks<T: Send>(threads: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    if threads == Threads::All && items.len() > CHUNK {
        return items.par_chunks_mut(CHUNK).enumerate().for_each(|(i, chunk)| work(i * CHUNK, chunk));
    }
    let _ = threads;
    work(0, items);
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
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
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

/// Sorts items of which equal ones are indistinguishable.
pub(crate) fn sort<T: Ord + Send>(threads: Threads, items: &mut [T]) {
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    if threads == Threads::All {
        return items.par_sort_unstable();
    }
    let _ = threads;
    items.sort_unstable();
}

/// Returns the results of `work` for each item and its index, in order. For items that are each
/// worth handing to another thread.
pub(crate) fn map_mut<T: Send, R: Send>(
    threads: Threads,
    items: &mut [T],
    work: impl Fn(usize, &mut T) -> R + Sync,
) -> Vec<R> {
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    if threads == Threads::All {
        return items.par_iter_mut().enumerate().with_max_len(1).map(|(i, item)| work(i, item)).collect();
    }
    let _ = threads;
    items.iter_mut().enumerate().map(|(i, item)| work(i, item)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_is_visited_once() {
        for len in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 5 * CHUNK + 7] {
            for threads in [Threads::One, Threads::All] {
                let mut items = vec![0usize; len];
                for_chunks(threads, &mut items, |start, chunk| {
                    chunk.iter_mut().zip(start..).for_each(|(x, i)| *x += i + 1);
                });
                assert!(items.iter().copied().eq(1..=len));
                let ranges = map_ranges(threads, len, |range| range);
                assert!(ranges.into_iter().flatten().eq(0..len));
            }
        }
    }
}
