//! Memory that splaying uses again. It allocates hundreds of thousands of short lists otherwise, in
//! all threads at once, and the system provides their memory anew each time.

use crate::{
    d3::splay::{
        ledger::{Entry, Ledger},
        region::{Gathered, Region},
        star::{Changes, LinkFinder, Star, Triangle},
    },
    parallel::Pool,
};
use rustc_hash::FxHashMap;

/// Whether memory is kept for the next run. WebAssembly has one thread and little memory.
pub(super) const KEEPS_MEMORY: bool = cfg!(not(target_arch = "wasm32"));

/// The region of a run, of which the next one uses the memory; none if memory is not kept.
#[derive(Debug, Default)]
pub struct KeptRegion(#[cfg(not(target_arch = "wasm32"))] Option<Region>);

impl KeptRegion {
    /// Keeps a region if memory is kept.
    pub fn keep(&mut self, region: Region) {
        #[cfg(not(target_arch = "wasm32"))]
        self.0.replace(region);
        #[cfg(target_arch = "wasm32")]
        drop(region);
    }

    /// Returns the region that was kept.
    pub fn take(&mut self) -> Option<Region> {
        #[cfg(not(target_arch = "wasm32"))]
        return self.0.take();
        #[cfg(target_arch = "wasm32")]
        None
    }
}

/// What a region leaves to the next one.
#[derive(Debug, Default)]
pub(super) struct Memory {
    /// Gathered stars that are no longer needed.
    pub(super) gathered: Vec<Gathered>,
    /// The lists of each thread.
    pub(super) lists: Pool<Lists>,
    /// The place of each star.
    pub(super) star_of: FxHashMap<u32, u32>,
    /// An empty ledger, if there was one.
    pub(super) ledger: Option<Ledger>,
}

/// The lists of a thread that changes stars.
#[derive(Debug, Default)]
pub(super) struct Lists {
    pub(super) links: LinkFinder,
    pub(super) changes: Changes,
    /// What has happened to the stars, for the ledger.
    pub(super) entries: Vec<Entry>,
    /// Triangles that the triangulation has, but a star no longer has.
    pub(super) removed: Vec<Triangle>,
    /// Edges of a star that Flip-Flop is to look at.
    pub(super) edges: Vec<u32>,
    /// Points that are to be inserted into a star, each with the place of a request.
    pub(super) points: Vec<u64>,
}

impl Memory {
    /// Keeps the memory of gathered stars.
    pub(super) fn keep_gathered(&mut self, gathered: Gathered) {
        if KEEPS_MEMORY && gathered.slots.capacity() > 0 {
            self.gathered.push(gathered);
        }
    }

    /// Keeps the memory of stars, shared out among the threads, and frees what this run did not use.
    pub(super) fn keep_stars(&mut self, stars: impl ExactSizeIterator<Item = Star>) {
        let lists = self.lists.all();
        if lists.is_empty() {
            return;
        }
        let share = stars.len().div_ceil(lists.len()).max(1);
        lists.iter_mut().for_each(|lists| lists.links.forget_spare());
        for (i, star) in stars.enumerate() {
            lists[i / share].links.keep(star);
        }
    }
}
