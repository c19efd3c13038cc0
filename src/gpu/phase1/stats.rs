//! What a run of Phase 1 did.

use crate::{
    gpu::layout::Counters,
    stats::{GpuStats, Round, Stopwatch},
};
use std::time::Duration;

/// What a run of Phase 1 did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Phase1Stats {
    /// The insertion rounds, the first with the ordering of the points; then the rounds of the last
    /// flips.
    pub rounds: Vec<Round>,
    /// The points of the start.
    pub start_points: usize,
    /// The kernels' counters.
    pub counters: Counters,
    /// Dispatches.
    pub dispatches: usize,
    /// Submissions.
    pub submits: usize,
    /// Readbacks.
    pub readbacks: usize,
    /// How often the host waited for a readback while the device had nothing else to do.
    pub stalls: usize,
    /// Bytes that were read back.
    pub bytes_read: u64,
    /// The most bytes of GPU memory that were held at a time.
    pub bytes: u64,
    /// The time from the upload to the end of the last kernel, on the host's clock; zero where
    /// there is none.
    pub time: Duration,
    /// The time of the readback of the result, on the host's clock.
    pub readback_time: Duration,
}

impl Phase1Stats {
    /// Returns the same for users, on an adapter of this name.
    pub fn summary(&self, adapter: &str) -> GpuStats {
        let counters = &self.counters;
        GpuStats {
            adapter: adapter.to_owned(),
            rounds: self.rounds.clone(),
            start_points: self.start_points as u64,
            flips_23: counters.flips_23.into(),
            flips_32: counters.flips_32.into(),
            flips_22: counters.flips_22.into(),
            flip_iterations: counters.iterations.into(),
            exact_tests: counters.exact.into(),
            not_locally_delaunay: counters.not_locally_delaunay.into(),
            failed_vertices: counters.failed.into(),
            merged: counters.merged.into(),
            readbacks: self.readbacks as u64,
            stalls: self.stalls as u64,
            bytes_read: self.bytes_read,
            dispatches: self.dispatches as u64,
            submits: self.submits as u64,
            bytes: self.bytes,
        }
    }
}

/// What a run has done so far, and its clocks.
pub(crate) struct Meter {
    pub(crate) stats: Phase1Stats,
    /// The readbacks before the run, and their bytes.
    pub(crate) read_before: (usize, u64),
    /// Since the beginning.
    pub(crate) clock: Stopwatch,
    /// Since the last batch was read.
    pub(crate) round_clock: Stopwatch,
    /// How long a dispatch of the last batch took that was read.
    pub(crate) dispatch_time: Duration,
}

impl Meter {
    /// Takes note of the time and the counters at the end of Phase 1.
    pub(crate) fn end(&mut self, counters: Counters) {
        self.stats.time = self.clock.lap();
        self.stats.counters = counters;
    }
}
