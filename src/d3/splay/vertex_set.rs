//! Sets of vertices.

/// Some of the vertices of a triangulation, a bit for each: a million take so little memory that the
/// system provides it at once.
#[derive(Debug, Clone)]
pub(super) struct VertexSet {
    words: Vec<u64>,
}

impl VertexSet {
    /// Creates a set without any of `vertices` vertices.
    pub(super) fn new(vertices: usize) -> Self {
        VertexSet { words: vec![0; vertices.div_ceil(64)] }
    }

    /// Adds a vertex.
    pub(super) fn insert(&mut self, v: u32) {
        self.words[v as usize / 64] |= 1 << (v % 64);
    }

    /// Returns whether it has a vertex, and not that at infinity.
    pub(super) fn has(&self, v: u32) -> bool {
        self.words.get(v as usize / 64).is_some_and(|word| word >> (v % 64) & 1 != 0)
    }
}
