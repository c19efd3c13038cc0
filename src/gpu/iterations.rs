//! How many flip iterations the host records ahead for a round, a dispatch per pass.

/// The smallest number of iterations to record for a round.
const MIN_PLANNED: u32 = 8;
/// The largest number: what more there is to do waits for the next round.
const MAX_PLANNED: u32 = 64;
/// How many more to record than the last round took.
const MARGIN: u32 = 3;
/// The same while few points are in, when each round takes longer than the last one.
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
    /// Exact checks follow the filter in every so many iterations of a round.
    exact_every: u32,
}

impl Iterations {
    /// Creates the plan of a run's first round.
    pub(crate) fn new() -> Self {
        Iterations { planned: MIN_PLANNED, exact_every: EXACT_EVERY[0].0 }
    }

    /// Plans the next rounds by one that took `used` of `recorded` iterations. `is_early` says that
    /// most points still wait.
    pub(crate) fn plan(&mut self, used: u32, recorded: u32, is_early: bool) {
        let more = if is_early { EARLY_MARGIN } else { MARGIN };
        let wanted = if used >= recorded { 2 * used } else { used + more };
        self.planned = wanted.clamp(MIN_PLANNED, MAX_PLANNED);
    }

    /// Plans how often exact checks follow the filter, which left `exact` signs of `visits` visited
    /// simplices open.
    pub(crate) fn plan_exact(&mut self, exact: u32, visits: u32) {
        let (exact, visits) = (u64::from(exact), u64::from(visits));
        self.exact_every =
            EXACT_EVERY.iter().find(|(_, for_one)| exact * for_one <= visits).map_or(1, |&(every, _)| every);
    }

    /// Returns how many iterations to record for a round.
    pub(crate) fn planned(&self) -> u32 {
        self.planned
    }

    /// Returns in every how many iterations exact checks follow the filter; only 3D has them apart.
    pub(crate) fn exact_every(&self) -> u32 {
        self.exact_every
    }
}
