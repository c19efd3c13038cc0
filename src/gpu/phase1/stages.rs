//! The stages of Phase 1: a table of kernels for each.

use crate::{
    dimension::Dimension,
    error::Error,
    gpu::{
        Compiler, Gpu, Recorder, Storage,
        phase1::{
            buffers::Buffers,
            finish::{Aliases, Finish},
        },
        primitives::scan::{BoundScan, Scan, ScanParams},
        steps::{BoundSteps, Step, Steps},
    },
    input::lattice::Width,
};

/// A sequence of kernels that are recorded together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Frees the slots of new blocks.
    FillFree,
    /// Makes the simplices of the start, and finds out which of them each point lies in.
    Start,
    /// Decides by the counters what the round does.
    Begin,
    /// Picks a point for each simplex, splits it there, and moves the other points on (§3.1).
    Insert,
    /// Checks which flips are possible, as far as the filter decides.
    Check,
    /// Decides exactly what the filter left open. In 2D, the check before does both.
    CheckExactly,
    /// Carries the flips out that won all their simplices, and links what they made.
    Flip,
    /// Iterates check and flip where few simplices are active.
    FlipFew,
    /// Has what could not be flipped checked again: a flip beside an inverted simplex may wait for another.
    Again,
    /// Lets bids start from the lowest number again.
    ClearVotes,
    /// Moves waiting points along the history of the flips (§4.1).
    Relocate,
    /// Removes facets that could not be flipped, with those beside them (multi-face removal, de Cougny and
    /// Shephard 1995). Fewer vertices have failed afterwards.
    Remove,
    /// Marks the simplices of the mesh; in 3D also the failed vertices (§3.2.1).
    Mark,
    /// Copies the marked simplices without gaps, checks what comes of it, and notes what rounding leaves open.
    Compact,
    /// Gathers the simplices of the stars that are wanted.
    Gather,
    /// Writes changed simplices back.
    Patch,
}

impl Stage {
    /// All of them, in the order of their numbers.
    const ALL: [Stage; 16] = [
        Stage::FillFree,
        Stage::Start,
        Stage::Begin,
        Stage::Insert,
        Stage::Check,
        Stage::CheckExactly,
        Stage::Flip,
        Stage::FlipFew,
        Stage::Again,
        Stage::ClearVotes,
        Stage::Relocate,
        Stage::Remove,
        Stage::Mark,
        Stage::Compact,
        Stage::Gather,
        Stage::Patch,
    ];

    /// Returns the kernels.
    fn steps(self) -> &'static [Step] {
        match self {
            Stage::FillFree => const { &[Step::new("free slots", "fill_free").only_3d()] },
            Stage::Start => {
                const {
                    &[
                        Step::new("start", "start_vertices"),
                        Step::new("start", "start_mesh"),
                        Step::new("locate", "locate"),
                    ]
                }
            }
            Stage::Begin => const { &[Step::new("begin round", "begin_round").in_one_workgroup()] },
            Stage::Insert => {
                const {
                    &[
                        Step::new("pick", "pick_score"),
                        Step::new("pick", "pick_point"),
                        Step::new("split", "split"),
                        Step::new("relocate after splits", "relocate_split"),
                    ]
                }
            }
            Stage::Check => const { &[Step::new("flip: check", "flip_check")] },
            Stage::CheckExactly => const { &[Step::new("flip: check exactly", "flip_check_exact").only_3d()] },
            Stage::Flip => const { &[Step::new("flip: commit", "flip_commit"), Step::new("flip: link", "flip_link")] },
            // It has all of the exact arithmetic, and is by far the slowest to compile.
            Stage::FlipFew => {
                const { &[Step::new("flip: few", "flip_few").in_one_workgroup().only_3d().only_whole().deferred()] }
            }
            Stage::Again => const { &[Step::new("flip: again", "moved_again").only_3d().on_demand()] },
            Stage::ClearVotes => const { &[Step::new("clear votes", "clear_votes").on_demand()] },
            Stage::Relocate => const { &[Step::new("relocate", "relocate")] },
            Stage::Remove => {
                const {
                    &[
                        Step::new("remove facets", "removals_find").only_3d().only_whole().deferred(),
                        Step::new("remove facets", "removals_commit").only_3d().only_whole().deferred(),
                        Step::new("remove facets", "removals_link").only_3d().only_whole().deferred(),
                    ]
                }
            }
            Stage::Mark => {
                const { &[Step::new("mark failed", "mark_failed").only_3d(), Step::new("mark mesh", "mesh_mark")] }
            }
            Stage::Compact => {
                const {
                    &[
                        Step::new("compact mesh", "mesh_number").only_3d(),
                        Step::new("compact mesh", "mesh_compact"),
                        Step::new("check mesh", "mesh_sum"),
                        Step::new("certify", "certify").only_3d(),
                    ]
                }
            }
            Stage::Gather => {
                const { &[Step::new("gather", "gather_list").only_3d(), Step::new("gather", "gather_copy").only_3d()] }
            }
            Stage::Patch => const { &[Step::new("patch", "patch").only_3d()] },
        }
    }
}

/// Takes a mesh whose points have moved, in place of the first rounds: its simplices go to slots, and those
/// that are not positively oriented or not locally Delaunay any more are counted. The kernels are compiled
/// when a mesh is updated for the first time.
const MOVED: &[Step] = &[
    Step::new("moved mesh", "moved_mesh").on_demand(),
    Step::new("moved mesh", "moved_ghosts").on_demand(),
    Step::new("moved mesh", "moved_signs").on_demand(),
    Step::new("moved mesh", "moved_facets").on_demand(),
];

/// The kernels of all stages.
#[derive(Debug)]
pub(crate) struct Stages {
    steps: [Steps; Stage::ALL.len()],
    /// [`MOVED`], which is bound to the buffers of the caller's mesh.
    pub(crate) moved: Steps,
    /// Numbers the simplices that [`Stage::Mark`] has marked.
    scan: Scan,
}

/// The kernels of all stages with their bind groups.
#[derive(Debug)]
pub(crate) struct BoundStages<const D: usize>
where
    Dimension<D>: Finish<D>,
{
    steps: [BoundSteps; Stage::ALL.len()],
    scan: BoundScan,
    /// The names that buffers have at the end.
    pub(crate) aliases: <Dimension<D> as Finish<D>>::Aliases,
}

impl Stages {
    /// Creates the kernels of `D` dimensions.
    pub(crate) fn new<const D: usize>(compiler: &Compiler<'_>, width: Width) -> Self
    where
        Dimension<D>: Finish<D>,
    {
        Stages {
            steps: Stage::ALL.map(|stage| Steps::new::<D>(compiler, width, stage.steps())),
            moved: Steps::new::<D>(compiler, width, MOVED),
            scan: Scan::new(compiler),
        }
    }

    /// Returns whether a run has this stage, and its kernels are compiled by now.
    pub(crate) fn can(&self, stage: Stage) -> bool {
        self.steps[stage as usize].are_compiled()
    }

    /// Binds the kernels to these buffers.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Storage::new`].
    pub(crate) fn bind<const D: usize>(&self, gpu: &Gpu, b: &Buffers<D>) -> Result<BoundStages<D>, Error>
    where
        Dimension<D>: Finish<D>,
    {
        let count = ScanParams { count: b.simplices.len() as u32 };
        let params = Storage::with_contents(gpu, "scan parameters", &[count])?;
        let scan = self.scan.bind(gpu, &params, &b.numbering.marks, &b.numbering.numbers)?;
        let aliases = <Dimension<D> as Finish<D>>::Aliases::new(b);
        let mut buffers = b.bindings();
        buffers.extend(aliases.bindings());
        buffers.push(("sums", scan.sums().buffer()));
        let steps = self.steps.each_ref().map(|steps| steps.bind(&buffers));
        Ok(BoundStages { steps, scan, aliases })
    }
}

impl<const D: usize> BoundStages<D>
where
    Dimension<D>: Finish<D>,
{
    /// Records a stage.
    pub(crate) fn record(&self, recorder: &mut Recorder<'_>, stage: Stage, workgroups: u32) {
        self.steps[stage as usize].record(recorder, workgroups);
    }

    /// Records the end of Phase 1: the mesh without gaps, and what is open about it.
    pub(crate) fn record_end(&self, recorder: &mut Recorder<'_>, workgroups: u32) {
        self.record(recorder, Stage::Mark, workgroups);
        self.scan.record(recorder);
        self.record(recorder, Stage::Compact, workgroups);
    }

    /// Returns the sums of the scan; their entry [`GROUPS`](crate::gpu::primitives::scan::GROUPS)
    /// is the number of finite simplices.
    pub(crate) fn sums(&self) -> &Storage<u32> {
        self.scan.sums()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_stand_in_the_order_of_their_numbers() {
        assert!((0..).zip(Stage::ALL).all(|(number, stage)| number == stage as usize));
    }
}
