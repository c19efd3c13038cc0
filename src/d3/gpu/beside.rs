//! Completes a mesh in the memory of the host, which reads the arrays while it splays.
//!
//! The arrays come as Phase 1 leaves them. Splaying gathers the stars that it needs, as for a mesh that stays on the
//! device, and its patch is then applied to the arrays.

use crate::{
    d3::{
        Mesh3,
        gpu::{
            exchange::ResidentRun,
            stars::{Splayed, splay},
            trace::Tracer,
        },
        splay::{KEEP, Patch, SLOT},
        triangulation::{Closing, FiniteMesh, Gaps, MAX_TETRAHEDRA, Triangulation3, state},
    },
    error::Error,
    gpu::{
        Gpu, Storage,
        engine::{MadeMesh, Near},
        host::Host,
        phase1::{Aliases as _, Phase1Run, Slot, WayToHost},
        progress,
        readback::{Pace, Readback, Target},
        room::fitted,
    },
    index::NONE,
    parallel::{self, Threads},
    platform,
    slots::{self, share, unshare},
    stats::{Fallback, Phase},
};
use pollster::block_on;
use std::sync::atomic::Ordering::Relaxed;

/// With fewer slots, a mesh is read sooner than the first stars are gathered.
const LEAST_SLOTS: usize = 1 << 20;

/// Above so many exact signs per point, too many vertices fail: points on a sphere need 42, those of a scan 6, and those
/// of a grid 1. To gather so many stars takes longer than to read the mesh.
const MOST_EXACT: u32 = 16;

/// The number of changed slots that a thread takes at a time.
const GRAIN: usize = 1 << 11;

/// Returns whether the host reads the mesh of a run while it splays.
pub(super) fn pays(run: &Phase1Run<'_, 3>) -> bool {
    let (params, counters) = run.control();
    let slots = run.buffers().simplices.len();
    slots <= SLOT as usize
        && match run.settings().way_to_host {
            Some(way) => way == WayToHost::ReadMeanwhile,
            None => slots >= LEAST_SLOTS && counters.exact / MOST_EXACT < params.infinite,
        }
}

/// Ends the run, and makes the mesh of the arrays, which another thread reads while this one splays.
pub(super) async fn complete<H: Host<3>>(
    run: Phase1Run<'_, 3>,
    mut near: Near<'_, H, 3>,
    mut tracer: Option<Tracer>,
) -> Result<Result<MadeMesh<3>, Fallback>, Error> {
    let (mut device, begin) = ResidentRun::end(run, near.host).await?;
    let reading = Arrays::of(&mut device);
    let mut splayed = None;
    let own = || splayed = Some(block_on(splay(&mut device, begin, &mut near, &mut tracer)));
    let ((), mut read) = parallel::beside(own, vec![move || block_on(reading.read())]);
    let splayed = splayed.ok_or(Error::Cancelled)??;
    near.stats.phases.push((Phase::Splay, near.stopwatch.lap()));
    let (triangulation, readback) = read.swap_remove(0)?;
    device.ended.kernels.readback.add(&readback);
    device.ended.stats.submits += readback.count();
    let finite = device.ended.finite;
    near.stats.gpu = Some(device.ended.release().summary(near.adapter));
    let Splayed { patch, duplicate_of } = match splayed {
        Ok(splayed) => splayed,
        Err(fallback) => return Ok(Err(fallback)),
    };
    near.stats.phases.push((Phase::Readback, near.stopwatch.lap()));

    near.options.report(Phase::Finish, progress::FINISH)?;
    let FiniteMesh { tetrahedra, neighbors, hull } = patched(triangulation, finite, &patch)?;
    near.stats.phases.push((Phase::Finish, near.stopwatch.lap()));
    near.stats.trace = tracer.map(|tracer| tracer.finish(&tetrahedra));
    let mesh = Mesh3 { tetrahedra, neighbors, hull, duplicate_of, dimension: 3, ..Mesh3::default() };
    Ok(Ok(MadeMesh::Host(mesh)))
}

/// The arrays of a mesh that are to be read.
struct Arrays<'a> {
    gpu: &'a Gpu,
    readback: Readback,
    arrays: [Storage<Slot>; 2],
    lists: [Vec<Slot>; 2],
    infinite: u32,
    /// The number of finite tetrahedra, which come first.
    finite: u32,
}

impl<'a> Arrays<'a> {
    fn of(device: &mut ResidentRun<'a>) -> Self {
        let ended = &mut device.ended;
        let len = ended.len();
        Arrays {
            gpu: ended.gpu,
            readback: ended.kernels.readback.fork(),
            arrays: ended.memory.bound.aliases.arrays(),
            lists: ended.take_rooms().map(|room| fitted(room, len)),
            infinite: ended.memory.buffers.points.pairs.len() as u32,
            finite: ended.finite as u32,
        }
    }

    /// Reads the mesh. Its neighbours are numbers of tetrahedra, without facets, and [`NONE`] in the place of ghosts.
    async fn read(mut self) -> Result<(Triangulation3, Readback), Error> {
        let [tetrahedra, neighbors] = &mut self.lists;
        let reads = self.arrays.into_iter().zip([
            Words { list: bytemuck::cast_slice_mut(tetrahedra), end: None },
            Words { list: bytemuck::cast_slice_mut(neighbors), end: Some(self.finite) },
        ]);
        self.readback.read_at(self.gpu, reads.collect(), Pace::BESIDE).await?;
        let [tetrahedra, neighbors] = self.lists;
        Ok((Triangulation3::new(tetrahedra, neighbors, self.infinite), self.readback))
    }
}

/// Words of an array in memory.
struct Words<'a> {
    list: &'a mut [u32],
    /// For neighbours, 4·number + facet, the number from which on they are ghosts: only the numbers of others remain. A
    /// pass of its own would take as long as the copy.
    end: Option<u32>,
}

impl Target for Words<'_> {
    fn bytes(&self) -> u64 {
        size_of_val(&*self.list) as u64
    }

    fn take(&mut self, start: u64, len: u64, piece: &wgpu::BufferView) {
        let list = &mut self.list[start as usize / 4..(start + len) as usize / 4];
        let Some(end) = self.end else { return platform::gpu::copy(piece, bytemuck::cast_slice_mut(list)) };
        parallel::for_chunks(Threads::All, list, |at, chunk| {
            let (words, _) = piece[4 * at..].as_chunks();
            for (number, word) in chunk.iter_mut().zip(words) {
                let across = u32::from_ne_bytes(*word) >> 2;
                *number = if across < end { across } else { NONE };
            }
        });
    }
}

/// Returns the mesh of a triangulation with `finite` tetrahedra, and its ghosts behind them, after it has been changed by
/// `patch`. Its neighbours are numbers, as [`Arrays::read`] returns them.
fn patched(mut mesh: Triangulation3, finite: usize, patch: &Patch) -> Result<FiniteMesh, Error> {
    apply(patch, &mut mesh)?;
    let mut changed: Vec<u32> = patch.slots.iter().copied().filter(|&t| (t as usize) < finite).collect();
    parallel::sort(Threads::All, &mut changed);
    let mut gaps = vec![Gaps::default()];
    changed.iter().for_each(|&t| mesh.note_gap(t, &mut gaps[0]));
    gaps.extend(parallel::map_ranges(Threads::All, mesh.tetrahedra().len() - finite, |range| {
        mesh.gaps(finite + range.start..finite + range.end)
    }));
    Ok(without_gaps(mesh, &gaps))
}

/// Changes a triangulation whose neighbours are numbers. Its unused slots are marked then.
///
/// # Errors
///
/// Returns [`Error::TooManySimplices`] and [`Error::OutOfMemory`]; the triangulation is unchanged then.
fn apply(patch: &Patch, mesh: &mut Triangulation3) -> Result<(), Error> {
    if patch.len > MAX_TETRAHEDRA {
        return Err(Error::TooManySimplices { limit: MAX_TETRAHEDRA });
    }
    let infinite = mesh.infinite();
    slots::reserve(&mut mesh.tetrahedra, &mut mesh.neighbors, patch.len)?;
    mesh.tetrahedra.resize(patch.len, [0; 4]);
    mesh.neighbors.resize(patch.len, [0; 4]);
    let arrays = [&mut mesh.tetrahedra, &mut mesh.neighbors].map(std::mem::take);
    let [tetrahedra, neighbors] = arrays.map(|array| share(array.into_flattened()));
    let for_changed = |work: &(dyn Fn(usize, u32) + Sync)| {
        parallel::map_grains(Threads::All, patch.slots.len(), GRAIN, |range| {
            range.for_each(|i| work(i, patch.slots[i]));
        });
    };
    for_changed(&|i, slot| {
        let v = patch.tetrahedra[i];
        let words = if v == [0; 4] { [state::FREE, 0, 0, 0] } else { v };
        for (word, shared) in words.into_iter().zip(&tetrahedra[4 * slot as usize..]) {
            shared.store(word, Relaxed);
        }
    });
    let visible = |t: u32| if tetrahedra[4 * t as usize + 3].load(Relaxed) == infinite { NONE } else { t };
    // The tetrahedron across a facet may not have changed itself, but may have had another one, or a ghost, there.
    for_changed(&|i, slot| {
        for (k, &across) in patch.neighbors[i].iter().enumerate().filter(|(_, across)| **across != KEEP) {
            neighbors[4 * slot as usize + k].store(visible(across >> 2), Relaxed);
            neighbors[across as usize].store(visible(slot), Relaxed);
        }
    });
    [mesh.tetrahedra, mesh.neighbors] = [tetrahedra, neighbors].map(|words| bytemuck::cast_vec(unshare(words)));
    Ok(())
}

/// Returns the mesh of a triangulation whose neighbours are numbers. All its gaps are in `gaps`, ascending.
fn without_gaps(mesh: Triangulation3, gaps: &[Gaps]) -> FiniteMesh {
    let Closing { count, hull, moves, moved_to, .. } = mesh.closing(gaps, Threads::All);
    let [tetrahedra, neighbors] = [mesh.tetrahedra, mesh.neighbors].map(|array| share(array.into_flattened()));
    // Two tetrahedra have one facet in common, at most.
    let replace = |of: u32, before: u32, after: u32| {
        let mut all = neighbors[4 * of as usize..].iter().take(4);
        if let Some(neighbor) = all.find(|neighbor| neighbor.load(Relaxed) == before) {
            neighbor.store(after, Relaxed);
        }
    };
    // Nobody else writes into the gap, or into the references to what moves there.
    parallel::map_ranges(Threads::All, moves.len(), |range| {
        for &[gap, last] in &moves[range] {
            for k in 0..4 {
                let [from, to] = [last, gap].map(|t| 4 * t as usize + k);
                tetrahedra[to].store(tetrahedra[from].load(Relaxed), Relaxed);
                let across = neighbors[from].load(Relaxed);
                let across = match (across as usize).checked_sub(count) {
                    Some(behind) => moved_to.get(behind).copied().unwrap_or(NONE),
                    None => {
                        replace(across, last, gap);
                        across
                    }
                };
                neighbors[to].store(across, Relaxed);
            }
        }
    });
    let [mut tetrahedra, mut neighbors] = [tetrahedra, neighbors].map(unshare);
    tetrahedra.truncate(4 * count);
    neighbors.truncate(4 * count);
    FiniteMesh { tetrahedra: bytemuck::cast_vec(tetrahedra), neighbors: bytemuck::cast_vec(neighbors), hull }
}
