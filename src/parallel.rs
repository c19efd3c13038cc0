//! Work on slices, shared among the machine's threads where it has any.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// More threads than this do not make a pass over memory any faster.
#[cfg(feature = "gpu")]
const MOST_THREADS: usize = 16;
/// A chunk of this many elements is worth handing to another thread.
const CHUNK: usize = 1 << 16;

/// The threads to use: 1 where there are no threads, as in the browser.
#[cfg(feature = "gpu")]
pub(crate) fn available() -> usize {
    // The system reads files to answer.
    static THREADS: std::sync::OnceLock<usize> = std::sync::OnceLock::new();
    *THREADS.get_or_init(|| std::thread::available_parallelism().map_or(1, usize::from).min(MOST_THREADS))
}

/// Calls `work` with every chunk of `items` and the place where it begins, in up to `threads` threads.
pub(crate) fn for_chunks<T: Send>(threads: usize, items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    let threads = threads.min(items.len().div_ceil(CHUNK));
    if threads <= 1 {
        return work(0, items);
    }
    let queue = Mutex::new(items.chunks_mut(CHUNK).enumerate());
    share(threads, || {
        // The lock is given back before the work begins.
        while let Some((i, chunk)) = next(&queue) {
            work(i * CHUNK, chunk);
        }
    });
}

/// What `work` makes of the ranges that 0 … `len` is cut into, in order, in up to `threads` threads. For elements that cost
/// no more than to look at them.
pub(crate) fn map_ranges<R: Send>(threads: usize, len: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    map_grains(threads, len, CHUNK, work)
}

/// The same for ranges of `grain` elements.
pub(crate) fn map_grains<R: Send>(
    threads: usize,
    len: usize,
    grain: usize,
    work: impl Fn(Range<usize>) -> R + Sync,
) -> Vec<R> {
    let threads = threads.min(len.div_ceil(grain));
    if threads <= 1 {
        return vec![work(0..len)];
    }
    let queue = Mutex::new((0..len).step_by(grain));
    let results = Mutex::new(Vec::with_capacity(len.div_ceil(grain)));
    share(threads, || {
        while let Some(start) = next(&queue) {
            let result = work(start..(start + grain).min(len));
            lock(&results).push((start, result));
        }
    });
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_unstable_by_key(|&(start, _)| start);
    results.into_iter().map(|(_, result)| result).collect()
}

/// Runs `worker` in this thread and in others. One that cannot be started is not missed: the workers take from a queue.
fn share(threads: usize, worker: impl Fn() + Sync) {
    std::thread::scope(|scope| {
        for _ in 1..threads {
            if std::thread::Builder::new().spawn_scoped(scope, &worker).is_err() {
                break;
            }
        }
        worker();
    });
}

fn next<I: Iterator>(queue: &Mutex<I>) -> Option<I::Item> {
    lock(queue).next()
}

/// A poisoned lock is as good as any: a panic in a worker comes out of the scope.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_is_visited_once() {
        for len in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 5 * CHUNK + 7] {
            for threads in [1, 3, 16] {
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
