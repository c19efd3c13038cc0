//! How many flip iterations the host records ahead for a round, and when votes have to be cleared between them.

use crate::gpu::{
    Recorder,
    layout::{BLOCK, Counters},
};

/// The bits of a bidder's number: twice as many as there are slots in `blocks`, because the upper half is for marks.
pub(crate) fn bid_bits(blocks: u32) -> u32 {
    33 - (blocks * BLOCK).leading_zeros()
}

/// Iterations to record for a round, at least.
const FEWEST: u32 = 8;
/// And at most.
const MOST: u32 = 64;

/// The flip iterations of a run. An iteration that finds nothing to do costs microseconds, a flip that has to wait for the next
/// round may cost failed vertices.
#[derive(Debug)]
pub(crate) struct Iterations {
    /// To record for a round.
    planned: u32,
    /// An upper bound of the iteration that the kernels count.
    counted: u32,
}

impl Iterations {
    pub(crate) fn new() -> Self {
        Iterations { planned: FEWEST, counted: 0 }
    }

    /// Plans the next round by the counters before and after the last one, of which it gives the iterations. `waiting` points
    /// are left.
    pub(crate) fn plan(&mut self, before: &Counters, after: &Counters, waiting: u32) -> u32 {
        self.counted = after.iteration;
        let used = after.iterations - before.iterations;
        // While few points are in, each round takes longer than the last one.
        let more = if waiting / 4 > after.inserted { 10 } else { 3 };
        let wanted = if used >= self.planned { 2 * used } else { used + more };
        self.planned = wanted.clamp(FEWEST, MOST);
        used
    }

    /// Votes are clear.
    pub(crate) fn restart(&mut self) {
        self.counted = 1;
    }

    /// Records those of a round: some `flips`, and `clear` wherever a bid has no room for the number of the next iteration.
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
