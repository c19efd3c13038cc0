//! Tetrahedra and their neighbours under construction, the outside of the hull included.

use crate::{
    d3::mesh::FACETS,
    index::NONE,
    parallel::{self, Threads},
    slots::{self, MarkedSlots},
};
use rustc_hash::FxHashMap;
use std::{ops::Range, sync::atomic::Ordering::Relaxed};

/// Tetrahedra are numbered below 2³⁰, because a neighbour is packed with its facet into 32 bits.
pub(crate) const MAX_TETRAHEDRA: usize = 1 << 30;

/// What an algorithm knows about a tetrahedron: the two highest bits of its first vertex, so that
/// no other cache line needs to be fetched for them.
pub(crate) mod state {
    pub(crate) const MASK: u32 = 3 << 30;
    pub(crate) const UNKNOWN: u32 = 0;
    /// The circumsphere contains the point that is being inserted.
    pub(crate) const CONFLICT: u32 = 1 << 30;
    /// The circumsphere does not contain the point, but a neighbour's does.
    pub(crate) const BEYOND: u32 = 2 << 30;
    /// The slot is unused.
    pub(crate) const FREE: u32 = 3 << 30;
}

/// A 3D triangulation: tetrahedra, and *ghosts*, which join the facets of the hull to one infinite
/// vertex.
///
/// Every tetrahedron has four neighbours, and facet *k* is the one opposite its vertex *k*. So
/// topologically it is a 3-sphere.
#[derive(Debug, Clone)]
pub struct Triangulation3 {
    /// Four vertices per tetrahedron, positively oriented, with a [`state`] in the first. A ghost
    /// has the infinite vertex last, and is oriented as if that lay outside the hull.
    pub(crate) tetrahedra: Vec<[u32; 4]>,
    /// Entry *k* is across the facet opposite vertex *k*: 4·(tetrahedron) + (facet as it is
    /// numbered there).
    pub(crate) neighbors: Vec<[u32; 4]>,
    /// The infinite vertex: the number of vertices.
    pub(crate) infinite: u32,
}

impl Triangulation3 {
    /// Creates a triangulation from its arrays, which are not checked.
    ///
    /// Tetrahedra are positively oriented; ghosts have the infinite vertex last, and are oriented
    /// as if it lay outside the hull. Entry *k* of `neighbors` is across the facet opposite vertex
    /// *k*: 4·(tetrahedron) + (facet as it is numbered there). `infinite` is the number of
    /// vertices.
    pub fn new(tetrahedra: Vec<[u32; 4]>, neighbors: Vec<[u32; 4]>, infinite: u32) -> Self {
        Triangulation3 { tetrahedra, neighbors, infinite }
    }

    /// Creates the triangulation of a mesh, which is not checked: the inverse of [`Triangulation3::into_mesh`] without
    /// names. `infinite` is the number of vertices. The mesh's tetrahedra keep their numbers, and one ghost per facet of
    /// the hull follows.
    pub(crate) fn from_mesh(mesh: FiniteMesh, infinite: u32, threads: Threads) -> Self {
        let FiniteMesh { mut tetrahedra, neighbors: beside, hull } = mesh;
        let count = tetrahedra.len();
        let mut neighbors: Vec<[u32; 4]> = bytemuck::zeroed_vec(count);
        parallel::for_chunks(threads, &mut neighbors, |start, chunk| {
            for (t, facets) in (start as u32..).zip(chunk) {
                *facets = beside[t as usize].map(|u| match u {
                    NONE => NONE,
                    u => 4 * u + place_of(beside[u as usize], t),
                });
            }
        });
        let open = parallel::joined(parallel::map_ranges(threads, 4 * count, |range| {
            range.filter(|&f| neighbors.as_flattened()[f] == NONE).map(|f| f as u32).collect::<Vec<_>>()
        }));
        let sorted = |mut facet: [u32; 3]| {
            facet.sort_unstable();
            facet
        };
        let inside: FxHashMap<[u32; 3], u32> = open
            .into_iter()
            .map(|f| (sorted(FACETS[f as usize % 4].map(|k| tetrahedra[f as usize / 4][k])), f))
            .collect();
        let mut edges: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        for (ghost, &[a, b, c]) in (count as u32..).zip(&hull) {
            edges.extend([([b, c], 4 * ghost), ([c, a], 4 * ghost + 1), ([a, b], 4 * ghost + 2)]);
        }
        for (ghost, &[a, b, c]) in (count as u32..).zip(&hull) {
            let below = inside[&sorted([a, b, c])];
            neighbors[below as usize / 4][below as usize % 4] = 4 * ghost + 3;
            neighbors.push([edges[&[c, b]], edges[&[a, c]], edges[&[b, a]], below]);
            tetrahedra.push([a, b, c, infinite]);
        }
        Triangulation3 { tetrahedra, neighbors, infinite }
    }

    /// Returns the infinite vertex.
    pub fn infinite(&self) -> u32 {
        self.infinite
    }

    /// Marks the slots as unused that are not used any more on a device: all their vertices are 0.
    pub fn discard_unused(&mut self) {
        parallel::for_chunks(Threads::All, &mut self.tetrahedra, |_, chunk| {
            chunk.iter_mut().filter(|t| **t == [0; 4]).for_each(|t| t[0] = state::FREE);
        });
    }

    /// Returns the vertices of each tetrahedron; those of unused slots have no meaning.
    pub fn tetrahedra(&self) -> &[[u32; 4]] {
        &self.tetrahedra
    }

    /// Returns the neighbours of each tetrahedron.
    pub fn neighbors(&self) -> &[[u32; 4]] {
        &self.neighbors
    }

    /// Makes two facets each other's neighbours.
    pub(crate) fn join(&mut self, f: u32, g: u32) {
        self.neighbors[f as usize / 4][f as usize % 4] = g;
        self.neighbors[g as usize / 4][g as usize % 4] = f;
    }

    /// Returns the vertices of tetrahedron `t`.
    pub(crate) fn vertices(&self, t: u32) -> [u32; 4] {
        let [a, b, c, d] = self.tetrahedra[t as usize];
        [a & !state::MASK, b, c, d]
    }

    /// Returns the state of tetrahedron `t`.
    pub(crate) fn state(&self, t: u32) -> u32 {
        self.tetrahedra[t as usize][0] & state::MASK
    }

    /// Sets the state of tetrahedron `t`.
    pub(crate) fn set_state(&mut self, t: u32, state: u32) {
        let first = &mut self.tetrahedra[t as usize][0];
        *first = *first & !state::MASK | state;
    }

    /// Returns whether tetrahedron `t` is a ghost.
    pub(crate) fn is_ghost(&self, t: u32) -> bool {
        self.tetrahedra[t as usize][3] == self.infinite
    }

    /// Returns the gaps among these slots.
    pub(in crate::d3) fn gaps(&self, slots: Range<usize>) -> Gaps {
        const FEW: usize = 64;
        let mut gaps = Gaps::default();
        // Most slots are no gaps, so one branch decides for many slots at a time.
        for (start, few) in (slots.start..).step_by(FEW).zip(self.tetrahedra[slots].chunks(FEW)) {
            let is_gap = |t: &[u32; 4]| (t[0] & state::MASK == state::FREE) | (t[3] == self.infinite);
            if few.iter().fold(false, |any, t| any | is_gap(t)) {
                (start as u32..).zip(few).for_each(|(t, _)| self.note_gap(t, &mut gaps));
            }
        }
        gaps
    }

    /// Adds slot `t` to the gaps if it is one.
    pub(in crate::d3) fn note_gap(&self, t: u32, gaps: &mut Gaps) {
        if self.state(t) == state::FREE {
            gaps.unused.push(t);
        } else if self.is_ghost(t) {
            gaps.ghosts.push(t);
        }
    }

    /// Returns how `gaps`, which are ascending, are closed.
    pub(in crate::d3) fn closing(&self, gaps: &[Gaps], threads: Threads) -> Closing {
        let slots = self.tetrahedra.len();
        let ghosts: usize = gaps.iter().map(|gaps| gaps.ghosts.len()).sum();
        let count = slots - ghosts - gaps.iter().map(|gaps| gaps.unused.len()).sum::<usize>();
        let mut hull: Vec<[u32; 3]> = bytemuck::zeroed_vec(ghosts);
        let mut rest = hull.as_mut_slice();
        let mut facets = Vec::new();
        for Gaps { ghosts, .. } in gaps {
            let (these, others) = rest.split_at_mut(ghosts.len());
            facets.push((ghosts, these));
            rest = others;
        }
        parallel::map_mut(threads, &mut facets, |_, (ghosts, facets)| {
            for (facet, &t) in facets.iter_mut().zip(*ghosts) {
                let [a, b, c, _] = self.tetrahedra[t as usize];
                *facet = [a, b, c];
            }
        });
        // The tetrahedra beyond the last one of the mesh move into the gaps before it.
        let movers = parallel::map_ranges(threads, slots - count, |range| {
            let is_used = |&t: &u32| self.state(t) != state::FREE && !self.is_ghost(t);
            ((count + range.start) as u32..(count + range.end) as u32).filter(is_used).collect::<Vec<_>>()
        });
        let in_front = |&&t: &&u32| (t as usize) < count;
        let unused = gaps.iter().flat_map(|gaps| &gaps.unused).take_while(in_front);
        let ghosts: Vec<u32> = gaps.iter().flat_map(|gaps| &gaps.ghosts).take_while(in_front).copied().collect();
        let moves: Vec<[u32; 2]> =
            unused.chain(&ghosts).copied().zip(movers.into_iter().flatten()).map(Into::into).collect();
        let mut moved_to = vec![NONE; slots - count];
        for &[gap, last] in &moves {
            moved_to[last as usize - count] = gap;
        }
        Closing { count, hull, ghosts, moves, moved_to }
    }

    /// Returns tetrahedra, neighbours and hull as in [`Mesh3`](crate::Mesh3), without ghosts and
    /// unused slots, reusing the arrays. With `names`, vertex *v* becomes `names[v]`. `threads`
    /// share the work.
    pub fn into_mesh(self, names: Option<&[u32]>, threads: Threads) -> FiniteMesh {
        let gaps = parallel::map_ranges(threads, self.tetrahedra.len(), |range| self.gaps(range));
        let Closing { count, mut hull, ghosts, moves, moved_to } = self.closing(&gaps, threads);
        let tetrahedra = slots::share(self.tetrahedra.into_flattened());
        let neighbors = slots::share(self.neighbors.into_flattened());
        // References to ghosts beyond the last tetrahedron of the mesh are recognised by their
        // index; those to the other ghosts are marked here.
        parallel::map_ranges(threads, ghosts.len(), |range| {
            for &t in &ghosts[range] {
                let inside = neighbors[4 * t as usize + 3].load(Relaxed);
                neighbors[inside as usize].store(NONE, Relaxed);
            }
        });
        // Nobody else writes into the gap, or into the references to what moves there.
        parallel::map_ranges(threads, moves.len(), |range| {
            for &[gap, last] in &moves[range] {
                for k in 0..4 {
                    let [from, to] = [last, gap].map(|t| 4 * t as usize + k);
                    tetrahedra[to].store(tetrahedra[from].load(Relaxed), Relaxed);
                    let across = neighbors[from].load(Relaxed);
                    let beside = (across as usize / 4).checked_sub(count);
                    let across = match beside.map(|beside| moved_to.get(beside)) {
                        Some(Some(&NONE) | None) => across,
                        Some(Some(&gap)) => 4 * gap + across % 4,
                        None => {
                            neighbors[across as usize].store(to as u32, Relaxed);
                            across
                        }
                    };
                    neighbors[to].store(across, Relaxed);
                }
            }
        });
        let [mut tetrahedra, mut neighbors]: [Vec<[u32; 4]>; 2] =
            [tetrahedra, neighbors].map(|words| bytemuck::cast_vec(slots::unshare(words)));
        tetrahedra.truncate(count);
        neighbors.truncate(count);
        if let Some(names) = names {
            let rename = |v: &mut u32| *v = names[*v as usize];
            parallel::for_chunks(threads, &mut tetrahedra, |_, chunk| chunk.iter_mut().flatten().for_each(rename));
            parallel::for_chunks(threads, &mut hull, |_, chunk| chunk.iter_mut().flatten().for_each(rename));
        }
        // Below 2³⁰, like all indices of tetrahedra.
        let count = count as u32;
        parallel::for_chunks(threads, &mut neighbors, |_, chunk| {
            for n in chunk.as_flattened_mut() {
                let across = *n >> 2;
                *n = if across < count { across } else { NONE };
            }
        });
        FiniteMesh { tetrahedra, neighbors, hull }
    }
}

/// Returns the place of a value in an array that has it.
fn place_of(array: [u32; 4], value: u32) -> u32 {
    (0..4).find(|&k| array[k as usize] == value).unwrap_or(0)
}

/// Slots that have no place in a mesh.
#[derive(Default)]
pub(in crate::d3) struct Gaps {
    ghosts: Vec<u32>,
    unused: Vec<u32>,
}

/// How gaps are closed.
pub(in crate::d3) struct Closing {
    /// The number of tetrahedra of the mesh.
    pub(in crate::d3) count: usize,
    /// The facets of the ghosts, in their order.
    pub(in crate::d3) hull: Vec<[u32; 3]>,
    /// The ghosts in slots below the count.
    ghosts: Vec<u32>,
    /// The gaps that are filled, each with the slot of the tetrahedron that moves there.
    pub(in crate::d3) moves: Vec<[u32; 2]>,
    /// Where the tetrahedra move to that are in slots from the count on, if they do.
    pub(in crate::d3) moved_to: Vec<u32>,
}

slots::slots_of_arrays!(Triangulation3, 4, tetrahedra, MAX_TETRAHEDRA, |mesh, t| mesh.set_state(t, state::FREE));

impl MarkedSlots<4> for Triangulation3 {
    type Places = Vec<u32>;

    #[inline]
    fn first(&self, t: u32) -> u32 {
        self.tetrahedra[t as usize][0]
    }

    #[inline]
    fn set_first(&mut self, t: u32, first: u32) {
        self.tetrahedra[t as usize][0] = first;
    }

    #[inline]
    fn first_and(&self, t: u32, k: usize) -> [u32; 2] {
        let vertices = &self.tetrahedra[t as usize];
        [vertices[0], vertices[k % 4]]
    }

    fn places(&self) -> Vec<u32> {
        vec![0; self.infinite as usize + 1]
    }
}

/// The arrays of a [`Mesh3`](crate::Mesh3).
#[derive(Debug, Clone)]
pub struct FiniteMesh {
    /// Four vertices per tetrahedron; see [`Mesh3::tetrahedra`](crate::Mesh3::tetrahedra).
    pub tetrahedra: Vec<[u32; 4]>,
    /// Four neighbours per tetrahedron; see [`Mesh3::neighbors`](crate::Mesh3::neighbors).
    pub neighbors: Vec<[u32; 4]>,
    /// Three vertices per facet of the hull; see [`Mesh3::hull`](crate::Mesh3::hull).
    pub hull: Vec<[u32; 3]>,
}
