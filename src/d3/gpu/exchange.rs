//! What splaying and the device exchange: stars of the mesh one way, what has changed the other.

use crate::{
    d3::{
        gpu::{
            buffers::Gathering,
            outputs::{Made, OutputParams, SlotMesh},
        },
        splay::{Aborted, Doubts, Gathered, INCIDENT_SHIFT, IndexSet, Patch, Region, SLOT},
    },
    error::Error,
    gpu::{
        Gpu, Pending, Recorder, Storage,
        device_mesh::DeviceArrays,
        layout::{Active, Counters, PARAM_WORDS},
        phase1::{Copied, Copies, Ended, Memory, Run, Slot, Stage},
        shader::constants::d3,
        workgroups,
    },
    index::NO_INDEX,
    parallel::Threads,
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

const _: () = assert!(INCIDENT_SHIFT == d3::INCIDENT_SHIFT);

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

/// What splaying begins with, as it comes from the device.
pub(crate) struct Start {
    region: Region,
    gathered: Gathered,
    /// The failed vertices.
    failed: Vec<u32>,
    /// The slots of the uncertain tetrahedra, ascending.
    uncertain: Vec<u32>,
}

/// The same, in a region.
pub(crate) struct Begun {
    /// The stars of the failed vertices and of those of uncertain tetrahedra.
    pub(crate) region: Region,
    /// Where the mesh may not be Delaunay; nothing is missing yet.
    pub(crate) doubts: Doubts,
}

/// The mesh on the device at the end of Phase 1.
pub(crate) struct Device<'a> {
    pub(crate) ended: Ended<'a, 3>,
}

impl<'a> Device<'a> {
    /// Ends the run, and gathers what splaying begins with. The host does `meanwhile` before it waits for the device.
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`].
    pub(crate) async fn end(mut run: Run<'a, 3>, meanwhile: impl FnOnce()) -> Result<(Self, Start), Error> {
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
        let kept = run.take_host().take();
        let prepare = || {
            meanwhile();
            Region::again(kept, points, Threads::All)
        };
        let (ended, submission, (gathering, failed, uncertain), mut region) = run.end(record, prepare).await?;
        if ended.len() > SLOT as usize {
            return Err(Error::TooManySimplices { limit: SLOT as usize });
        }
        let (failed_len, uncertain_len) = (ended.counters.failed as usize, ended.counters.uncertain as usize);
        let mut device = Device { ended };
        let gathered = device.receive(&submission, gathering, &mut region).await?;
        let mut failed = device.receive_list(&submission, failed, failed_len).await?;
        let uncertain: Vec<Active> = device.receive_list(&submission, uncertain, uncertain_len).await?;

        failed.sort_unstable();
        let mut uncertain: Vec<u32> = uncertain.into_iter().map(|Active { tet, .. }| tet).collect();
        uncertain.sort_unstable();
        Ok((device, Start { region, gathered, failed, uncertain }))
    }

    /// Receives what is gathered, in memory that `region` has for it, and reads the rest of it if there is more than
    /// was read ahead.
    async fn receive(
        &mut self,
        submission: &wgpu::SubmissionIndex,
        gathering: Gathering3,
        region: &mut Region,
    ) -> Result<Gathered, Error> {
        let Gathering3 { count, tetrahedra, neighbors, slots } = gathering;
        let Ended { gpu, kernels, stats, .. } = &mut self.ended;
        let gpu: &Gpu = gpu;
        let mut copied = Copied { readback: &mut kernels.readback, gpu, submission: submission.clone() };
        let count = copied.receive(count).await?[0] as usize;
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
        let spare = region.spare();
        Ok(Gathered {
            tetrahedra: copied.receive_into(tetrahedra, spare.tetrahedra).await?,
            neighbors: copied.receive_into(neighbors, spare.neighbors).await?,
            slots: copied.receive_into(slots, spare.slots).await?,
        })
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

    /// Returns the tetrahedra at `vertices` that it has not returned before, numbered on from those of `region`.
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`].
    pub(crate) async fn gather(&mut self, vertices: &[u32], region: &mut Region) -> Result<Gathered, Error> {
        let Ended { gpu, kernels, memory, stats, workgroups, .. } = &mut self.ended;
        let gpu: &Gpu = gpu;
        let own = &memory.buffers.own;
        let mut wanted = vec![0u32; own.wanted.len()];
        let ahead = vertices.len().saturating_mul(PER_STAR).clamp(LEAST_AHEAD, AHEAD);
        vertices.iter().for_each(|&v| wanted[v as usize / 32] |= 1 << (v % 32));
        let (submission, gathering) = gpu
            .with_error_scope("gathering stars", || {
                own.wanted.write(gpu, 0, &wanted);
                own.gathering.write(gpu, 0, &[Gathering { first: region.next(), patched: 0 }]);
                let mut copies = Copies { readback: &mut kernels.readback, gpu, recorder: Recorder::new(gpu, None) };
                let gathering = Gathering3::record(&mut copies, memory, ahead, *workgroups);
                stats.dispatches += copies.recorder.dispatches();
                stats.submits += 1;
                Ok((copies.recorder.submit(gpu), gathering))
            })
            .await?;
        self.receive(&submission, gathering, region).await
    }

    /// Writes back what splaying has changed.
    ///
    /// # Errors
    ///
    /// Returns [`Error::TooManySimplices`] if the device has no room for it.
    pub(crate) async fn patch(&mut self, patch: &Patch) -> Result<(), Error> {
        let Ended { gpu, memory, stats, .. } = &mut self.ended;
        let gpu: &Gpu = gpu;
        let (bound, own) = (&memory.bound, &memory.buffers.own);
        let aliases = &bound.aliases;
        let limit = aliases.tets.len();
        if patch.len > limit {
            return Err(Error::TooManySimplices { limit });
        }
        if patch.slots.is_empty() {
            return Ok(());
        }
        gpu.with_error_scope("what splaying has changed", || {
            let count = patch.slots.len() as u32;
            own.gathering.write(gpu, 0, &[Gathering { first: 0, patched: count }]);
            own.gathered_slots.write(gpu, 0, &patch.slots);
            aliases.gathered_tetrahedra.write(gpu, 0, &patch.tetrahedra);
            aliases.gathered_neighbors.write(gpu, 0, &patch.neighbors);
            let mut recorder = Recorder::new(gpu, None);
            bound.record(&mut recorder, Stage::Patch, workgroups(count));
            stats.dispatches += recorder.dispatches();
            stats.submits += 1;
            recorder.submit(gpu);
            Ok(())
        })
        .await
    }

    /// Makes the arrays of the caller's mesh, which has changed by `patch`. Returns the hull as well if
    /// `reads_hull`.
    ///
    /// # Errors
    ///
    /// Those of [`OutputStage::run`](crate::d3::gpu::outputs::OutputStage::run).
    pub(crate) async fn outputs(
        &mut self,
        patch: &Patch,
        reads_hull: bool,
    ) -> Result<(DeviceArrays, Vec<[u32; 3]>), Error> {
        let Ended { gpu, kernels, memory, stats, finite, counters, .. } = &mut self.ended;
        let (aliases, buffers) = (&memory.bound.aliases, &memory.buffers);
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
        let Made { arrays, hull, dispatches } =
            kernels.outputs.run(gpu, &mut kernels.readback, mesh, reads_hull).await?;
        stats.dispatches += dispatches;
        stats.submits += 1;
        Ok((arrays, hull))
    }

    /// Reads the tetrahedra of the mesh back, and their neighbours, to look at them.
    ///
    /// # Errors
    ///
    /// Those of [`Run::advance`].
    pub(crate) async fn read(&mut self) -> Result<[Vec<Slot>; 2], Error> {
        let len = self.ended.len();
        let Ended { gpu, kernels, memory, stats, .. } = &mut self.ended;
        let aliases = &memory.bound.aliases;
        stats.submits += 2;
        let tetrahedra = kernels.readback.read(gpu, &aliases.tets, 0, len).await?;
        Ok([tetrahedra, kernels.readback.read(gpu, &aliases.neighbors, 0, len).await?])
    }
}

impl Start {
    /// Adds what was gathered to the region, which has nothing yet. Returns it with the doubts by its numbers.
    ///
    /// # Errors
    ///
    /// Returns [`Aborted::Inconsistent`] if what was gathered does not fit.
    pub(crate) fn begin(self) -> Result<Begun, Aborted> {
        let Start { mut region, gathered, failed, uncertain } = self;
        let infinite = region.infinite();
        let first = region.next();
        let mut numbers = vec![NO_INDEX; uncertain.len()];
        // Most tetrahedra are certain, which a bit tells sooner than a search.
        let mut is_uncertain = IndexSet::new(uncertain.last().map_or(0, |&t| t as usize + 1));
        uncertain.iter().for_each(|&t| is_uncertain.insert(t));
        for (number, word) in (first..).zip(&gathered.slots).filter(|(_, word)| is_uncertain.has(**word & SLOT)) {
            if let Ok(i) = uncertain.binary_search(&(word & SLOT)) {
                numbers[i] = number;
            }
        }
        if numbers.contains(&NO_INDEX) {
            return Err(Aborted::Inconsistent("an uncertain tetrahedron was not gathered"));
        }
        let uncertain = numbers;
        let corners = uncertain.iter().flat_map(|&t| gathered.tetrahedra[(t - first) as usize]);
        let stars: Vec<u32> = corners.filter(|&v| v != infinite).chain(failed.iter().copied()).collect();
        region.add(stars, gathered, Threads::All)?;
        Ok(Begun { region, doubts: Doubts { failed, uncertain, missing: Vec::new() } })
    }
}
