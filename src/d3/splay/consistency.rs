//! Splaying (Shewchuk 2005; §3.2.2): points are inserted into stars until every tetrahedron of a
//! star is also in the stars of its other vertices. Then the stars are those of one triangulation,
//! the Delaunay triangulation.
//!
//! 1. The stars of the failed vertices are made convex. Other stars are already convex in the
//!    triangulation, and are taken from there when they are needed; before that, they are gathered
//!    if the region lacks them.
//! 2. A tetrahedron is unsettled while it is in some stars of its vertices, but not in all. Its
//!    vertices are inserted into a star that lacks it. If the star still lacks it then, some vertex
//!    on the star's link lies inside the circumsphere, and is inserted into the stars that have the
//!    tetrahedron, which removes it.
//!
//! Rounds do this for all unsettled tetrahedra, each star by whichever thread is free. Tetrahedra
//! on which all stars agree with the triangulation never enter the ledger. The star of infinity is
//! never built: it would be the whole hull, and it agrees if the stars of the hull's vertices agree
//! among themselves.
//!
//! Every insertion makes a star wider for good, so splaying ends. There is no useful bound on how
//! soon, hence the budget.

use crate::{
    d3::splay::{
        Aborted, Stop,
        build::{Known, Origin},
        ledger::{Entries, Entry, Key, Ledger},
        memory::{Lists, StarMemory},
        predicates::StarPredicates,
        region::Region,
        star::Star,
    },
    index::NONE,
    parallel::{self, Pool, Threads},
    stats::SplayStats,
};
use rustc_hash::FxHashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The number of unsettled tetrahedra that a thread takes at a time.
const TETRAHEDRON_GRAIN: usize = 64;

/// Returns how many of `len` stars a thread takes at a time. A star takes up to a tenth of a
/// millisecond, so that of a few hundred each is worth handing over.
fn star_grain(len: usize) -> usize {
    (len / 1024).clamp(1, 4)
}

/// The stars, on their way to consistency.
pub(super) struct Splaying {
    pub(super) known: Known,
    pub(super) threads: Threads,
    /// In a round, each star is changed by one thread only.
    pub(super) stars: Vec<Mutex<Star>>,
    /// The place in `stars` of each vertex that has one.
    star_of: FxHashMap<u32, u32>,
    pub(super) ledger: Ledger,
    /// The lists of each thread.
    lists: Pool<Lists>,
    /// The tetrahedra that are unsettled.
    unsettled: Vec<Key>,
    /// What a round is to do, while stars are missing for it.
    requests: Vec<Request>,
    /// The share of the work that is done.
    share: f64,
    pub(super) stats: SplayStats,
}

/// What the star of a vertex has to do about an unsettled tetrahedron.
#[derive(Debug, Clone, Copy)]
struct Request {
    vertex: u32,
    /// The point whose insertion removes the tetrahedron, or [`NONE`] to insert its vertices.
    witness: u32,
    /// The place of the tetrahedron among those that are unsettled.
    tetrahedron: u32,
}

/// What a thread did to the stars that it took.
struct BatchResult {
    /// The stars that are new.
    stars: Vec<(Star, Origin)>,
    entries: Entries,
}

impl Splaying {
    pub(super) fn new(mut known: Known, threads: Threads) -> Self {
        let infinite = known.region.mesh.infinite;
        let StarMemory { lists, star_of, ledger } = known.region.memory.take_stars();
        let ledger = Ledger::new(ledger, infinite, threads);
        Splaying {
            known,
            threads,
            stars: Vec::new(),
            star_of,
            ledger,
            lists,
            unsettled: Vec::new(),
            requests: Vec::new(),
            share: 0.5,
            stats: SplayStats::default(),
        }
    }

    /// Returns the region, with the memory of the stars, and what splaying did.
    pub(super) fn finish(self) -> (Region, SplayStats) {
        let Splaying { known: Known { mut region, .. }, stats, stars, star_of, ledger, lists, .. } = self;
        let stars = stars.into_iter().map(|star| star.into_inner().unwrap_or_else(PoisonError::into_inner));
        region.memory.keep_stars(StarMemory { lists, star_of, ledger: Some(ledger) }, stars);
        (region, stats)
    }

    /// Makes the stars of the failed vertices convex.
    ///
    /// # Errors
    ///
    /// Those of `report`, which gets the share of the work that is done, and [`Aborted`].
    pub(super) fn begin(
        &mut self,
        predicates: &StarPredicates<'_>,
        failed: &[u32],
        report: &dyn Fn(f64) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        report(0.0)?;
        let batch_len = self.batch_len();
        let mut results = Vec::new();
        for (i, batch) in failed.chunks(batch_len).enumerate() {
            results.extend(self.make_convex(predicates, batch)?);
            report(0.5 * (i * batch_len + batch.len()) as f64 / failed.len() as f64)?;
        }
        Ok(self.adopt(results)?)
    }

    /// Makes all stars consistent, as far as the region has the stars that this takes. Returns the
    /// vertices of which it lacks them, all that a round needs; none at the end.
    ///
    /// # Errors
    ///
    /// Those of `report`, which gets the share of the work that is done, and [`Aborted`].
    pub(super) fn settle(
        &mut self,
        predicates: &StarPredicates<'_>,
        report: &dyn Fn(f64) -> Result<(), Stop>,
    ) -> Result<Vec<u32>, Stop> {
        while !self.unsettled.is_empty() {
            if self.requests.is_empty() {
                self.stats.rounds += 1;
                self.requests = self.requests(predicates)?;
                let wanted = self.requests.chunk_by(|r, s| r.vertex == s.vertex).map(|requests| requests[0].vertex);
                let lacking = self.known.region.lacking(wanted);
                if !lacking.is_empty() {
                    return Ok(lacking);
                }
            }
            let mut results = Vec::new();
            let requests = std::mem::take(&mut self.requests);
            let mut requests: Vec<&[Request]> = requests.chunk_by(|r, s| r.vertex == s.vertex).collect();
            // Stars that are near each other have tetrahedra and points in common.
            let places = requests.iter().map(|r| self.known.region.vertex_simplex[r[0].vertex as usize]).collect();
            parallel::sort_by_keys(self.threads, &mut requests, places);
            for batch in requests.chunks(self.batch_len()) {
                results.extend(self.widen_stars(predicates, batch)?);
                report(self.share)?;
            }
            // Rounds become smaller. Their number is not known, so each counts for a quarter of
            // what is left.
            self.share += (1.0 - self.share) / 4.0;
            self.adopt(results)?;
        }
        Ok(Vec::new())
    }

    /// Returns what changes when all stars are consistent: the tetrahedra to remove, and those to
    /// add.
    pub(super) fn difference(&mut self) -> Result<(Vec<u32>, Vec<Key>), Aborted> {
        self.ledger.difference()
    }

    /// Returns the number of stars between two reports of progress, larger where threads share them.
    fn batch_len(&self) -> usize {
        match self.threads {
            Threads::One => 1 << 9,
            Threads::All => 1 << 14,
        }
    }

    /// Makes the stars of these vertices, which have failed, convex.
    fn make_convex(&self, predicates: &StarPredicates<'_>, vertices: &[u32]) -> Result<Vec<BatchResult>, Aborted> {
        let results =
            predicates.shared(self.threads, vertices.len(), star_grain(vertices.len()), |predicates, range| {
                self.lists.with(|lists| {
                    lists.entries.clear();
                    let star = |&v: &u32| self.known.convex_star(predicates, lists, v);
                    let stars = vertices[range].iter().map(star).collect::<Result<Vec<_>, _>>()?;
                    Ok(BatchResult { stars, entries: Ledger::sorted(&lists.entries) })
                })
            });
        results.into_iter().collect()
    }

    /// Adds the stars, counts what was done, and enters what has happened into the ledger, which leaves
    /// some tetrahedra unsettled.
    fn adopt(&mut self, results: Vec<BatchResult>) -> Result<(), Aborted> {
        let (mut new, mut entries) = (Vec::with_capacity(results.len()), Vec::with_capacity(results.len()));
        for result in results {
            new.push(result.stars);
            entries.push(result.entries);
        }
        let Splaying { ledger, stars, star_of, stats, .. } = self;
        let enter = || ledger.enter(&entries);
        let add = || {
            let more = new.iter().map(Vec::len).sum();
            stars.reserve(more);
            star_of.reserve(more);
            for (star, origin) in new.into_iter().flatten() {
                match origin {
                    Origin::Pulled => stats.pulled += 1,
                    Origin::Flipped(flips) => stats.flips += flips,
                    Origin::FromPoints => {}
                }
                stats.built += usize::from(origin != Origin::Pulled);
                star_of.insert(star.vertex, stars.len() as u32);
                stars.push(Mutex::new(star));
            }
        };
        self.unsettled = parallel::both(self.threads, add, enter).1?;
        parallel::dispose(entries);
        Ok(())
    }

    /// Returns the star of a vertex, if it has been built.
    fn star(&self, v: u32) -> Option<MutexGuard<'_, Star>> {
        let &place = self.star_of.get(&v)?;
        Some(self.stars[place as usize].lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Returns the requests for all unsettled tetrahedra, sorted by vertex.
    fn requests(&self, predicates: &StarPredicates<'_>) -> Result<Vec<Request>, Aborted> {
        let requests = predicates.shared(self.threads, self.unsettled.len(), TETRAHEDRON_GRAIN, |predicates, range| {
            let mut requests = Vec::new();
            for i in range {
                self.add_requests(predicates, i as u32, &mut requests)?;
            }
            Ok(requests)
        });
        let mut requests = requests.into_iter().collect::<Result<Vec<_>, Aborted>>()?.concat();
        let vertices = requests.iter().map(|request| request.vertex).collect();
        parallel::sort_by_keys(self.threads, &mut requests, vertices);
        Ok(requests)
    }

    /// Adds the requests for one unsettled tetrahedron.
    fn add_requests(
        &self,
        predicates: &StarPredicates<'_>,
        unsettled: u32,
        requests: &mut Vec<Request>,
    ) -> Result<(), Aborted> {
        const NO_REASON: Aborted = Aborted::Inconsistent("a star lacks a tetrahedron without reason");
        let key = self.unsettled[unsettled as usize];
        let held = self.ledger.held(key).ok_or(NO_REASON)?;
        let vertices = self.ledger.finite(&key);
        let request = |vertex: u32, witness| Request { vertex, witness, tetrahedron: unsettled };
        match vertices.iter().find(|&&v| held.never(key, v)) {
            None => {
                let lacking = vertices.iter().filter(|&&v| !held.has(key, v));
                requests.extend(lacking.map(|&v| request(v, NONE)));
            }
            Some(&v) => {
                let star = self.star(v).ok_or(NO_REASON)?;
                let witness = star.witness(predicates, key).ok_or(NO_REASON)?;
                let having = vertices.iter().filter(|&&v| held.has(key, v));
                requests.extend(having.map(|&v| request(v, witness)));
            }
        }
        Ok(())
    }

    /// Carries out these requests, one list per star.
    fn widen_stars(
        &self,
        predicates: &StarPredicates<'_>,
        requests: &[&[Request]],
    ) -> Result<Vec<BatchResult>, Aborted> {
        let results =
            predicates.shared(self.threads, requests.len(), star_grain(requests.len()), |predicates, range| {
                self.lists.with(|lists| {
                    lists.entries.clear();
                    let mut stars = Vec::new();
                    for requests in &requests[range] {
                        let v = requests[0].vertex;
                        match self.star(v) {
                            Some(mut star) => self.widen(predicates, &mut star, requests, lists)?,
                            None => {
                                let (mut star, origin) = self.known.convex_star(predicates, lists, v)?;
                                self.widen(predicates, &mut star, requests, lists)?;
                                stars.push((star, origin));
                            }
                        }
                    }
                    Ok(BatchResult { stars, entries: Ledger::sorted(&lists.entries) })
                })
            });
        results.into_iter().collect()
    }

    /// Carries out the requests to a star.
    fn widen(
        &self,
        predicates: &StarPredicates<'_>,
        star: &mut Star,
        requests: &[Request],
        lists: &mut Lists,
    ) -> Result<(), Aborted> {
        let Lists { changes, entries, points, .. } = lists;
        // Each point is the upper half, and the place of its request the lower half.
        points.clear();
        let entry = |p: u32, i: usize| u64::from(p) << 32 | i as u64;
        for (i, request) in requests.iter().enumerate() {
            let tetrahedron = self.unsettled[request.tetrahedron as usize];
            match request.witness {
                NONE => {
                    let others = self.ledger.finite(&tetrahedron).iter().filter(|&&p| p != star.vertex);
                    points.extend(others.map(|&p| entry(p, i)));
                }
                witness => points.push(entry(witness, i)),
            }
        }
        parallel::sort_keyed(Threads::One, points);
        points.dedup_by_key(|&mut entry| entry >> 32);
        points.retain(|&entry| !star.has((entry >> 32) as u32));
        for &entry in points.iter() {
            let tetrahedron = self.unsettled[requests[entry as u32 as usize].tetrahedron as usize];
            if star.insert_near(predicates, (entry >> 32) as u32, tetrahedron, changes)? {
                entries.extend(Entry::changes(star, &changes.removed, &changes.added));
            }
        }
        let tried = requests.iter().filter(|request| request.witness == NONE);
        entries.extend(tried.map(|request| Entry::tried(self.unsettled[request.tetrahedron as usize], star.vertex)));
        Ok(())
    }
}
