//! Memory that splaying uses again. It allocates hundreds of thousands of short lists otherwise, in
//! all threads at once, and the system provides their memory anew each time.

use crate::{
    d3::splay::{
        gathered::Gathered,
        ledger::{Entry, Ledger},
        star::{Changes, LinkFinder, Star, Triangle},
    },
    parallel::Pool,
};
use rustc_hash::FxHashMap;

/// What is kept for stars.
#[derive(Debug, Default)]
pub(super) struct StarMemory {
    /// The lists of each thread.
    pub(super) lists: Pool<Lists>,
    /// The place of each star.
    pub(super) star_of: FxHashMap<u32, u32>,
    /// The ledger, if there was one.
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

/// What a region leaves to the next one beside its own lists.
#[derive(Debug, Default)]
pub(super) struct Memory {
    /// Gathered stars that are no longer needed.
    gathered: Vec<Gathered>,
    stars: StarMemory,
}

impl Memory {
    /// Returns memory for what is to be gathered.
    pub(super) fn spare(&mut self) -> Gathered {
        self.gathered.pop().unwrap_or_default()
    }

    /// Keeps the memory of gathered stars.
    pub(super) fn keep_gathered(&mut self, gathered: Gathered) {
        if gathered.slots.capacity() > 0 {
            self.gathered.push(gathered);
        }
    }

    /// Returns the memory of stars, with nothing in it.
    pub(super) fn take_stars(&mut self) -> StarMemory {
        std::mem::take(&mut self.stars)
    }

    /// Keeps the memory of stars, which the threads share, and frees what this run did not use.
    pub(super) fn keep_stars(&mut self, mut memory: StarMemory, stars: impl ExactSizeIterator<Item = Star>) {
        memory.star_of.clear();
        memory.ledger.iter_mut().for_each(Ledger::clear);
        let lists = memory.lists.all();
        lists.iter_mut().for_each(|lists| lists.links.forget_spare());
        let share = stars.len().div_ceil(lists.len().max(1)).max(1);
        for (i, star) in stars.enumerate() {
            if let Some(lists) = lists.get_mut(i / share) {
                lists.links.keep(star);
            }
        }
        self.stars = memory;
    }
}
