//! How many flip iterations the host records ahead for a round, a dispatch per pass.

/// The iterations to record for a round of which nothing is known: enough for those of uniform
/// points while each round inserts several times as many points as the one before.
const FIRST_PLANNED: u32 = 30;
/// The smallest number of iterations to record for a round, unless one workgroup can do them all.
const MIN_PLANNED: u32 = 6;
/// The largest number: what more there is to do waits for the next round.
const MAX_PLANNED: u32 = 64;
/// How many more to record than an earlier round took.
const MARGIN: u32 = 4;

/// Where few signs are left open, exact checks wait for each other: one alone takes longer than all
/// filters of an iteration. Where they are many, there would be no progress. So they follow the
/// filter in every so many iterations, when the filter leaves at most one sign open for so many
/// visited simplices.
const EXACT_EVERY: [(u32, u64); 3] = [(8, 1024), (4, 16), (2, 3)];

/// In every how many iterations exact checks follow when nothing is known.
const FIRST_EXACT_EVERY: u32 = 4;

/// The flip iterations of a run. An iteration that finds nothing to do costs microseconds, a flip
/// that has to wait for the next round may cost failed vertices.
#[derive(Debug)]
pub(crate) struct Iterations {
    /// To record for a round.
    planned: u32,
    /// Exact checks follow the filter in every so many iterations of a round.
    exact_every: u32,
}

/// What is known of a round that was carried out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Known {
    /// The iterations that it took, of those that were recorded.
    pub(crate) used: u32,
    /// The iterations that were recorded.
    pub(crate) recorded: u32,
    /// The points that are inserted.
    pub(crate) inserted: u32,
    /// The points that wait.
    pub(crate) waiting: u32,
    /// Whether one workgroup can do all flips that are left, those of the waiting points included.
    pub(crate) is_few: bool,
}

impl Iterations {
    /// Creates the plan of a run's first round.
    pub(crate) fn new() -> Self {
        Iterations { planned: FIRST_PLANNED, exact_every: FIRST_EXACT_EVERY }
    }

    /// Plans a round by the one before the last one.
    pub(crate) fn plan(&mut self, known: Known) {
        let Known { used, recorded, inserted, waiting, is_few } = known;
        // Most points are in, will be after the round that is planned, or will not.
        let wanted = match waiting {
            _ if recorded == 0 => self.planned.max(MIN_PLANNED),
            _ if is_few => 0,
            _ if used >= recorded => (used + used / 4 + MARGIN).max(MIN_PLANNED),
            _ if waiting <= inserted / 8 => (used / 3 + MARGIN).max(MIN_PLANNED),
            _ if waiting / 4 <= inserted => (used / 2 + MARGIN).max(MIN_PLANNED),
            _ if waiting / 24 <= inserted => (used / 4 * 3 + MARGIN).max(MIN_PLANNED),
            // The next rounds insert several times as many points, and take more iterations.
            _ => (used + MARGIN).max(FIRST_PLANNED),
        };
        self.planned = wanted.min(MAX_PLANNED);
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
