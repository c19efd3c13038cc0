//! How many flip iterations the host records ahead for a round, and when votes have to be cleared
//! between them.

use crate::gpu::{
    Recorder,
    layout::{BLOCK, Counters},
};

/// Returns the bits of a bidder's number: twice as many as there are slots in `blocks`, because the
/// upper half is for marks.
pub(crate) fn bid_bits(blocks: u32) -> u32 {
    33 - (blocks * BLOCK).leading_zeros()
}

/// The smallest number of iterations to record for a round.
const MIN_PLANNED: u32 = 8;
/// The largest number: what more there is to do waits for the next round.
const MAX_PLANNED: u32 = 64;
/// How many more to record than the last round took.
const MARGIN: u32 = 3;
/// How many more while few points are inserted and each round takes longer than the last one.
const EARLY_MARGIN: u32 = 10;

/// Where few signs are left open, exact checks wait for each other: one alone takes longer than all
/// filters of an iteration. Where they are many, there would be no progress. So they follow the
/// filter in every so many iterations, when the filter leaves at most one sign open for so many
/// visited simplices.
const EXACT_EVERY: [(u32, u64); 2] = [(4, 16), (2, 3)];

/// The flip iterations of a run. An iteration that finds nothing to do costs microseconds, a flip
/// that has to wait for the next round may cost failed vertices.
#[derive(Debug)]
pub(crate) struct Iterations {
    /// To record for a round.
    planned: u32,
    /// An upper bound of the iteration that the kernels count.
    counted: u32,
    /// Exact checks follow the filter in every so many iterations of a round.
    exact_every: u32,
}

impl Iterations {
    /// Creates the plan of a run's first round.
    pub(crate) fn new() -> Self {
        Iterations { planned: MIN_PLANNED, counted: 0, exact_every: EXACT_EVERY[0].0 }
    }

    /// Plans the next round by the counters before and after the last one, of which it returns the
    /// iterations. `waiting` points are left.
    pub(crate) fn plan(&mut self, before: &Counters, after: &Counters, waiting: u32) -> u32 {
        self.counted = after.iteration;
        let used = after.iterations - before.iterations;
        let more = if waiting / 4 > after.inserted { EARLY_MARGIN } else { MARGIN };
        let wanted = if used >= self.planned { 2 * used } else { used + more };
        self.planned = wanted.clamp(MIN_PLANNED, MAX_PLANNED);
        let exact = u64::from(after.exact.wrapping_sub(before.exact));
        let visits = u64::from(after.visits.wrapping_sub(before.visits));
        self.exact_every =
            EXACT_EVERY.iter().find(|(_, for_one)| exact * for_one <= visits).map_or(1, |&(every, _)| every);
        used
    }

    /// Returns in every how many iterations exact checks follow the filter; only 3D has them apart.
    pub(crate) fn exact_every(&self) -> u32 {
        self.exact_every
    }

    /// Counts from the start again: votes are clear.
    pub(crate) fn restart(&mut self) {
        self.counted = 1;
    }

    /// Records the iterations of a round: some `flips`, and `clear` wherever a bid has no room for
    /// the number of the next iteration.
    pub(crate) fn record(
        &mut self,
        recorder: &mut Recorder<'_>,
        bid_bits: u32,
        flips: impl Fn(&mut Recorder<'_>, u32),
        clear: impl Fn(&mut Recorder<'_>),
    ) {
        let last = (1u32 << (32 - bid_bits)) - 2;
        let mut left = self.planned;
        while left > 0 {
            if self.counted >= last {
                clear(recorder);
                self.restart();
            }
            let now = left.min(last - self.counted);
            flips(recorder, now);
            self.counted += now;
            left -= now;
        }
    }
}
