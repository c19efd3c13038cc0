//! Invariants at the end of Phase 1.

use crate::State;

impl State<2> {
    /// Panics unless every edge is locally Delaunay and no triangle is active.
    pub fn validate_end(&self) {
        self.validate_mesh();
        assert_eq!(self.counters.active_len[self.half()], 0);
    }
}
