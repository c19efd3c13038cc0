//! How many flip iterations are recorded for a round, with a dispatch per pass.
//!
//! An iteration that finds nothing to do costs microseconds; one that is missing leaves its flips to the
//! next round, and may cost failed vertices. A run of as many points as the one before gets what that
//! needed, as long as its rounds insert about as many. Otherwise a round is planned by the last one that
//! is known.

/// The fewest iterations of a round, unless one workgroup can do them all.
const MIN_PLANNED: u32 = 6;
/// The most: what more there is to do waits for the next round.
const MAX_PLANNED: u32 = 80;
/// How many more are recorded than a round is expected to take.
const MARGIN: u32 = 4;
/// While so many times as many points wait as are inserted, each round takes more iterations than
/// the one before.
const RISING: u32 = 48;

/// Where the filter leaves at most one sign open for so many visited simplices, exact checks follow
/// it in every so many iterations only: one of them takes longer than all filters of an iteration.
/// Where many signs are open, there would be no progress without exact checks.
const EXACT_EVERY: [(u32, u64); 3] = [(16, 1024), (4, 16), (2, 3)];

/// In every how many iterations exact checks follow when nothing is known.
const FIRST_EXACT_EVERY: u32 = 4;

/// The number of rounds that are remembered for the next run. Most runs have about ten.
const ROUNDS: usize = 32;

/// A run repeats the one before while the points that are inserted differ by at most one in so many.
const SAME_SHARE: u32 = 16;

/// The flip iterations of a run.
#[derive(Debug)]
pub(crate) struct Iterations {
    /// The iterations of a round without a predecessor.
    first: u32,
    /// The iterations of the next round, by the rounds before it.
    planned: u32,
    /// The period of exact checks after the filter, in iterations.
    exact_every: u32,
    /// The iterations used by this run so far.
    needed: Needed,
    /// The iterations used by the last run, as long as this run repeats it.
    before: Needed,
}

/// The iterations used by a run. The next run of equal size plans with them.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Needed {
    /// The number of points.
    pub(crate) points: u32,
    /// In every how many iterations exact checks followed the filter after the first round; 0 if that is not known.
    exact_every: u32,
    /// How many rounds there were.
    len: usize,
    /// The first rounds.
    rounds: [NeededRound; ROUNDS],
}

/// What a round needed.
#[derive(Debug, Clone, Copy, Default)]
struct NeededRound {
    /// The points that were inserted by its end.
    inserted: u32,
    /// The iterations that it needed with a dispatch per pass.
    iterations: u32,
    /// Whether one workgroup did others, or could have done so: when no points wait, nothing is to be left.
    has_few: bool,
    /// Whether facets were removed that could not be flipped.
    removes: bool,
}

impl Needed {
    /// Returns the entry of a round, if it is known.
    fn round(&self, round: u32) -> Option<NeededRound> {
        self.rounds.get(round as usize).filter(|_| (round as usize) < self.len).copied()
    }
}

/// What is known of a round that was carried out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Known {
    /// The iterations that it took, of those that were recorded.
    pub(crate) used: u32,
    /// The iterations that one workgroup did after them.
    pub(crate) few: u32,
    /// The iterations that were recorded.
    pub(crate) recorded: u32,
    /// The active simplices that it left.
    pub(crate) active: u32,
    /// With fewer of them, flips wait for the next round, or are done by one workgroup.
    pub(crate) min_active: u32,
    /// The points that were inserted before it.
    pub(crate) inserted_before: u32,
    /// The points that are inserted.
    pub(crate) inserted: u32,
    /// The points that wait.
    pub(crate) waiting: u32,
    /// Whether one workgroup can do all flips that are left, those of the waiting points included.
    pub(crate) is_few: bool,
    /// Whether facets were removed that could not be flipped.
    pub(crate) removes: bool,
}

impl Iterations {
    /// Creates the plan of a run's first round by what the run before needed, or with `first` iterations
    /// if there was none of as many points.
    pub(crate) fn new(first: u32, before: Needed) -> Self {
        let exact_every = if before.exact_every == 0 { FIRST_EXACT_EVERY } else { before.exact_every };
        Iterations { first, planned: first, exact_every, needed: Needed::default(), before }
    }

    /// Returns what the run has needed for so many points.
    pub(crate) fn needed(&self, points: u32) -> Needed {
        Needed { points, ..self.needed }
    }

    /// Plans the next round by one that is known.
    pub(crate) fn plan(&mut self, known: Known) {
        let Known { used, few, recorded, active, inserted, waiting, removes, .. } = known;
        if inserted == known.inserted_before && used + few + active == 0 && !removes {
            // The round was submitted before it was known that nothing was left. The next run does without.
            return;
        }
        let round = self.needed.len;
        let repeats = |before: NeededRound| before.inserted.abs_diff(inserted) <= before.inserted / SAME_SHARE;
        if !self.before.round(round as u32).is_some_and(repeats) {
            self.before.len = 0;
        }
        // A round that took all of its iterations may have left flips to the next one.
        let lacked = used >= recorded && active >= known.min_active;
        let iterations = if lacked { used + (used / 4).max(1) } else { used };
        if let Some(needed) = self.needed.rounds.get_mut(round) {
            let has_few = few > 0 || (waiting == 0 && active > 0);
            *needed = NeededRound { inserted, iterations, has_few, removes };
        }
        self.needed.len += 1;
        let wanted = match waiting {
            _ if recorded == 0 => self.planned.max(MIN_PLANNED),
            _ if known.is_few => 0,
            0 => (iterations / 3 + MARGIN).max(MIN_PLANNED),
            _ if waiting / RISING >= inserted => (iterations + iterations / 8 + MARGIN).max(self.first),
            // As fewer points are inserted per point, rounds take fewer iterations.
            _ => (iterations - iterations / 4 + MARGIN).max(MIN_PLANNED),
        };
        self.planned = wanted.min(MAX_PLANNED);
    }

    /// Plans how often exact checks follow the filter, which left `exact` signs of `visits` visited
    /// simplices open.
    pub(crate) fn plan_exact(&mut self, exact: u32, visits: u32) {
        let (exact, visits) = (u64::from(exact), u64::from(visits));
        self.exact_every =
            EXACT_EVERY.iter().find(|(_, for_one)| exact * for_one <= visits).map_or(1, |&(every, _)| every);
        if self.needed.exact_every == 0 {
            self.needed.exact_every = self.exact_every;
        }
    }

    /// Returns how many iterations to record for a round, by its number.
    pub(crate) fn planned(&self, round: u32) -> u32 {
        match self.before.round(round) {
            Some(NeededRound { iterations, .. }) => iterations.min(MAX_PLANNED),
            None => self.planned,
        }
    }

    /// Returns whether the run before, which this one repeats so far, ended after so many rounds.
    pub(crate) fn may_be_done(&self, rounds: u32) -> bool {
        self.before.len > 0 && rounds as usize == self.before.len
    }

    /// Returns how many points the run before, which this one repeats so far, had inserted after a round, by its number.
    pub(crate) fn inserted(&self, round: u32) -> Option<u32> {
        self.before.round(round).map(|before| before.inserted)
    }

    /// Returns whether a round, by its number, may have iterations that one workgroup can do.
    pub(crate) fn may_be_few(&self, round: u32) -> bool {
        self.before.round(round).is_none_or(|before| before.has_few)
    }

    /// Returns whether the run before, which this one repeats so far, removed facets in a round, by its number.
    pub(crate) fn removes(&self, round: u32) -> bool {
        self.before.round(round).is_some_and(|before| before.removes)
    }

    /// Returns whether the run before, which this one repeats so far, left all flips of a round, by its number,
    /// to the next one: then both can be submitted together.
    pub(crate) fn flips_wait(&self, round: u32) -> bool {
        self.before.round(round).is_some_and(|before| before.iterations == 0 && !before.has_few)
            && (round as usize) + 1 < self.before.len
    }

    /// Returns in every how many iterations exact checks follow the filter; only 3D has them apart.
    pub(crate) fn exact_every(&self) -> u32 {
        self.exact_every
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{dimension::Dimension, gpu::dim::Dim};

    /// What rounds have taken on a device when all that they needed was recorded: the points that
    /// each inserted, and its iterations with a dispatch per pass. Without the rounds of the last few points, which
    /// leave their flips to the last one.
    type Rounds = &'static [(u32, u32)];

    /// The input, its points, those inserted before the first of the rounds, and the rounds.
    const MEASURED: [(&str, u32, u32, Rounds); 6] = [
        (
            "uniform",
            1_000_000,
            100,
            &[(590, 14), (4420, 24), (32606, 23), (194223, 19), (494158, 16), (252655, 11), (20894, 6)],
        ),
        (
            "scan of the ground",
            110_000,
            100,
            &[(533, 21), (3118, 30), (13709, 26), (35699, 17), (40810, 12), (14834, 7)],
        ),
        ("bunny", 35_947, 100, &[(475, 17), (2294, 24), (7354, 23), (13547, 18), (10008, 13), (2060, 6)]),
        (
            "sphere",
            1_000_000,
            100,
            &[
                (196, 6),
                (588, 15),
                (1764, 24),
                (5288, 24),
                (15828, 24),
                (47096, 24),
                (133096, 24),
                (290649, 22),
                (329706, 20),
                (148818, 15),
                (25094, 7),
            ],
        ),
        (
            "thin sphere",
            1_000_000,
            100,
            &[(423, 15), (2269, 29), (11903, 27), (65661, 22), (257463, 20), (425940, 17), (208321, 12), (26956, 6)],
        ),
        (
            "grid",
            996_223,
            100,
            &[(583, 12), (4362, 21), (31874, 20), (189261, 19), (480747, 17), (258763, 13), (27663, 8)],
        ),
    ];

    /// Returns what is known of a round that needed so many iterations.
    fn known(needed: u32, recorded: u32, inserted_before: u32, inserted: u32, points: u32) -> Known {
        let active = if needed > recorded { u32::MAX } else { 0 };
        let waiting = points.saturating_sub(inserted);
        let used = needed.min(recorded);
        let (few, min_active, is_few, removes) = (0, 1, false, false);
        Known { used, few, recorded, active, min_active, inserted_before, inserted, waiting, is_few, removes }
    }

    /// The rounds in which most points are inserted get what they need, and not much more.
    #[test]
    fn planned_iterations_are_those_that_rounds_take() {
        for (name, points, mut inserted, rounds) in MEASURED {
            let mut iterations = Iterations::new(Dimension::<3>::FIRST_ITERATIONS, Needed::default());
            // The next round is recorded before the last one is known.
            let mut recorded = iterations.planned(0);
            let (mut lacking, mut idle) = (0, 0);
            for (round, &(added, needed)) in (0..).zip(rounds) {
                let planned = iterations.planned(round + 1);
                (inserted, lacking) = (inserted + added, lacking + needed.saturating_sub(recorded) * (added / 1000));
                idle += recorded.saturating_sub(needed);
                iterations.plan(known(needed, recorded, inserted - added, inserted, points));
                recorded = planned;
            }
            println!("{name}: {lacking} lacking, weighted by thousands of points, {idle} idle");
            assert!(lacking <= points / 300, "{name}: {lacking} lacking");
            assert!(idle <= 12 * rounds.len() as u32, "{name}: {idle} idle");
        }
    }

    /// Returns how many iterations were recorded for the rounds of a measured input, each before the one
    /// that comes before it was known.
    fn recorded(iterations: &mut Iterations, points: u32, mut inserted: u32, rounds: Rounds) -> Vec<u32> {
        let mut recorded = vec![iterations.planned(0)];
        for (round, &(added, needed)) in (0..).zip(rounds) {
            recorded.push(iterations.planned(round + 1));
            inserted += added;
            iterations.plan(known(needed, recorded[round as usize], inserted - added, inserted, points));
        }
        recorded.truncate(rounds.len());
        recorded
    }

    /// A run that repeats others gets what they needed; one that does not forgets them when it is known what
    /// its first round inserted.
    #[test]
    fn repeated_runs_are_planned_by_those_before() {
        let first = Dimension::<3>::FIRST_ITERATIONS;
        for (name, points, inserted, rounds) in MEASURED {
            let needed: Vec<u32> = rounds.iter().map(|&(_, needed)| needed).collect();
            let mut before = Needed::default();
            for _ in 0..4 {
                let mut iterations = Iterations::new(first, before);
                recorded(&mut iterations, points, inserted, rounds);
                before = iterations.needed(points);
            }
            let repeated = recorded(&mut Iterations::new(first, before), points, inserted, rounds);
            assert_eq!(repeated, needed, "{name}");

            // Of the sphere, the first round inserts less than of all others.
            let (other, points, inserted, rounds) = MEASURED[3];
            let mut after = Iterations::new(first, before);
            recorded(&mut after, points, inserted, &rounds[..1]);
            assert_eq!(after.before.len > 0, name == other, "{other} after {name}");
        }
    }

    /// What a run leaves active when no points wait is few as a rule, and the next run takes care of it in the
    /// same round: otherwise it would repeat a round in which nothing happens.
    #[test]
    fn what_was_left_active_at_the_end_is_not_left_again() {
        let (points, few) = (1000, 0);
        let round =
            |recorded, active, inserted| Known { few, active, ..known(recorded, recorded, 900, inserted, points) };
        let mut iterations = Iterations::new(8, Needed::default());
        // While points wait, flips may do so, too. Afterwards there was no dispatch for the few that were left.
        for known in [round(8, 70, 990), round(8, 70, 1000), round(0, 70, 1000), round(0, 0, 1000)] {
            iterations.plan(known);
        }
        let repeated = Iterations::new(8, iterations.needed(points));
        assert_eq!([0, 1, 2, 3, 4].map(|round| repeated.may_be_few(round)), [false, true, true, false, true]);
        assert!(![0, 1, 2, 3, 4].into_iter().any(|round| repeated.flips_wait(round)));
    }

    /// Rounds of the last few points, which leave all flips to the next one, are submitted with that.
    #[test]
    fn rounds_without_flips_are_known_when_they_are_repeated() {
        let points = 1000;
        let round = |recorded, active, inserted| Known { active, ..known(recorded, recorded, 900, inserted, points) };
        let mut iterations = Iterations::new(8, Needed::default());
        for known in [round(8, 0, 990), round(0, 0, 998), round(0, 0, 999), round(8, 0, 1000)] {
            iterations.plan(known);
        }
        let repeated = Iterations::new(8, iterations.needed(points));
        assert_eq!([0, 1, 2, 3, 4].map(|round| repeated.flips_wait(round)), [false, true, true, false, false]);
    }

    /// The next run removes facets in the round after the last flips: one that had nothing to do was in between,
    /// because it was submitted before that was known.
    #[test]
    fn facets_are_removed_right_after_the_last_flips_when_that_is_repeated() {
        let points = 1000;
        let last = known(8, 8, 900, points, points);
        let idle = known(0, 0, points, points, points);
        let mut iterations = Iterations::new(8, Needed::default());
        [last, idle, Known { removes: true, ..idle }].into_iter().for_each(|known| iterations.plan(known));
        let repeated = Iterations::new(8, iterations.needed(points));
        assert_eq!([0, 1, 2].map(|round| repeated.removes(round)), [false, true, false]);
        assert!(repeated.may_be_done(2));
    }
}
