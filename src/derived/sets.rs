//! Disjoint sets of numbers.

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

    /// Unites the sets of two numbers, and returns whether they were two.
    pub fn unite(&mut self, i: u32, j: u32) -> bool {
        let (i, j) = (self.find(i), self.find(j));
        self.parent[i.max(j) as usize] = i.min(j);
        i != j
    }
}
