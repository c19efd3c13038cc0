//! The part of a triangulation that splaying sees: the stars of the vertices that it asked for.
//!
//! The triangulation itself is elsewhere, as a rule on a device. The region numbers tetrahedra in
//! the order in which they are gathered, from 1; number 0 stands for every tetrahedron that the
//! region lacks. Everything that works on a triangulation therefore works on a region, as long as
//! it stays within the stars that have been gathered.

use crate::{
    d3::{
        splay::{
            Aborted,
            gathered::{Gathered, NAMED_SHIFT, OUTSIDE, SLOT},
            index_set::IndexSet,
            memory::Memory,
        },
        triangulation::{Triangulation3, state},
    },
    index::NONE,
    parallel::{self, Threads},
};

/// An entry of [`Patch::neighbors`]: what is there stays as it is.
pub const KEEP: u32 = u32::MAX;

/// The number of tetrahedra that a thread takes at a time to find what has changed.
const PATCH_GRAIN: usize = 1 << 11;

/// From how many facets on it is worth that each thread looks at all of them.
const SHARED_FROM: usize = 1 << 12;

/// What splaying changed in a region, for the triangulation that the region is a part of.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Patch {
    /// The slots that have changed.
    pub slots: Vec<u32>,
    /// Their vertices; all 0 for slots that are not used any more.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Their neighbours, 4·slot + facet; [`KEEP`] for those that have not changed.
    pub neighbors: Vec<[u32; 4]>,
    /// How many slots there are now.
    pub len: usize,
    /// How many more finite tetrahedra there are now, and how many more ghosts.
    pub more: [isize; 2],
}

/// A part of a triangulation.
#[derive(Debug)]
pub struct Region {
    pub(super) mesh: Triangulation3,
    /// A tetrahedron of each vertex whose star the region has, a ghost if there is one.
    pub(super) vertex_simplex: Vec<u32>,
    /// The vertices of which the region has the whole star.
    complete: Complete,
    /// The tetrahedra as they were gathered, from number 1 on. Those that splaying adds have no slot here.
    given: Gathered,
    /// How often tetrahedra were gathered, and how many.
    pub(super) gathers: [usize; 2],
    pub(super) memory: Memory,
}

/// The vertices of which a region has the whole star.
#[derive(Debug, Clone)]
enum Complete {
    All,
    Those(IndexSet),
}

impl Region {
    /// Creates a region that has nothing of a triangulation of so many vertices. `threads` share the
    /// work.
    pub fn new(vertices: usize, threads: Threads) -> Self {
        let infinite = vertices as u32;
        Region {
            mesh: Self::outside(Vec::new(), Vec::new(), infinite),
            vertex_simplex: parallel::filled(threads, vertices, NONE),
            complete: Complete::Those(IndexSet::new(vertices)),
            given: Gathered::default(),
            gathers: [0; 2],
            memory: Memory::default(),
        }
    }

    /// Returns what stands for all that is outside, in empty lists.
    fn outside(mut tetrahedra: Vec<[u32; 4]>, mut neighbors: Vec<[u32; 4]>, infinite: u32) -> Triangulation3 {
        // It looks like a tetrahedron that is not there. Nothing depends on it.
        tetrahedra.push([infinite | state::FREE, infinite, infinite, infinite]);
        neighbors.push([OUTSIDE; 4]);
        Triangulation3::new(tetrahedra, neighbors, infinite)
    }

    /// Creates a region as [`Region::new`] does, in the memory of `kept`, if there is one.
    pub fn again(kept: Option<Self>, vertices: usize, threads: Threads) -> Self {
        let Some(kept) = kept else { return Region::new(vertices, threads) };
        let infinite = vertices as u32;
        let Region { mut mesh, mut vertex_simplex, given, mut memory, .. } = kept;
        if mesh.infinite != infinite {
            return Region { memory, ..Region::new(vertices, threads) };
        }
        mesh.tetrahedra.clear();
        mesh.neighbors.clear();
        let mesh = Self::outside(mesh.tetrahedra, mesh.neighbors, infinite);
        parallel::for_chunks(threads, &mut vertex_simplex, |_, vertex_simplex| vertex_simplex.fill(NONE));
        memory.keep_gathered(given);
        let complete = Complete::Those(IndexSet::new(vertices));
        Region { mesh, vertex_simplex, complete, given: Gathered::default(), gathers: [0; 2], memory }
    }

    /// Returns memory for what is to be gathered.
    pub fn spare(&mut self) -> Gathered {
        self.memory.spare()
    }

    /// Creates the region that is a whole triangulation, with a tetrahedron at each vertex, a ghost
    /// if there is one. It has the memory of the stars of `kept`.
    pub(super) fn whole(kept: Option<Self>, mesh: Triangulation3, vertex_simplex: Vec<u32>) -> Self {
        let (given, memory) = (Gathered::default(), kept.map_or_else(Memory::default, |kept| kept.memory));
        Region { mesh, vertex_simplex, complete: Complete::All, given, gathers: [0; 2], memory }
    }

    /// Returns the number of the next tetrahedron.
    pub fn next(&self) -> u32 {
        self.mesh.tetrahedra.len() as u32
    }

    /// Returns the vertex at infinity, which is the number of vertices.
    #[cfg(feature = "gpu")]
    pub(in crate::d3) fn infinite(&self) -> u32 {
        self.mesh.infinite
    }

    /// Returns the vertices of a tetrahedron of the region.
    pub fn tetrahedron(&self, t: u32) -> [u32; 4] {
        self.mesh.vertices(t)
    }

    /// Takes the triangulation out: the whole one, if the region is that. What is left is memory for another run.
    pub(super) fn take_mesh(&mut self) -> Triangulation3 {
        std::mem::replace(&mut self.mesh, Triangulation3::new(Vec::new(), Vec::new(), NONE))
    }

    /// Returns whether the region has the whole star of a vertex.
    pub(super) fn has_star(&self, v: u32) -> bool {
        match &self.complete {
            Complete::All => true,
            Complete::Those(complete) => complete.has(v),
        }
    }

    /// Returns whether this number stands for what the region has not got.
    pub(super) fn is_outside(&self, t: u32) -> bool {
        t == OUTSIDE && !matches!(self.complete, Complete::All)
    }

    /// Adds what was gathered, numbered from [`next`](Region::next) on. Now the region has the
    /// stars of `vertices`. `threads` share the work.
    ///
    /// # Errors
    ///
    /// Returns [`Aborted::Inconsistent`] if the neighbours do not fit.
    pub fn add(
        &mut self,
        vertices: impl IntoIterator<Item = u32>,
        mut gathered: Gathered,
        threads: Threads,
    ) -> Result<(), Aborted> {
        const DO_NOT_FIT: Aborted = Aborted::Inconsistent("gathered tetrahedra do not fit what is there");
        let Region { mesh, vertex_simplex, complete, given, gathers, memory } = self;
        let Gathered { tetrahedra, neighbors, slots } = &mut gathered;
        let (tetrahedra, neighbors) = (&*tetrahedra, &*neighbors);
        let first = mesh.tetrahedra.len();
        let infinite = mesh.infinite;
        *gathers = [gathers[0] + 1, gathers[1] + slots.len()];
        let fits = |v: &[u32; 4]| v[..3].iter().all(|&v| v < infinite) && v[3] <= infinite;
        let end = first + tetrahedra.len();
        let is_here = |across: &[u32; 4]| across.iter().all(|across| ((across >> 2) as usize) < end);
        let fit = parallel::map_ranges(threads, tetrahedra.len(), |range| {
            tetrahedra[range.clone()].iter().all(fits)
                && neighbors.get(range).is_some_and(|some| some.iter().all(is_here))
        });
        if [neighbors.len(), slots.len()] != [tetrahedra.len(); 2] || fit.contains(&false) {
            return Err(DO_NOT_FIT);
        }
        parallel::extend(threads, &mut mesh.tetrahedra, tetrahedra);
        parallel::extend(threads, &mut mesh.neighbors, neighbors);
        for ((t, v), word) in (first as u32..).zip(tetrahedra).zip(slots) {
            let of = *word >> NAMED_SHIFT;
            // Most are the tetrahedron of no vertex.
            if of == 0 {
                continue;
            }
            *word &= SLOT;
            for (_, &v) in v.iter().enumerate().filter(|(k, _)| of >> k & 1 != 0) {
                // There is none of infinity.
                if let Some(vertex_simplex) = vertex_simplex.get_mut(v as usize) {
                    *vertex_simplex = t;
                }
            }
        }
        // What came earlier, if anything, did not know of this.
        let len = if first > 1 { neighbors.len() } else { 0 };
        let back = parallel::joined(parallel::map_ranges(threads, len, |range| {
            let facets = range.flat_map(|t| (0..4).map(move |k| [neighbors[t][k], (4 * (first + t) + k) as u32]));
            let to_earlier = |across: u32| across >> 2 != OUTSIDE && ((across >> 2) as usize) < first;
            facets.filter(|&[across, _]| to_earlier(across)).collect::<Vec<_>>()
        }));
        let all = |mesh: &Triangulation3, is: &(dyn Fn(u32, u32) -> bool + Sync)| {
            let is = |&[across, facet]: &[u32; 2]| is(mesh.neighbors[across as usize / 4][across as usize % 4], facet);
            !parallel::map_ranges(threads, back.len(), |range| back[range].iter().all(is)).contains(&false)
        };
        if !all(mesh, &|neighbor, _| neighbor >> 2 == OUTSIDE) {
            return Err(DO_NOT_FIT);
        }
        for (first, list) in [(0, &mut mesh.neighbors), (1, &mut given.neighbors)] {
            // Every thread looks at all of these, so that it has those of its own.
            let sharing = if back.len() < SHARED_FROM { Threads::One } else { threads };
            parallel::for_parts(sharing, list, |start, part| {
                for &[across, facet] in &back {
                    if let Some(neighbors) = part.get_mut((across as usize / 4).wrapping_sub(first + start)) {
                        neighbors[across as usize % 4] = facet;
                    }
                }
            });
        }
        if !all(mesh, &|neighbor, facet| neighbor == facet) {
            return Err(DO_NOT_FIT);
        }
        memory.keep_gathered(given.append(first - 1, gathered, threads));
        if let Complete::Those(complete) = complete {
            for v in vertices {
                if v >= infinite {
                    return Err(DO_NOT_FIT);
                }
                complete.insert(v);
            }
        }
        Ok(())
    }

    /// Returns those of the `vertices` of which the region lacks the stars, each once.
    pub(super) fn lacking(&self, vertices: impl IntoIterator<Item = u32>) -> Vec<u32> {
        let lacks = |&v: &u32| v != self.mesh.infinite && !self.has_star(v);
        let mut lacking: Vec<u32> = vertices.into_iter().filter(lacks).collect();
        lacking.sort_unstable();
        lacking.dedup();
        lacking
    }

    /// Records that these tetrahedra are new, each at its vertices.
    pub(super) fn note(&mut self, tetrahedra: impl IntoIterator<Item = u32>) {
        for t in tetrahedra {
            for v in self.mesh.vertices(t) {
                if let Some(vertex_simplex) = self.vertex_simplex.get_mut(v as usize) {
                    *vertex_simplex = t;
                }
            }
        }
    }

    /// Returns what has changed since it was gathered, where the triangulation has `len` slots.
    /// `threads` share the work.
    pub fn patch(&self, len: usize, threads: Threads) -> Patch {
        let Region { mesh, given, .. } = self;
        // What splaying added is in no slot yet. Numbers of slots stay below 2³⁰ if those of the
        // region do, of which no more are added than the triangulation may have.
        let mut slots = vec![NONE; mesh.tetrahedra.len()];
        slots[1..][..given.slots.len()].copy_from_slice(&given.slots);
        let mut next = len as u32;
        for (t, slot) in (0..).zip(&mut slots).skip(1) {
            if *slot == NONE && mesh.state(t) != state::FREE {
                *slot = next;
                next += 1;
            }
        }
        let parts = parallel::map_grains(threads, mesh.tetrahedra.len(), PATCH_GRAIN, |range| {
            let mut patch = Patch::default();
            for t in range {
                let (v, across) = (mesh.tetrahedra[t], mesh.neighbors[t]);
                let given = given.of(t);
                let is_given = given == Some((&v, &across));
                if slots[t] == NONE || is_given {
                    continue;
                }
                let is_free = v[0] & state::MASK == state::FREE;
                if !is_free {
                    patch.more[usize::from(v[3] == mesh.infinite)] += 1;
                }
                if let Some((v, _)) = given {
                    patch.more[usize::from(v[3] == mesh.infinite)] -= 1;
                }
                patch.slots.push(slots[t]);
                patch.tetrahedra.push(if is_free { [0; 4] } else { v });
                patch.neighbors.push(across.map(|across| match across >> 2 {
                    OUTSIDE => KEEP,
                    _ if is_free => KEEP,
                    u => 4 * slots[u as usize] + across % 4,
                }));
            }
            patch
        });
        let changed = parts.iter().map(|part| part.slots.len()).sum();
        let mut patch = Patch {
            slots: Vec::with_capacity(changed),
            tetrahedra: Vec::with_capacity(changed),
            neighbors: Vec::with_capacity(changed),
            len: next as usize,
            more: [0; 2],
        };
        for part in parts {
            patch.slots.extend(part.slots);
            patch.tetrahedra.extend(part.tetrahedra);
            patch.neighbors.extend(part.neighbors);
            patch.more = [patch.more[0] + part.more[0], patch.more[1] + part.more[1]];
        }
        patch
    }
}

/// The region of a run, of which the next one uses the memory.
#[derive(Debug, Default)]
pub struct KeptRegion(Option<Region>);

impl KeptRegion {
    /// Keeps a region.
    pub fn keep(&mut self, region: Region) {
        self.0 = Some(region);
    }

    /// Returns the region that was kept.
    pub fn take(&mut self) -> Option<Region> {
        self.0.take()
    }
}
