//! Splaying (Shewchuk 2005; §3.2.2): inserting points into stars until every tetrahedron of one is in those of its other
//! vertices too. Then they are the stars of one triangulation, the Delaunay triangulation.
//!
//! 1. The stars of the failed vertices are made convex. Other stars are convex in the triangulation already, and taken
//!    from there when one is needed.
//! 2. A tetrahedron is unsettled while it is in some stars, but not in all. A star that lacks it is given its vertices. If that
//!    does not bring it about, then something on this star's link lies inside its circumsphere, and is inserted into the
//!    stars that have it, which removes it.
//!
//! This is done for all unsettled tetrahedra in rounds, with each star by whichever thread is free. Tetrahedra that all stars
//! agree about with the triangulation never enter the ledger. The star of infinity is never made: it would be the whole
//! hull, and it agrees when those of the hull's vertices agree among themselves.
//!
//! Every insertion makes a star wider for good, so it ends; how soon, nobody knows, hence a bound.

use crate::{
    Error,
    parallel::{self, Threads},
};
use crate::{
    d3::splay::{
        Aborted, Stop,
        build::{How, Known},
        ledger::{Entries, Entry, Key, Ledger},
        predicates::StarPredicates,
        star::{Changes, LinkFinder, NONE, Star},
    },
    stats::SplayStats,
};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Stars that a thread takes together.
const STARS: usize = 4;
/// Unsettled tetrahedra that a thread takes together.
const TETRAHEDRA: usize = 64;

/// The stars, on their way to consistency.
pub(super) struct Splaying<'a> {
    known: Known<'a>,
    threads: Threads,
    /// In a round, each is changed by one thread.
    stars: Vec<Mutex<Star>>,
    /// For each vertex, its place in `stars` plus 1, or 0.
    star_of: Vec<u32>,
    ledger: Ledger,
    stats: SplayStats,
}

/// What the star of a vertex is to do about an unsettled tetrahedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Request {
    vertex: u32,
    /// The point whose insertion removes it, or [`NONE`] to insert its vertices.
    witness: u32,
    tetrahedron: Key,
}

/// What a thread made of the stars that it took together.
struct Made {
    /// Those that were not there before.
    stars: Vec<(Star, How)>,
    entries: Entries,
    insertions: usize,
}

impl<'a> Splaying<'a> {
    pub(super) fn new(known: Known<'a>, threads: Threads) -> Self {
        let infinite = known.mesh.infinite;
        Splaying {
            known,
            threads,
            stars: Vec::new(),
            star_of: vec![0; infinite as usize + 1],
            ledger: Ledger::new(infinite, threads),
            stats: SplayStats::default(),
        }
    }

    /// Makes the stars of the failed vertices convex, and all stars consistent, asking for at most `max_evaluations`. `report` learns
    /// which share is done, and can stop it. Gives the slots of the tetrahedra to remove, those to add, and what it took.
    pub(super) fn run(
        mut self,
        space: &StarPredicates<'_>,
        failed: &[u32],
        max_evaluations: u64,
        report: &dyn Fn(f64) -> Result<(), Error>,
    ) -> Result<(Vec<u32>, Vec<Key>, SplayStats), Stop> {
        let check_work = || if space.signs() > max_evaluations { Err(Aborted::Work) } else { Ok(()) };
        report(0.0)?;
        // How many stars there are between two reports: about as many milliseconds.
        let batch_len = match self.threads {
            Threads::One => 1 << 9,
            Threads::All => 1 << 12,
        };
        let mut entries = Vec::new();
        for (i, batch) in failed.chunks(batch_len).enumerate() {
            let made = self.convex(space, batch)?;
            self.adopt(made, &mut entries);
            check_work()?;
            report(0.5 * (i * batch_len + batch.len()) as f64 / failed.len() as f64)?;
        }
        let mut unsettled = self.ledger.enter(&entries)?;
        let mut share = 0.5;
        while !unsettled.is_empty() {
            self.stats.rounds += 1;
            self.stats.checks += unsettled.len();
            let requests = self.requests(space, &unsettled)?;
            let requests: Vec<&[Request]> = requests.chunk_by(|r, s| r.vertex == s.vertex).collect();
            let mut entries = Vec::new();
            for batch in requests.chunks(batch_len) {
                report(share)?;
                let made = self.wider(space, batch)?;
                self.adopt(made, &mut entries);
                check_work()?;
            }
            // Rounds get smaller; how many there will be is not known.
            share += (1.0 - share) / 4.0;
            unsettled = self.ledger.enter(&entries)?;
        }
        let (remove, add) = self.ledger.difference()?;
        Ok((remove, add, self.stats))
    }

    /// Makes the stars of these vertices, which have failed, convex.
    fn convex(&self, space: &StarPredicates<'_>, vertices: &[u32]) -> Result<Vec<Made>, Aborted> {
        let made = space.shared(self.threads, vertices.len(), STARS, |space, range| {
            let (mut links, mut entries) = (LinkFinder::default(), Vec::new());
            let star = |&v: &u32| self.known.convex_star(space, &mut links, v, &mut entries);
            let stars = vertices[range].iter().map(star).collect::<Result<Vec<_>, _>>()?;
            Ok(Made { stars, entries: self.ledger.sorted(entries), insertions: 0 })
        });
        made.into_iter().collect()
    }

    /// Adds the stars, counts what was done, and passes on the entries.
    fn adopt(&mut self, made: Vec<Made>, entries: &mut Vec<Entries>) {
        for Made { stars, entries: more, insertions } in made {
            for (star, how) in stars {
                match how {
                    How::Pulled => self.stats.pulled += 1,
                    How::Flipped(flips) => self.stats.flips += flips,
                    How::FromPoints => self.stats.from_points += 1,
                }
                self.stats.built += usize::from(how != How::Pulled);
                self.star_of[star.vertex as usize] = self.stars.len() as u32 + 1;
                self.stars.push(Mutex::new(star));
            }
            self.stats.insertions += insertions;
            entries.push(more);
        }
    }

    /// The star of a vertex, if it is there.
    fn star(&self, v: u32) -> Option<MutexGuard<'_, Star>> {
        let place = (self.star_of[v as usize] as usize).checked_sub(1)?;
        Some(self.stars[place].lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// What stars are to do about unsettled tetrahedra, that of each star together.
    fn requests(&self, space: &StarPredicates<'_>, unsettled: &[Key]) -> Result<Vec<Request>, Aborted> {
        let requests = space.shared(self.threads, unsettled.len(), TETRAHEDRA, |space, range| {
            let mut requests = Vec::new();
            unsettled[range].iter().try_for_each(|&key| self.add_requests(space, key, &mut requests))?;
            Ok(requests)
        });
        let mut requests = requests.into_iter().collect::<Result<Vec<_>, Aborted>>()?.concat();
        parallel::sort(self.threads, &mut requests);
        Ok(requests)
    }

    fn add_requests(&self, space: &StarPredicates<'_>, key: Key, requests: &mut Vec<Request>) -> Result<(), Aborted> {
        const NO_REASON: Aborted = Aborted::Inconsistent("a star lacks a tetrahedron without reason");
        let held = self.ledger.held(key).ok_or(NO_REASON)?;
        let vertices = self.ledger.finite(&key);
        let request = |vertex: u32, witness| Request { vertex, witness, tetrahedron: key };
        match vertices.iter().find(|&&v| held.never(key, v)) {
            None => {
                let lacking = vertices.iter().filter(|&&v| !held.has(key, v));
                requests.extend(lacking.map(|&v| request(v, NONE)));
            }
            Some(&v) => {
                let star = self.star(v).ok_or(NO_REASON)?;
                let witness = star.witness(space, key).ok_or(NO_REASON)?;
                let having = vertices.iter().filter(|&&v| held.has(key, v));
                requests.extend(having.map(|&v| request(v, witness)));
            }
        }
        Ok(())
    }

    /// Lets the stars do what these requests ask of them.
    fn wider(&self, space: &StarPredicates<'_>, requests: &[&[Request]]) -> Result<Vec<Made>, Aborted> {
        let made = space.shared(self.threads, requests.len(), STARS, |space, range| {
            let (mut links, mut changes) = (LinkFinder::default(), Changes::default());
            let (mut stars, mut entries, mut insertions) = (Vec::new(), Vec::new(), 0);
            for requests in &requests[range] {
                let v = requests[0].vertex;
                let mut widen = |star: &mut Star, entries: &mut Vec<Entry>| {
                    self.widen(space, star, requests, &mut changes, entries)
                };
                match self.star(v) {
                    Some(mut star) => insertions += widen(&mut star, &mut entries)?,
                    None => {
                        let (mut star, how) = self.known.convex_star(space, &mut links, v, &mut entries)?;
                        insertions += widen(&mut star, &mut entries)?;
                        stars.push((star, how));
                    }
                }
            }
            Ok(Made { stars, entries: self.ledger.sorted(entries), insertions })
        });
        made.into_iter().collect()
    }

    /// Does what the requests ask of a star; gives the number of points that were inserted.
    fn widen(
        &self,
        space: &StarPredicates<'_>,
        star: &mut Star,
        requests: &[Request],
        changes: &mut Changes,
        entries: &mut Vec<Entry>,
    ) -> Result<usize, Aborted> {
        let mut points = Vec::new();
        for request in requests {
            match request.witness {
                NONE => points.extend(self.ledger.finite(&request.tetrahedron).iter().filter(|&&p| p != star.vertex)),
                witness => points.push(witness),
            }
        }
        points.sort_unstable();
        points.dedup();
        points.retain(|&p| !star.has(p));
        let mut insertions = 0;
        for &p in &points {
            if star.insert(space, p, changes)? {
                insertions += 1;
                entries.extend(Entry::changes(star, &changes.removed, &changes.added));
            }
        }
        let tried = requests.iter().filter(|request| request.witness == NONE);
        entries.extend(tried.map(|request| Entry::tried(request.tetrahedron, star.vertex)));
        Ok(insertions)
    }
}
