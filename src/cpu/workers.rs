//! Insertion by several threads, which share one triangulation.
//!
//! A round's points are split into as many stretches of the curve as there are workers. Each worker
//! inserts the points of its own stretch, a few at a time, and then helps with the others. So all
//! but a few insertions are far apart. Where two meet, one of them is put off; see
//! [`SharedSlots`] for how they notice. No thread ever waits for another.
//!
//! The set of simplices is that of one thread, because it does not depend on the order of
//! insertion; which slot a simplex has depends on timing.

use crate::{
    cpu::Insert,
    error::Error,
    parallel::{self, Threads},
    predicates::filter::PredicateContext,
    slots::{MAX_WORKERS, SharedSlots, Worker},
    stats::ExactCounts,
};
use std::{
    ops::Range,
    sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed},
};

/// A worker takes at most this many points at a time: few enough that the others are done soon
/// after the first one that finds no more.
const MAX_PORTION: usize = 256;
/// The smallest number of vertices per worker: with fewer, workers meet too often. Tests want them to.
const VERTICES_PER_WORKER: usize = if cfg!(test) { 1 } else { 64 };
/// The number of insertions after which a worker gives its claims back. The next points are near, so that
/// it needs most of the claims again, and a new claim takes longer than a look at an old one.
const INSERTIONS_PER_CLAIM: usize = 8;
/// The number of times that a worker retries the points that it has put off, at the end.
const RETRIES: usize = 3;

/// The vertices that several threads insert.
pub struct SharedRun<'a, const D: usize, const W: bool = false> {
    /// The threads.
    pub(crate) threads: Threads,
    /// All vertices. Those below the first of the rounds have been inserted.
    pub(crate) vertices: &'a PredicateContext<'a, D, W>,
    /// The vertices to be inserted, in rounds along the curve.
    pub(crate) rounds: Vec<Range<u32>>,
    /// Called from time to time, in the calling thread, with the number of vertices that have been
    /// inserted; an error ends the run.
    pub(crate) report: &'a dyn Fn(usize) -> Result<(), Error>,
}

/// The points of a round.
struct Round {
    /// The points that an earlier round has left.
    left: Vec<u32>,
    range: Range<u32>,
    /// The number of points of each stretch that have been taken.
    taken: Vec<AtomicUsize>,
    portion: usize,
    /// The number of vertices in the triangulation.
    inserted: AtomicUsize,
    is_stopped: AtomicBool,
}

impl Round {
    fn new(left: Vec<u32>, range: Range<u32>, workers: usize, inserted: usize) -> Self {
        let portion = ((left.len() + range.len()) / (8 * workers)).clamp(1, MAX_PORTION);
        Round {
            left,
            range,
            taken: (0..workers).map(|_| AtomicUsize::new(0)).collect(),
            portion,
            inserted: AtomicUsize::new(inserted),
            is_stopped: AtomicBool::new(false),
        }
    }

    /// Returns point `i` of the round.
    fn point(&self, i: usize) -> u32 {
        self.left.get(i).copied().unwrap_or_else(|| self.range.start + (i - self.left.len()) as u32)
    }

    /// Returns portions of points that no worker has taken, first those of the worker's own stretch.
    fn portions(&self, worker: usize) -> impl Iterator<Item = Range<usize>> {
        let (count, stretches) = (self.left.len() + self.range.len(), self.taken.len());
        let start = move |stretch: usize| count * stretch / stretches;
        (0..stretches).flat_map(move |k| {
            let stretch = (worker + k) % stretches;
            let all = start(stretch)..start(stretch + 1);
            std::iter::from_fn(move || {
                let taken = self.taken[stretch].fetch_add(self.portion, Relaxed);
                (taken < all.len()).then(|| all.start + taken..all.end.min(all.start + taken + self.portion))
            })
        })
    }
}

/// What is left when a worker has ended.
struct Rest {
    /// The points that it took and did not insert.
    left: Vec<u32>,
    unused: Vec<u32>,
    counts: ExactCounts,
}

/// Inserts the points of a run. Returns those that are left, which have to be inserted by one
/// thread.
///
/// # Errors
///
/// Returns the errors of the run's reports, [`Error::TooManySimplices`] and [`Error::OutOfMemory`].
pub(crate) fn insert_by_workers<const D: usize, const N: usize, const W: bool>(
    slots: &mut SharedSlots<N>,
    run: &SharedRun<'_, D, W>,
) -> Result<Vec<u32>, Error>
where
    for<'w> Worker<'w, N>: Insert<D>,
{
    let mut left = Vec::new();
    let mut rounds = run.rounds.iter().cloned();
    let mut before = run.rounds.first().map_or(0, |first| first.start as usize);
    loop {
        // After a lack of slots, the same round goes on.
        let range = if slots.grow()? { Some(0..0) } else { rounds.next() };
        let Some(range) = range else { return Ok(left) };
        let workers = parallel::count(run.threads).min(before / VERTICES_PER_WORKER).clamp(1, MAX_WORKERS);
        let points = left.len() + range.len();
        let round = Round::new(left, range, workers, before);
        let mut crew = slots.workers(workers).into_iter().zip(0..);
        let own = crew.next();
        let others = crew.map(|(slots, number)| {
            let (context, round) = (run.vertices.fork(), &round);
            move || work(slots, number, &context, round, &|_| Ok(()))
        });
        let (own, others) = parallel::beside(
            || own.map(|(slots, number)| work(slots, number, &run.vertices.fork(), &round, run.report)),
            others.collect(),
        );
        let rests = own.into_iter().chain(others).collect::<Result<Vec<_>, _>>()?;
        left = Vec::new();
        for rest in rests {
            left.extend(rest.left);
            slots.reclaim(rest.unused);
            run.vertices.add_counts(rest.counts);
        }
        before += points - left.len();
        left.sort_unstable();
    }
}

/// Inserts points of a round until none are left.
fn work<const D: usize, const N: usize, const W: bool>(
    slots: Worker<'_, N>,
    number: usize,
    vertices: &PredicateContext<'_, D, W>,
    round: &Round,
    report: &dyn Fn(usize) -> Result<(), Error>,
) -> Result<Rest, Error>
where
    for<'w> Worker<'w, N>: Insert<D>,
{
    let scratch = slots.scratch();
    let start = slots.any_slot(number * 7919);
    let mut inserter = Inserter { slots, vertices, scratch, last: start, misses: 0, held: 0, is_done: false };
    let mut put_off = Vec::new();
    let mut next_report = 0;
    for portion in round.portions(number) {
        // Counted over all workers, because the one that reports may get little time to insert.
        let done = round.inserted.load(Relaxed);
        if done >= next_report {
            next_report = done + Worker::<N>::REPORT;
            if let Err(error) = report(done) {
                round.is_stopped.store(true, Relaxed);
                return Err(error);
            }
        }
        let length = portion.len();
        let mut missed = Vec::new();
        for p in portion.map(|i| round.point(i)) {
            if inserter.has_to_stop(round) || !inserter.insert(p)? {
                missed.push(p);
            }
        }
        round.inserted.fetch_add(length - missed.len(), Relaxed);
        // By now the others have gone on.
        inserter.insert_again(round, &mut put_off)?;
        // One worker alone is faster than several that only disturb each other.
        let is_useless = missed.len() > length / 2 && number > 0 && !inserter.has_to_stop(round);
        put_off.append(&mut missed);
        if is_useless {
            break;
        }
    }
    for _ in 0..RETRIES {
        inserter.insert_again(round, &mut put_off)?;
    }
    let Inserter { mut slots, scratch, .. } = inserter;
    slots.finish(scratch);
    Ok(Rest { left: put_off, unused: slots.into_unused(), counts: vertices.exact_counts() })
}

/// A worker that inserts one point after the other.
struct Inserter<'a, 'w, const D: usize, const N: usize, const W: bool>
where
    Worker<'w, N>: Insert<D>,
{
    slots: Worker<'w, N>,
    vertices: &'a PredicateContext<'a, D, W>,
    scratch: <Worker<'w, N> as Insert<D>>::Scratch,
    /// Where the next walk begins.
    last: u32,
    /// How many insertions have failed since the last that succeeded.
    misses: usize,
    /// How many insertions the claims have served.
    held: usize,
    /// Whether there was no slot left.
    is_done: bool,
}

impl<'w, const D: usize, const N: usize, const W: bool> Inserter<'_, 'w, D, N, W>
where
    Worker<'w, N>: Insert<D>,
{
    /// Returns whether the run is cancelled or there was no slot left.
    fn has_to_stop(&self, round: &Round) -> bool {
        self.is_done || round.is_stopped.load(Relaxed)
    }

    /// Inserts the points that were put off, as far as no other thread is in the way again.
    fn insert_again(&mut self, round: &Round, put_off: &mut Vec<u32>) -> Result<(), Error> {
        let before = put_off.len();
        for p in std::mem::take(put_off) {
            if self.has_to_stop(round) || !self.insert(p)? {
                put_off.push(p);
            }
        }
        round.inserted.fetch_add(before - put_off.len(), Relaxed);
        Ok(())
    }

    /// Inserts a point. Returns whether no other thread was in the way.
    fn insert(&mut self, p: u32) -> Result<bool, Error> {
        let start = self.slots.locate(self.vertices, p, self.last);
        let inserted = self.slots.insert(self.vertices, p, start, &mut self.scratch)?;
        self.held += 1;
        if inserted.is_none() || self.held == INSERTIONS_PER_CLAIM {
            self.slots.release();
            self.held = 0;
        }
        match inserted {
            Some(simplex) => (self.last, self.misses) = (simplex, 0),
            None => {
                self.is_done = self.slots.is_full();
                self.misses += 1;
                // The slot may have been given up, so that no walk leads away from it.
                if self.misses > 1 {
                    self.last = self.slots.any_slot(p as usize * 7919);
                }
            }
        }
        Ok(inserted.is_some())
    }
}
