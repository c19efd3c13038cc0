//! Disjoint sets of numbers.

use crate::parallel::{self, Threads};

/// The number of numbers that is worth handing to another thread.
const GRAIN: usize = 1 << 14;

/// Disjoint sets of the numbers below a count.
#[derive(Debug)]
pub struct DisjointSets {
    /// A number of the same set that is not greater; the number itself if it stands for the set.
    parent: Vec<u32>,
}

impl DisjointSets {
    /// Creates one set for each number.
    pub fn new(count: usize) -> Self {
        DisjointSets { parent: (0..count as u32).collect() }
    }

    /// Creates the sets in which each number is united with those that `lower` returns for it, which have to be below it.
    /// Threads share this work as far as the two numbers are near each other.
    pub fn of_lower<L: Iterator<Item = u32>>(threads: Threads, count: usize, lower: impl Fn(u32) -> L + Sync) -> Self {
        let mut sets = DisjointSets::new(count);
        let mut chunks: Vec<&mut [u32]> = sets.parent.chunks_mut(GRAIN).collect();
        // First each range by itself, with a list of the pairs that lead out of it.
        let leading = parallel::map_mut(threads, &mut chunks, |i, chunk| {
            let start = (i * GRAIN) as u32;
            let mut within = DisjointSets { parent: (0..chunk.len() as u32).collect() };
            let mut leading = Vec::new();
            for i in 0..chunk.len() as u32 {
                for j in lower(start + i) {
                    match j.checked_sub(start) {
                        Some(j) => _ = within.unite(i, j),
                        None => leading.push([start + i, j]),
                    }
                }
            }
            for (i, parent) in (0..).zip(chunk.iter_mut()) {
                *parent = start + within.find(i);
            }
            leading
        });
        for [i, j] in leading.into_iter().flatten() {
            sets.unite(i, j);
        }
        sets
    }

    /// Returns the number that stands for the set of `i`: the lowest.
    pub fn find(&mut self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            // Halves the path.
            let above = self.parent[self.parent[i as usize] as usize];
            self.parent[i as usize] = above;
            i = above;
        }
        i
    }

    /// Returns the number that stands for the set of `i`, as [`find`](Self::find) does, which makes later calls faster.
    pub fn root(&self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            i = self.parent[i as usize];
        }
        i
    }

    /// Unites the sets of two numbers, and returns whether they were two.
    pub fn unite(&mut self, i: u32, j: u32) -> bool {
        let (i, j) = (self.find(i), self.find(j));
        self.parent[i.max(j) as usize] = i.min(j);
        i != j
    }
}
