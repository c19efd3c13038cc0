//! Memory that splaying uses again. It allocates hundreds of thousands of short lists otherwise, in
//! all threads at once, and the system provides their memory anew each time. WebAssembly, which has one
//! thread and little memory, keeps it for one run only.

use crate::{
    d3::splay::{
        ledger::{Entry, Ledger},
        region::Gathered,
        star::{Changes, LinkFinder, Star, Triangle},
    },
    parallel::Pool,
};
use rustc_hash::FxHashMap;

/// What a region leaves to the next one.
#[derive(Debug, Default)]
pub(super) struct Memory {
    /// What was gathered, of which nothing is needed any more.
    pub(super) gathered: Vec<Gathered>,
    /// The lists of a thread at work.
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
    /// Keeps the memory of what was gathered; not in WebAssembly, which makes no use of it.
    pub(super) fn keep_gathered(&mut self, gathered: Gathered) {
        if cfg!(not(target_arch = "wasm32")) && gathered.slots.capacity() > 0 {
            self.gathered.push(gathered);
        }
    }

    /// Keeps the memory of stars, for the threads that make the next ones, and frees what none of them has used.
    pub(super) fn keep(&mut self, stars: impl ExactSizeIterator<Item = Star>) {
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
