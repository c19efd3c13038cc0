//! What splaying and the device exchange: stars of the mesh one way, what has changed the other.

use crate::{
    d3::{
        gpu::{
            buffers::Gathering,
            host::{Begin, Work3},
            outputs::{MadeArrays, OutputParams, SlotMesh},
        },
        splay::{Gathered, NAMED_SHIFT, Patch, SLOT},
    },
    dimension::Dimension,
    error::Error,
    gpu::{
        Gpu, Pending, Recorder, Storage,
        host::{Host, Merged, Work},
        layout::{Active, Counters, PARAM_WORDS},
        phase1::{Copied, Copies, Ended, Memory, Phase1Run, Slot, Stage},
        shader::constants::d3,
        workgroups,
    },
};
use bytemuck::Pod;

/// The most elements of a list that are read before it is known how many there are: enough for what
/// is gathered of a million uniform points, and 1.2 MB.
const AHEAD: usize = 1 << 15;

/// The fewest: less takes no less time.
const LEAST_AHEAD: usize = 1 << 14;

/// As [`AHEAD`] where points have moved, which leaves more to splaying.
const AHEAD_OF_MOVED: usize = 1 << 17;

/// Returns how many elements of a list are read ahead for so many points.
fn ahead(points: usize, has_moved: bool) -> usize {
    if has_moved { (points / 4).clamp(LEAST_AHEAD, AHEAD_OF_MOVED) } else { (points / 16).clamp(LEAST_AHEAD, AHEAD) }
}

const _: () = assert!(NAMED_SHIFT == d3::NAMED_SHIFT);

/// Where the number of gathered tetrahedra is, in words of the control buffer.
const GATHERED: usize = PARAM_WORDS + std::mem::offset_of!(Counters, gathered) / 4;

/// The tetrahedra that are read for each further star: as a rule more than it has.
const PER_STAR: usize = 32;

/// A list of which the first elements are being read.
struct Ahead<T> {
    source: Storage<T>,
    first: Pending<T>,
}

impl<T: Pod> Ahead<T> {
    fn copy(copies: &mut Copies<'_>, source: &Storage<T>, len: usize) -> Self {
        Ahead { source: source.clone(), first: copies.copy(source, len.min(source.len())) }
    }
}

/// What is gathered, as far as it is being read.
struct Gathering3 {
    count: Pending<u32>,
    tetrahedra: Ahead<Slot>,
    neighbors: Ahead<Slot>,
    slots: Ahead<u32>,
}

impl Gathering3 {
    /// Records gathering, and that its result is read.
    fn record(copies: &mut Copies<'_>, memory: &Memory<3>, ahead: usize, workgroups: u32) -> Self {
        let (bound, own) = (&memory.bound, &memory.buffers.own);
        let control = &memory.buffers.control;
        copies.recorder.encoder().clear_buffer(control.buffer(), 4 * GATHERED as u64, Some(4));
        bound.record(&mut copies.recorder, Stage::Gather, workgroups);
        let aliases = &bound.aliases;
        Gathering3 {
            count: copies.copy_from(control, GATHERED, 1),
            tetrahedra: Ahead::copy(copies, &aliases.gathered_tetrahedra, ahead),
            neighbors: Ahead::copy(copies, &aliases.gathered_neighbors, ahead),
            slots: Ahead::copy(copies, &own.gathered_slots, ahead),
        }
    }
}

/// The mesh on the device at the end of Phase 1.
pub(crate) struct ResidentRun<'a> {
    pub(crate) ended: Ended<'a, 3>,
}

impl<'a> ResidentRun<'a> {
    /// Ends the run, and gathers what splaying begins with. `host` prepares while the device is at work.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(super) async fn end(run: Phase1Run<'a, 3>, host: &mut impl Host<3>) -> Result<(Self, Begin), Error> {
        let gather = Gathering { first: 1, patched: 0 };
        let (gpu, points) = (run.gpu(), run.control().0.infinite as usize);
        let workgroups = run.workgroups();
        run.buffers().own.gathering.write(gpu, 0, &[gather]);
        let ahead = ahead(points, run.has_moved());
        let record = |copies: &mut Copies<'_>, memory: &Memory<3>| {
            let gathering = Gathering3::record(copies, memory, ahead, workgroups);
            let aliases = &memory.bound.aliases;
            let (failed, uncertain) = (&aliases.failed, &aliases.uncertain);
            (gathering, Ahead::copy(copies, failed, ahead), Ahead::copy(copies, uncertain, ahead))
        };
        let prepare = || host.work().map(|work| Dimension::<3>::prepare(work, points));
        let (ended, submission, (gathering, failed, uncertain), _) = run.end(record, prepare).await?;
        let slots = ended.len();
        if slots > SLOT as usize {
            return Err(Error::TooManySimplices { limit: SLOT as usize });
        }
        let (failed_len, uncertain_len) = (ended.counters.failed as usize, ended.counters.uncertain as usize);
        let mut device = ResidentRun { ended };
        let gathered = device.receive(&submission, gathering, spare(host)).await?;
        let mut failed = device.receive_list(&submission, failed, failed_len).await?;
        let uncertain: Vec<Active> = device.receive_list(&submission, uncertain, uncertain_len).await?;

        if failed.iter().any(|&v| v as usize >= points) || uncertain.iter().any(|entry| entry.tet as usize >= slots) {
            return Err(gpu.wrong("a failed vertex or an uncertain tetrahedron is none"));
        }
        failed.sort_unstable();
        let mut uncertain: Vec<u32> = uncertain.into_iter().map(|Active { tet, .. }| tet).collect();
        uncertain.sort_unstable();
        Ok((device, Begin { gathered, failed, uncertain, merged: Merged::default(), slots }))
    }

    /// Receives what is gathered, in the memory of `spare`, and reads the rest of it if there is more than was read
    /// ahead.
    async fn receive(
        &mut self,
        submission: &wgpu::SubmissionIndex,
        gathering: Gathering3,
        spare: Gathered,
    ) -> Result<Gathered, Error> {
        let Gathering3 { count, tetrahedra, neighbors, slots } = gathering;
        let len = self.ended.len();
        let Ended { gpu, kernels, stats, .. } = &mut self.ended;
        let gpu: &Gpu = gpu;
        let mut copied = Copied { readback: &mut kernels.readback, gpu, submission: submission.clone() };
        let count = copied.receive(count).await?[0] as usize;
        if count > tetrahedra.source.len() {
            return Err(gpu.wrong("more is gathered than there is"));
        }
        let mut rest = None;
        let ahead = tetrahedra.first.len();
        if count > ahead {
            stats.submits += 1;
            let readback = &mut *copied.readback;
            let submitted = gpu.with_error_scope("gathered stars", || {
                let mut copies = Copies { readback, gpu, recorder: Recorder::new(gpu, None) };
                let len = count - ahead;
                let lists = (
                    copies.copy_from(&tetrahedra.source, ahead, len),
                    copies.copy_from(&neighbors.source, ahead, len),
                    copies.copy_from(&slots.source, ahead, len),
                );
                Ok((copies.recorder.submit(gpu), lists))
            });
            rest = Some(submitted.await?);
        }
        let (tetrahedra, neighbors, slots) =
            (tetrahedra.first.first(count), neighbors.first.first(count), slots.first.first(count));
        // Both go to the same list.
        let (tetrahedra, neighbors, slots) = match rest {
            Some((submission, more)) => {
                copied.submission = submission;
                (tetrahedra.then(more.0), neighbors.then(more.1), slots.then(more.2))
            }
            None => (tetrahedra, neighbors, slots),
        };
        let gathered = Gathered {
            tetrahedra: copied.receive_into(tetrahedra, spare.tetrahedra).await?,
            neighbors: copied.receive_into(neighbors, spare.neighbors).await?,
            slots: copied.receive_into(slots, spare.slots).await?,
        };
        if gathered.slots.iter().any(|slot| (slot & SLOT) as usize >= len) {
            return Err(gpu.wrong("a gathered tetrahedron is none"));
        }
        Ok(gathered)
    }

    /// Receives a list, and reads the rest of it if it has more than was read ahead.
    async fn receive_list<T: Pod>(
        &mut self,
        submission: &wgpu::SubmissionIndex,
        ahead: Ahead<T>,
        len: usize,
    ) -> Result<Vec<T>, Error> {
        let Ended { gpu, kernels, stats, .. } = &mut self.ended;
        let mut list = kernels.readback.receive(gpu, submission, ahead.first.first(len)).await?;
        if len > list.len() {
            stats.submits += 1;
            list.extend(kernels.readback.read(gpu, &ahead.source, list.len(), len - list.len()).await?);
        }
        Ok(list)
    }

    /// Returns the tetrahedra at `vertices` that it has not returned before, numbered from `first` on, in the memory
    /// of `spare`.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(crate) async fn gather(&mut self, vertices: &[u32], first: u32, spare: Gathered) -> Result<Gathered, Error> {
        let Ended { gpu, kernels, memory, stats, workgroups, .. } = &mut self.ended;
        let gpu: &Gpu = gpu;
        let own = &memory.buffers.own;
        let mut wanted = vec![0u32; own.wanted.len()];
        let ahead = vertices.len().saturating_mul(PER_STAR).clamp(LEAST_AHEAD, AHEAD);
        vertices.iter().for_each(|&v| wanted[v as usize / 32] |= 1 << (v % 32));
        let (submission, gathering) = gpu
            .with_error_scope("gathering stars", || {
                own.wanted.write(gpu, 0, &wanted);
                own.gathering.write(gpu, 0, &[Gathering { first, patched: 0 }]);
                let mut copies = Copies { readback: &mut kernels.readback, gpu, recorder: Recorder::new(gpu, None) };
                let gathering = Gathering3::record(&mut copies, memory, ahead, *workgroups);
                stats.dispatches += copies.recorder.dispatches();
                stats.submits += 1;
                Ok((copies.recorder.submit(gpu), gathering))
            })
            .await?;
        self.receive(&submission, gathering, spare).await
    }

    /// Writes back what splaying has changed, and makes the arrays of the caller's mesh. Reads the hull as well if `reads_hull`.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManySimplices`] if the device has no room for the change, and those of
    /// [`OutputStage::run`](crate::d3::gpu::outputs::OutputStage::run).
    pub(crate) async fn outputs(
        &mut self,
        patch: &Patch,
        duplicate_of: &[u32],
        reads_hull: bool,
    ) -> Result<MadeArrays, Error> {
        let Ended { gpu, kernels, memory, stats, finite, counters, .. } = &mut self.ended;
        let gpu: &Gpu = gpu;
        let (bound, buffers) = (&memory.bound, &memory.buffers);
        let aliases = &bound.aliases;
        let limit = aliases.tets.len();
        if patch.len > limit {
            return Err(Error::TooManySimplices { limit });
        }
        let write = |recorder: &mut Recorder<'_>| {
            let count = patch.slots.len() as u32;
            if count == 0 {
                return;
            }
            buffers.own.gathering.write(gpu, 0, &[Gathering { first: 0, patched: count }]);
            buffers.own.gathered_slots.write(gpu, 0, &patch.slots);
            aliases.gathered_tetrahedra.write(gpu, 0, &patch.tetrahedra);
            aliases.gathered_neighbors.write(gpu, 0, &patch.neighbors);
            bound.record(recorder, Stage::Patch, workgroups(count));
        };
        let [more, more_ghosts] = patch.more;
        let params = OutputParams {
            count: patch.len as u32,
            infinite: buffers.points.pairs.len() as u32,
            finite: finite.wrapping_add_signed(more) as u32,
            hull: (counters.ghosts as usize).wrapping_add_signed(more_ghosts) as u32,
        };
        let mesh = SlotMesh {
            tetrahedra: &aliases.tets,
            neighbors: &aliases.neighbors,
            marks: &buffers.numbering.marks,
            numbers: &buffers.numbering.numbers,
            params,
        };
        let made = kernels.outputs.run(gpu, &mut kernels.readback, write, mesh, duplicate_of, reads_hull).await?;
        stats.dispatches += made.dispatches;
        stats.submits += 1;
        Ok(made)
    }

    /// Reads the tetrahedra of the mesh back, and their neighbours, to look at them.
    ///
    /// # Errors
    ///
    /// Those of [`Phase1Run::advance`].
    pub(crate) async fn read(&mut self) -> Result<[Vec<Slot>; 2], Error> {
        let len = self.ended.len();
        let Ended { gpu, kernels, memory, stats, .. } = &mut self.ended;
        let aliases = &memory.bound.aliases;
        stats.submits += 2;
        let tetrahedra = kernels.readback.read(gpu, &aliases.tets, 0, len).await?;
        Ok([tetrahedra, kernels.readback.read(gpu, &aliases.neighbors, 0, len).await?])
    }
}

/// Returns memory that the host has for what is gathered.
pub(super) fn spare(host: &mut impl Host<3>) -> Gathered {
    host.work().map_or_else(Gathered::default, Work3::spare)
}
