//! What a round of Phase 1 consists of.

use crate::gpu::phase1::stages::Stage;

/// The flip iterations for what could not be flipped before: most of it cannot be flipped now, either, and
/// leaves the list in the first one.
const AGAIN_ITERATIONS: u32 = 4;

/// A round that is to be recorded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoundPlan {
    /// Whether the run goes on from a mesh whose points have moved, so that none are inserted.
    pub(crate) has_moved: bool,
    /// Whether facets are removed if nothing else is left to do.
    pub(crate) removes: bool,
    /// The flip iterations with a dispatch per pass. Those that find nothing to do cost microseconds.
    pub(crate) iterations: u32,
    /// Every so many iterations, exact arithmetic decides what the filter has left open; also in the last
    /// iteration of fewer.
    pub(crate) exact_every: u32,
    /// Whether one workgroup does the iterations of few simplices that follow.
    pub(crate) takes_few: bool,
}

impl RoundPlan {
    /// Returns the stages of the round in their order.
    pub(crate) fn stages(self) -> Vec<Stage> {
        let mut stages = vec![Stage::Begin];
        if !self.has_moved {
            stages.push(Stage::Insert);
        }
        if self.removes {
            stages.push(Stage::Remove);
        }
        self.append_flips(&mut stages, self.iterations);
        if self.has_moved {
            stages.push(Stage::Again);
            self.append_flips(&mut stages, self.iterations.min(AGAIN_ITERATIONS));
        } else {
            stages.push(Stage::Relocate);
        }
        stages
    }

    fn append_flips(self, stages: &mut Vec<Stage>, iterations: u32) {
        for i in 1..=iterations {
            stages.push(Stage::Check);
            let is_last = i == iterations && i < self.exact_every;
            if i.is_multiple_of(self.exact_every) || is_last {
                stages.push(Stage::CheckExactly);
            }
            stages.push(Stage::Flip);
        }
        if self.takes_few {
            stages.push(Stage::FlipFew);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Stage::{Again, Begin, Check, CheckExactly, Flip, FlipFew, Insert, Relocate, Remove};

    const ROUND: RoundPlan =
        RoundPlan { has_moved: false, removes: false, iterations: 0, exact_every: 2, takes_few: false };

    #[test]
    fn points_are_inserted_and_flips_follow() {
        let round = RoundPlan { iterations: 3, takes_few: true, ..ROUND };
        let flips = [Check, Flip, Check, CheckExactly, Flip, Check, Flip, FlipFew];
        assert_eq!(round.stages(), [&[Begin, Insert][..], &flips, &[Relocate]].concat());
    }

    /// Otherwise the round would decide nothing that the filter leaves open.
    #[test]
    fn the_last_of_few_iterations_checks_exactly() {
        let round = RoundPlan { iterations: 1, exact_every: 8, ..ROUND };
        assert_eq!(round.stages(), [Begin, Insert, Check, CheckExactly, Flip, Relocate]);
    }

    #[test]
    fn facets_are_removed_before_the_flips_that_this_makes_possible() {
        let round = RoundPlan { removes: true, iterations: 1, exact_every: 1, ..ROUND };
        assert_eq!(round.stages(), [Begin, Insert, Remove, Check, CheckExactly, Flip, Relocate]);
    }

    #[test]
    fn points_that_have_moved_are_not_inserted_again() {
        let round = RoundPlan { has_moved: true, iterations: 1, exact_every: 1, ..ROUND };
        assert_eq!(round.stages(), [Begin, Check, CheckExactly, Flip, Again, Check, CheckExactly, Flip]);
    }
}
