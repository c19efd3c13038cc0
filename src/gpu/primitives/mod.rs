//! Building blocks that know nothing of triangulations: prefix sums, sorting, compaction.

pub mod compact;
pub mod scan;
pub mod sort;
