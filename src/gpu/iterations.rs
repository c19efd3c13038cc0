//! How many flip iterations the host records ahead for a round, a dispatch per pass.

/// The iterations to record for a round of which nothing is known: enough for those of uniform
/// points while each round inserts several times as many points as the one before.
const FIRST_PLANNED: u32 = 28;
/// The smallest number of iterations to record for a round.
const MIN_PLANNED: u32 = 6;
/// The largest number: what more there is to do waits for the next round.
const MAX_PLANNED: u32 = 64;
/// How many more to record than an earlier round took.
const MARGIN: u32 = 3;

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
        Iterations { planned: FIRST_PLANNED, exact_every: EXACT_EVERY[0].0 }
    }

    /// Plans a round by the one before the last one, which took `used` of `recorded` iterations and
    /// after which `inserted` points are inserted and others wait.
    pub(crate) fn plan(&mut self, used: u32, recorded: u32, inserted: u32, waiting: u32) {
        if recorded == 0 {
            return;
        }
        // Most points are in, will be after the round that is planned, or will not.
        let (is_late, is_middle) = (waiting / 4 <= inserted, waiting / 24 <= inserted);
        let wanted = match used {
            _ if used >= recorded => 2 * used,
            _ if is_late => used / 2 + MARGIN,
            _ if is_middle => used / 4 * 3 + MARGIN,
            // The next rounds insert several times as many points, and take more iterations.
            _ => (used + MARGIN).max(FIRST_PLANNED),
        };
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
