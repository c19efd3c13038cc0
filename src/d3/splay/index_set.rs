//! Sets of indices.

/// Some of the vertices or tetrahedra of a triangulation, a bit for each: a million take so little memory that the
/// system provides it at once.
#[derive(Debug, Clone)]
pub(in crate::d3) struct IndexSet {
    words: Vec<u64>,
}

impl IndexSet {
    /// Creates a set without any of `count` indices.
    pub(in crate::d3) fn new(count: usize) -> Self {
        IndexSet { words: vec![0; count.div_ceil(64)] }
    }

    /// Adds an index, unless it is beyond those that the set can have.
    pub(in crate::d3) fn insert(&mut self, i: u32) {
        if let Some(word) = self.words.get_mut(i as usize / 64) {
            *word |= 1 << (i % 64);
        }
    }

    /// Returns whether the set has an index.
    pub(in crate::d3) fn has(&self, i: u32) -> bool {
        self.words.get(i as usize / 64).is_some_and(|word| word >> (i % 64) & 1 != 0)
    }
}
