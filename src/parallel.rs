//! Work on slices, shared among the machine's threads where it has any.

use std::ops::Range;

#[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
use rayon::prelude::*;

/// The threads that share a piece of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Threads {
    /// The calling one.
    One,
    /// Those of rayon's pool; the calling one where there are no others, as in the browser.
    All,
}

/// A chunk of this many elements is worth handing to another thread.
const CHUNK: usize = 1 << 13;

/// Calls `work` with every chunk of `items` and the place where it begins.
pub(crate) fn for_chunks<T: Send>(threads: Threads, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    if threads == Threads::All && items.len() > CHUNK {
        return items.par_chunks_mut(CHUNK).enumerate().for_each(|(i, chunk)| work(i * CHUNK, chunk));
    }
    let _ = threads;
    work(0, items);
}

/// What `work` makes of the ranges that 0 … `len` is cut into, in order. For elements that cost no more than to look at
/// them.
pub(crate) fn map_ranges<R: Send>(threads: Threads, len: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    map_grains(threads, len, CHUNK, work)
}

/// The same for ranges of `grain` elements.
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

/// Sorts items that are equal only if they are the same.
pub(crate) fn sort<T: Ord + Send>(threads: Threads, items: &mut [T]) {
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    if threads == Threads::All {
        return items.par_sort_unstable();
    }
    let _ = threads;
    items.sort_unstable();
}

/// What `work` makes of each item and its place, in order. For items that are worth handing to another thread.
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
