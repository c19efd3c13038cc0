//! What a run of Phase 1 does next: a function of the counters that were read, without a device.
//!
//! The host submits batches of rounds before it knows what the last ones did. [`Plan::next_batch`] says
//! what a batch consists of, [`Plan::read`] takes in the counters after the oldest batch that was
//! submitted.

use crate::{
    gpu::{
        layout::{Counters, LOGGED, Params, SLOTS_FULL},
        phase1::{
            iterations::{Iterations, Known, Needed},
            round::RoundPlan,
        },
    },
    stats,
};
use std::collections::VecDeque;

/// How many points a round inserts per point that is inserted, as a rule at most: hardly more of
/// its simplices have points to pick from.
const GROWTH: u32 = 5;

/// The flip iterations that are recorded at first where points have moved: a million points that moved by
/// a five-hundredth of their spacing take so many.
const MOVED_ITERATIONS: u32 = 12;

/// Votes are cleared when the lowest bid is so high: a quarter of the numbers that are left by then
/// suffices for all rounds that may be submitted before.
const CLEAR_VOTES_FROM: u32 = 1 << 30;

/// What does not change during a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    /// The parameters of the kernels.
    pub(crate) params: Params,
    /// The vertices of a simplex.
    pub(crate) corners: u32,
    /// The flip iterations of a round of which nothing is known.
    pub(crate) first_iterations: u32,
    /// The rounds of a batch, unless hardly any flips are expected of them.
    pub(crate) rounds: usize,
    /// Rounds that insert no more points than this are submitted together.
    pub(crate) together: u32,
    /// The batches that are submitted before the counters of the first one are read.
    pub(crate) batches: usize,
    /// Whether facets can be removed that could not be flipped.
    pub(crate) removes: bool,
}

/// Rounds that are submitted together, with what comes before them.
#[derive(Debug)]
pub(crate) struct Batch {
    /// Whether they are the first, so that the start has to be made.
    pub(crate) is_first: bool,
    /// Whether slots have run out and more are added.
    pub(crate) grows: bool,
    /// Whether bids start from the lowest number again.
    pub(crate) clears_votes: bool,
    pub(crate) rounds: Vec<RoundPlan>,
}

/// A batch of which the counters were not read yet.
#[derive(Debug)]
struct Ahead(Vec<RoundPlan>);

impl Ahead {
    /// Returns whether facets are removed in one of the rounds.
    fn removes(&self) -> bool {
        self.0.iter().any(|round| round.removes)
    }
}

/// The state of a run, as far as the host knows it.
#[derive(Debug)]
pub(crate) struct Plan {
    rules: Rules,
    /// The counters as they were last read.
    counters: Counters,
    iterations: Iterations,
    /// Whether the run goes on from a mesh whose points have moved, so that no round inserts any.
    has_moved: bool,
    /// The rounds that were submitted.
    rounds: u32,
    /// Those of them that were submitted before slots were added.
    rounds_before_growth: u32,
    /// About the most points that can be inserted after them.
    inserted_at_most: u32,
    /// Whether the next round is to remove facets.
    removes: bool,
    /// The batches that were submitted and not read, oldest first.
    ahead: VecDeque<Ahead>,
}

impl Plan {
    /// Creates the plan of a run that inserts all points into a start of `start_points` of them. `before`
    /// is what the last run of as many points needed.
    pub(crate) fn new(rules: Rules, start_points: u32, before: Needed) -> Self {
        Plan {
            rules,
            counters: first_counters(rules.params.infinite),
            iterations: Iterations::new(rules.first_iterations, before),
            has_moved: false,
            rounds: 0,
            rounds_before_growth: 0,
            inserted_at_most: start_points,
            removes: false,
            ahead: VecDeque::new(),
        }
    }

    /// Creates the plan of a run that goes on from a mesh whose points have moved.
    pub(crate) fn of_moved(rules: Rules) -> Self {
        let iterations = Iterations::new(MOVED_ITERATIONS, Needed::default());
        Plan { iterations, has_moved: true, ..Plan::new(rules, rules.params.infinite, Needed::default()) }
    }

    /// Returns what does not change during the run.
    pub(crate) fn rules(&self) -> &Rules {
        &self.rules
    }

    /// Returns the counters as they were last read.
    pub(crate) fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Sets the counters without any round before.
    pub(crate) fn set_counters(&mut self, counters: Counters) {
        self.counters = counters;
    }

    /// Returns whether the run goes on from a mesh whose points have moved.
    pub(crate) fn has_moved(&self) -> bool {
        self.has_moved
    }

    /// Returns the number of points that are not inserted yet.
    pub(crate) fn waiting(&self) -> u32 {
        self.rules.params.infinite - self.counters.inserted - self.counters.merged
    }

    /// Returns what the next run of as many points is to know, if this one inserted its points.
    pub(crate) fn needed(&self) -> Option<Needed> {
        (!self.has_moved).then(|| self.iterations.needed(self.rules.params.infinite))
    }

    /// Returns whether the counters of a batch are to be read before the next one is submitted.
    ///
    /// While the device works on a batch, the next one is submitted, so that the device never waits; but not
    /// behind the batch that the run before ended with.
    pub(crate) fn is_far_ahead(&self) -> bool {
        // One batch of flips is as a rule enough for points that have moved.
        let batches = if self.has_moved { 1 } else { self.rules.batches.max(1) };
        self.ahead.len() >= batches || (!self.ahead.is_empty() && self.iterations.may_be_done(self.rounds))
    }

    /// Returns whether there is more to do.
    pub(crate) fn goes_on(&self) -> bool {
        !self.is_flipped() || self.is_to_remove()
    }

    /// Returns whether all points are inserted, and no flip is left.
    fn is_flipped(&self) -> bool {
        self.waiting() == 0 && self.counters.active() == 0
    }

    /// Returns whether facets are to be removed at the end, which happens once.
    fn is_to_remove(&self) -> bool {
        self.is_flipped() && self.can_remove() && self.counters.removals == 0
    }

    fn can_remove(&self) -> bool {
        self.rules.removes && !self.has_moved
    }

    /// Plans the next batch, which is submitted.
    pub(crate) fn next_batch(&mut self) -> Batch {
        let is_first = self.rounds == 0 && !self.has_moved;
        // Rounds that were submitted before slots were added may still say that there were too few.
        let Counters { overflow, round, bid_base, .. } = self.counters;
        let grows = !is_first && overflow & SLOTS_FULL != 0 && round > self.rounds_before_growth;
        if grows {
            self.rounds_before_growth = self.rounds;
        }
        let clears_votes = !is_first && bid_base > CLEAR_VOTES_FROM;
        let (mut rounds, mut goes_on) = (Vec::new(), true);
        let limit = self.rules.rounds.clamp(1, LOGGED);
        let inserted_before = self.inserted_at_most;
        while rounds.len() < limit || (self.rules.batches > 1 && goes_on && rounds.len() < LOGGED) {
            let round = self.next_round();
            // Rounds that take hardly any time are submitted with the next one.
            let takes_no_time = self.next_flips_are_few() || self.iterations.flips_wait(self.rounds);
            self.inserted_at_most = self.inserted_after_next();
            self.rounds += 1;
            rounds.push(round);
            let inserted = self.inserted_after_next().saturating_sub(inserted_before);
            goes_on = takes_no_time || (self.is_another_certain() && inserted <= self.rules.together);
        }
        self.ahead.push_back(Ahead(rounds.clone()));
        Batch { is_first, grows, clears_votes, rounds }
    }

    /// Returns whether the rounds that were submitted leave something to the next one, as far as one can know.
    fn is_another_certain(&self) -> bool {
        let is_repeated = self.iterations.inserted(self.rounds).is_some();
        let is_begun = !self.iterations.may_be_done(self.rounds) && self.inserted_at_most < self.rules.params.infinite;
        !self.has_moved && (is_repeated || is_begun)
    }

    /// Returns about how many points are inserted after the next round, at most.
    fn inserted_after_next(&self) -> u32 {
        let known = self.iterations.inserted(self.rounds);
        known.unwrap_or(self.inserted_at_most.saturating_mul(1 + GROWTH))
    }

    /// Returns whether one workgroup does all flips of the next round: the first ones have few.
    fn next_flips_are_few(&self) -> bool {
        self.inserted_at_most.saturating_mul(GROWTH * self.rules.corners) <= self.rules.params.few_limit
    }

    fn next_round(&mut self) -> RoundPlan {
        let removes = std::mem::take(&mut self.removes) || (self.can_remove() && self.iterations.removes(self.rounds));
        RoundPlan {
            has_moved: self.has_moved,
            removes,
            iterations: if self.next_flips_are_few() { 0 } else { self.iterations.planned(self.rounds) },
            exact_every: self.iterations.exact_every(),
            takes_few: self.rules.params.few > 0 && self.iterations.may_be_few(self.rounds),
        }
    }

    /// Takes in the counters after the oldest batch. Returns what its rounds did, without their times.
    ///
    /// # Errors
    ///
    /// Returns what is wrong with counters that no device writes that computes rightly, as when a round made no progress.
    pub(crate) fn read(&mut self, read: Counters) -> Result<Vec<stats::Round>, &'static str> {
        let points = self.rules.params.infinite;
        if !fits(&read, points) {
            return Err("more points are inserted than there are");
        }
        let before = std::mem::replace(&mut self.counters, read);
        let Some(Ahead(planned)) = self.ahead.pop_front() else { return Ok(Vec::new()) };
        let removals = read.removals > before.removals;
        let mut rounds = Vec::new();
        let mut last = before.progress();
        for (round, planned) in (before.round + 1..).zip(planned) {
            // The state after the last round of a batch is that which was read.
            let is_last = round == read.round;
            let now = if is_last { read.progress() } else { read.log[round as usize % LOGGED] };
            if !follows(last, now) || now[0] > points - read.merged {
                return Err("the counters of a round do not follow those before");
            }
            let known = self.known(last, now, planned.iterations, planned.removes && removals);
            rounds.push(stats::Round {
                inserted: known.inserted - known.inserted_before,
                active: known.active,
                flips: now[2] - last[2],
                iterations: known.used + known.few,
                ..stats::Round::default()
            });
            if known.inserted == known.inserted_before && known.waiting > 0 {
                return Err("an insertion round inserted nothing");
            }
            self.iterations.plan(known);
            last = now;
        }
        self.iterations.plan_exact(read.exact.wrapping_sub(before.exact), read.visits.wrapping_sub(before.visits));
        self.removes = self.is_to_remove() && !self.ahead.iter().any(Ahead::removes);
        Ok(rounds)
    }

    /// Returns what is known of a round by the [`Counters::progress`] before and after it.
    fn known(&self, before: [u32; 5], after: [u32; 5], recorded: u32, removes: bool) -> Known {
        let [inserted_before, _, _, iterations_before, few_before] = before;
        let [inserted, active, _, iterations, few] = after;
        let few = few - few_before;
        let waiting = self.rules.params.infinite - inserted - self.counters.merged;
        let left = waiting.saturating_mul(self.rules.corners).saturating_add(active);
        Known {
            used: iterations - iterations_before - few,
            few,
            recorded,
            active,
            min_active: self.min_active(inserted_before),
            inserted_before,
            inserted,
            waiting,
            is_few: left <= self.rules.params.few_limit,
            removes,
        }
    }

    /// Returns the number of active simplices below which the iterations of a round end that begins with so
    /// many points inserted.
    fn min_active(&self, inserted: u32) -> u32 {
        let Rules { params, .. } = &self.rules;
        let waits = inserted + self.counters.merged < params.infinite;
        let min_active = if waits { self.counters.min_active(params, inserted) } else { 0 };
        min_active.max(params.few.saturating_add(1))
    }
}

/// Returns whether no more points are inserted or merged than there are.
fn fits(counters: &Counters, points: u32) -> bool {
    counters.inserted.checked_add(counters.merged).is_some_and(|known| known <= points)
}

/// Returns whether a round may lead from one [`Counters::progress`] to another: only the active simplices become fewer.
fn follows([inserted, _, flips, iterations, few]: [u32; 5], now: [u32; 5]) -> bool {
    let [more_inserted, more_flips, more_iterations, more_few] =
        [(now[0], inserted), (now[2], flips), (now[3], iterations), (now[4], few)]
            .map(|(now, last)| now.checked_sub(last));
    more_inserted.is_some() && more_flips.is_some() && more_iterations >= more_few && more_few.is_some()
}

/// Returns the counters before the first round, where so many points wait.
pub(crate) fn first_counters(waiting: u32) -> Counters {
    Counters { bid_base: 1, entries: waiting, ..Counters::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: u32 = 100_000;
    /// So many that the flips of the first round are not few.
    const START: u32 = 500;

    fn rules() -> Rules {
        let params = Params { infinite: POINTS, few: 256, few_limit: 1024, max_min_active: 1000, ..Params::default() };
        Rules { params, corners: 4, first_iterations: 30, rounds: 1, together: 1 << 16, batches: 2, removes: true }
    }

    /// A device without geometry: a round inserts five points per point, and leaves nothing active.
    struct Device(Counters);

    impl Device {
        fn run(&mut self, batch: &Batch) -> Counters {
            for round in &batch.rounds {
                let counters = &mut self.0;
                counters.round += 1;
                let more = (GROWTH * counters.inserted).min(POINTS - counters.inserted);
                counters.inserted += more;
                counters.flips_23 += 3 * more;
                counters.iterations += if more > 0 { round.iterations.min(12) } else { 0 };
                counters.removals += u32::from(round.removes && more == 0);
                counters.log[counters.round as usize % LOGGED] = counters.progress();
            }
            self.0
        }
    }

    fn start() -> (Plan, Device) {
        let (plan, inserted) = (Plan::new(rules(), START, Needed::default()), START);
        let device = Device(Counters { inserted, ..first_counters(POINTS) });
        (plan, device)
    }

    /// Runs to the end. Returns what was read of each round, and the batches.
    fn run(plan: &mut Plan, device: &mut Device) -> (Vec<stats::Round>, Vec<Batch>) {
        let (mut rounds, mut batches, mut pending) = (Vec::new(), Vec::new(), VecDeque::new());
        loop {
            while !plan.is_far_ahead() {
                let batch = plan.next_batch();
                pending.push_back(device.run(&batch));
                batches.push(batch);
            }
            rounds.extend(plan.read(pending.pop_front().expect("a batch was submitted")).expect("progress"));
            if !plan.goes_on() {
                return (rounds, batches);
            }
        }
    }

    #[test]
    fn a_run_ends_when_all_points_are_inserted_and_facets_were_removed_once() {
        let (mut plan, mut device) = start();
        let (rounds, batches) = run(&mut plan, &mut device);
        assert_eq!((plan.waiting(), plan.goes_on()), (0, false));
        assert_eq!(rounds.iter().map(|round| round.inserted).sum::<u32>(), POINTS);
        assert_eq!(plan.counters().removals, 1);
        assert_eq!(batches.iter().flat_map(|batch| &batch.rounds).filter(|round| round.removes).count(), 1);
        assert_eq!(batches.iter().map(|batch| batch.is_first).collect::<Vec<_>>().iter().filter(|is| **is).count(), 1);
    }

    #[test]
    fn a_run_that_repeats_another_does_not_go_beyond_its_end() {
        let (mut plan, mut device) = start();
        run(&mut plan, &mut device);
        assert!(!plan.ahead.is_empty(), "nobody knew when the first run ends");
        let mut again = Plan::new(rules(), START, plan.needed().expect("points were inserted"));
        let (_, batches) = run(&mut again, &mut Device(Counters { inserted: START, ..first_counters(POINTS) }));
        assert!(again.ahead.is_empty(), "{batches:?}");
    }

    #[test]
    fn the_next_batch_is_submitted_before_the_last_one_is_read() {
        let (mut plan, mut device) = start();
        let first = plan.next_batch();
        assert!(!plan.is_far_ahead());
        plan.next_batch();
        assert!(plan.is_far_ahead());
        plan.read(device.run(&first)).expect("progress");
        assert!(!plan.is_far_ahead());
    }

    /// One workgroup does the flips of the first two. The fifth round may insert 32,400 points, the sixth more than
    /// there are, so that nobody knows of a seventh.
    #[test]
    fn rounds_of_few_points_are_submitted_together() {
        let mut plan = Plan::new(rules(), 5, Needed::default());
        let planned = |batch: Batch| batch.rounds.iter().map(|round| round.iterations).collect::<Vec<_>>();
        assert_eq!(planned(plan.next_batch()), [0, 0, 30, 30, 30]);
        assert_eq!([planned(plan.next_batch()), planned(plan.next_batch())], [[30], [30]]);
    }

    /// Where a run repeats another, it is known what its rounds insert, and which is the last.
    #[test]
    fn rounds_that_are_known_to_insert_few_points_are_submitted_together() {
        let (mut plan, mut device) = start();
        run(&mut plan, &mut device);
        let needed = plan.needed().expect("points were inserted");
        let mut again = Plan::new(rules(), START, needed);
        let (_, batches) = run(&mut again, &mut Device(Counters { inserted: START, ..first_counters(POINTS) }));
        // 2,500 and 15,000 points; 82,000; then facets are removed.
        assert_eq!(batches.iter().map(|batch| batch.rounds.len()).collect::<Vec<_>>(), [2, 1, 1]);
    }

    #[test]
    fn slots_are_added_once_for_what_rounds_before_say() {
        let (mut plan, mut device) = start();
        let batches = [plan.next_batch(), plan.next_batch()];
        device.0.overflow = SLOTS_FULL;
        let read: Vec<Counters> = batches.iter().map(|batch| device.run(batch)).collect();
        plan.read(read[0]).expect("progress");
        assert!(plan.next_batch().grows);
        plan.read(read[1]).expect("progress");
        assert!(!plan.next_batch().grows, "the round was submitted before there were more slots");
    }

    #[test]
    fn votes_are_cleared_before_bids_run_out() {
        let (mut plan, mut device) = start();
        let batch = plan.next_batch();
        assert!(!batch.clears_votes);
        device.0.bid_base = CLEAR_VOTES_FROM + 1;
        plan.read(device.run(&batch)).expect("progress");
        assert!(plan.next_batch().clears_votes);
    }

    #[test]
    fn a_round_that_inserts_nothing_is_an_error() {
        for is_stuck in [false, true] {
            let (mut plan, mut device) = start();
            let start = device.0;
            let batch = plan.next_batch();
            let read = device.run(&batch);
            let stuck = Counters { round: read.round, log: [start.progress(); LOGGED], ..start };
            // The first round counts those that the start has as well.
            assert_eq!((batch.rounds.len(), plan.read(if is_stuck { stuck } else { read }).is_err()), (2, is_stuck));
        }
    }

    #[test]
    fn points_that_have_moved_are_flipped_in_one_batch() {
        let mut plan = Plan::of_moved(rules());
        let batch = plan.next_batch();
        assert!(plan.is_far_ahead() && !batch.is_first);
        assert_eq!((batch.rounds[0].has_moved, batch.rounds[0].iterations), (true, MOVED_ITERATIONS));
        assert!(plan.needed().is_none());
    }
}
