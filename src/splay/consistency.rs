//! Splaying (Shewchuk 2005; §3.2.2): inserting points into stars until every tetrahedron of one is in those of its other
//! vertices too. Then they are the stars of one triangulation, the Delaunay triangulation.
//!
//! 1. The stars of the failed vertices are made convex. Other stars are convex in the triangulation already, and taken
//!    from there when one is needed.
//! 2. The *ledger* has the tetrahedra that some star has and the triangulation has not, or the other way round, and for
//!    each in which stars it is. It is unsettled while it is in some, but not in all.
//! 3. An unsettled tetrahedron's vertices are inserted into the star that lacks it. If that did not bring it about, then
//!    something on that star's link lies inside its circumsphere, and is inserted into the stars that have it, which
//!    removes it.
//!
//! Tetrahedra that all stars agree about with the triangulation never enter the ledger. The star of infinity is never
//! made: it would be the whole hull, and it agrees when those of the hull's vertices agree among themselves.
//!
//! Every insertion makes a star wider for good, so it ends; how soon, nobody knows, hence a bound.

use super::{
    GaveUp, SplayStats, Stop,
    flip_flop::flip_flop,
    space::Space,
    star::{Changes, LinkFinder, NONE, Star, Triangle},
};
use crate::{Error, triangulation::Triangulation};
use rustc_hash::FxHashMap;

/// An oriented tetrahedron: its vertices in ascending order, the first two exchanged if that would invert it. So an
/// inverted tetrahedron of the triangulation is another than the one that the stars have of the same vertices.
pub(super) type Key = [u32; 4];

/// The stars that have a tetrahedron.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    /// Bit *k* for the star of the key's vertex *k*. A star that was not needed has what the triangulation has.
    by: u8,
    /// Where the triangulation has it, or [`NONE`].
    pub(super) tetrahedron: u32,
}

/// How often progress is reported, in failed vertices or unsettled tetrahedra.
const REPORT: usize = 1 << 10;
/// Stars that a thread builds together.
const STARS: usize = 16;

/// The stars, on their way to consistency.
pub(super) struct Splaying<'a> {
    space: &'a Space<'a>,
    mesh: &'a Triangulation,
    /// A tetrahedron at each vertex.
    incident: &'a [u32],
    stars: Vec<Star>,
    /// For each vertex, its place in `stars` plus 1, or 0.
    star_of: Vec<u32>,
    links: LinkFinder,
    changes: Changes,
    ledger: FxHashMap<Key, Held>,
    /// Entries of the ledger that may be unsettled.
    queue: Vec<Key>,
    /// The most signs that may be asked for.
    most_signs: u64,
    pub(super) stats: SplayStats,
}

fn key(mut v: [u32; 4]) -> Key {
    let mut odd = false;
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        if v[i] > v[j] {
            v.swap(i, j);
            odd = !odd;
        }
    }
    if odd {
        v.swap(0, 1);
    }
    v
}

impl<'a> Splaying<'a> {
    pub(super) fn new(space: &'a Space<'a>, mesh: &'a Triangulation, incident: &'a [u32], most_signs: u64) -> Self {
        Splaying {
            space,
            mesh,
            incident,
            stars: Vec::new(),
            star_of: vec![0; mesh.infinite as usize + 1],
            links: LinkFinder::default(),
            changes: Changes::default(),
            ledger: FxHashMap::default(),
            queue: Vec::new(),
            most_signs,
            stats: SplayStats::default(),
        }
    }

    /// Makes the stars of the failed vertices convex, and all stars consistent. `report` learns the share of the failed
    /// vertices that is done, and can stop.
    pub(super) fn run(
        &mut self,
        failed: &[u32],
        threads: usize,
        report: &dyn Fn(f64) -> Result<(), Error>,
    ) -> Result<(), Stop> {
        report(0.0)?;
        for (i, batch) in failed.chunks(REPORT).enumerate() {
            self.build(batch, true, threads)?;
            self.check_work()?;
            report((i * REPORT + batch.len()) as f64 / failed.len() as f64)?;
        }
        // Those that are sure to be needed, while threads can share them.
        let unsettled = self.queue.iter().filter(|&key| !self.is_settled(*key));
        let mut needed: Vec<u32> = unsettled.flatten().copied().filter(|&v| self.star_of[v as usize] == 0).collect();
        needed.sort_unstable();
        needed.dedup();
        for batch in needed.chunks(REPORT) {
            report(1.0)?;
            self.build(batch, false, threads)?;
            self.check_work()?;
        }
        while let Some(key) = self.queue.pop() {
            if self.stats.checks.is_multiple_of(REPORT) {
                report(1.0)?;
            }
            self.stats.checks += 1;
            self.settle(key)?;
            self.check_work()?;
        }
        Ok(())
    }

    /// The tetrahedra on which the consistent stars and the triangulation differ: those to remove, as slots, and those
    /// to add.
    pub(super) fn difference(&self) -> Result<(Vec<u32>, Vec<Key>), GaveUp> {
        let (mut remove, mut add) = (Vec::new(), Vec::new());
        for (&key, held) in &self.ledger {
            match (held.by, held.tetrahedron) {
                (0, NONE) => {}
                (0, slot) => remove.push(slot),
                (by, NONE) if by == self.all(key) => add.push(key),
                _ => return Err(GaveUp::Inconsistent("a tetrahedron is unsettled at the end")),
            }
        }
        // The ledger's order is that of hashes.
        remove.sort_unstable();
        add.sort_unstable();
        Ok((remove, add))
    }

    fn check_work(&self) -> Result<(), GaveUp> {
        if self.space.signs() > self.most_signs { Err(GaveUp::Work) } else { Ok(()) }
    }

    /// The bits of all stars that a tetrahedron should be in.
    fn all(&self, key: Key) -> u8 {
        if key[3] == self.space.infinite() { 0b0111 } else { 0b1111 }
    }

    /// Adds the stars of these vertices, which have `failed`, or have not.
    fn build(&mut self, vertices: &[u32], failed: bool, threads: usize) -> Result<(), GaveUp> {
        let (space, mesh, incident) = (self.space, self.mesh, self.incident);
        let built = space.shared(threads, vertices.len(), STARS, |space, range| {
            let mut links = LinkFinder::default();
            let finite = vertices[range].iter().filter(|&&v| v != mesh.infinite);
            finite.map(|&v| Built::new(space, mesh, incident, &mut links, v, failed)).collect::<Vec<_>>()
        });
        built.into_iter().flatten().try_for_each(|built| self.adopt(built?))
    }

    /// Adds the star of `v`, which has not failed.
    fn pull(&mut self, v: u32) -> Result<(), GaveUp> {
        let built = Built::new(self.space, self.mesh, self.incident, &mut self.links, v, false)?;
        self.adopt(built)
    }

    /// Adds a star.
    fn adopt(&mut self, built: Built) -> Result<(), GaveUp> {
        let Built { mut star, change } = built;
        match change {
            None => self.stats.pulled += 1,
            Some(Change { before, flips }) => {
                self.stats.built += 1;
                self.stats.flips += flips.unwrap_or(0);
                self.stats.from_points += usize::from(flips.is_none());
                self.compare(&mut star, &before);
                self.enter(&star)?;
            }
        }
        let vertex = star.vertex;
        self.stars.push(star);
        self.star_of[vertex as usize] = self.stars.len() as u32;
        Ok(())
    }

    /// Finds out which triangles of a star are those that it had `before`, in the triangulation; the others are its
    /// changes.
    fn compare(&mut self, star: &mut Star, before: &[Triangle]) {
        let Changes { removed, added, .. } = &mut self.changes;
        removed.clear();
        added.clear();
        // Not sorted: that would take an inverted tetrahedron for a new one.
        let rotated = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
            least if least == a => [a, b, c],
            least if least == b => [b, c, a],
            _ => [c, a, b],
        };
        let mut gone: FxHashMap<[u32; 3], Triangle> = FxHashMap::default();
        for (i, t) in before.iter().enumerate() {
            let stays = star.triangles.get(i).is_some_and(|now| now.is_used() && now.tetrahedron == t.tetrahedron);
            if !stays {
                gone.insert(rotated(t.vertices), *t);
            }
        }
        for (i, t) in star.triangles.iter_mut().enumerate() {
            if t.is_used() && t.tetrahedron == NONE {
                match gone.remove(&rotated(t.vertices)) {
                    Some(same) => t.tetrahedron = same.tetrahedron,
                    None => added.push(i as u32),
                }
            }
        }
        removed.extend(gone.into_values());
    }

    /// Enters the changes of a star into the ledger.
    fn enter(&mut self, star: &Star) -> Result<(), GaveUp> {
        const BIT: GaveUp = GaveUp::Inconsistent("a star gains what it has, or loses what it has not");
        for t in &self.changes.removed {
            let key = key(star.tetrahedron(t.vertices));
            let all = self.all(key);
            let held = match t.tetrahedron {
                NONE => self.ledger.get_mut(&key).ok_or(BIT)?,
                tetrahedron => self.ledger.entry(key).or_insert(Held { by: all, tetrahedron }),
            };
            let bit = bit(key, star.vertex);
            if held.by & bit == 0 {
                return Err(BIT);
            }
            held.by &= !bit;
            if held.by != 0 {
                self.queue.push(key);
            }
        }
        for &t in &self.changes.added {
            let key = key(star.tetrahedron(star.triangles[t as usize].vertices));
            let all = self.all(key);
            let held = self.ledger.entry(key).or_insert(Held { by: 0, tetrahedron: NONE });
            let bit = bit(key, star.vertex);
            if held.by & bit != 0 {
                return Err(BIT);
            }
            held.by |= bit;
            if held.by != all {
                self.queue.push(key);
            }
        }
        Ok(())
    }

    /// Inserts `p` into the star of `v`, which is there.
    fn insert(&mut self, v: u32, p: u32) -> Result<(), GaveUp> {
        let place = self.star_of[v as usize] as usize - 1;
        let mut star = std::mem::take(&mut self.stars[place]);
        if star.insert(self.space, p, &mut self.changes)? {
            self.stats.insertions += 1;
            self.enter(&star)?;
        }
        self.stars[place] = star;
        Ok(())
    }

    /// Whether all stars have a tetrahedron, or none.
    fn is_settled(&self, key: Key) -> bool {
        self.ledger.get(&key).is_none_or(|held| held.by == 0 || held.by == self.all(key))
    }

    /// Brings it about that all stars have a tetrahedron, or none.
    fn settle(&mut self, key: Key) -> Result<(), GaveUp> {
        let all = self.all(key);
        let by = |ledger: &FxHashMap<Key, Held>| ledger.get(&key).map_or(0, |held| held.by);
        let settled = |by: u8| by == 0 || by == all;
        if self.is_settled(key) {
            return Ok(());
        }
        // Infinity, being the highest, is the last.
        let vertices = &key[..all.count_ones() as usize];
        for &v in vertices {
            if self.star_of[v as usize] == 0 {
                self.pull(v)?;
            }
        }
        for &v in vertices {
            for &p in vertices {
                let held = by(&self.ledger);
                if settled(held) {
                    return Ok(());
                }
                if p != v && held & bit(key, v) == 0 {
                    self.insert(v, p)?;
                }
            }
        }
        // Some star has all its vertices among its points, and yet not the tetrahedron.
        let held = by(&self.ledger);
        if settled(held) {
            return Ok(());
        }
        let lacking = vertices.iter().find(|&&v| held & bit(key, v) == 0);
        let witness = lacking.and_then(|&v| self.star(v).witness(self.space, key));
        let witness = witness.ok_or(GaveUp::Inconsistent("a star lacks a tetrahedron without reason"))?;
        for &v in vertices {
            if held & bit(key, v) != 0 {
                self.insert(v, witness)?;
            }
        }
        if by(&self.ledger) == 0 { Ok(()) } else { Err(GaveUp::Inconsistent("a star keeps a tetrahedron")) }
    }

    fn star(&self, v: u32) -> &Star {
        &self.stars[self.star_of[v as usize] as usize - 1]
    }
}

/// A star that is convex.
struct Built {
    star: Star,
    /// How it was made so, where the triangulation's was not or not known to be.
    change: Option<Change>,
}

struct Change {
    /// The star's triangles in the triangulation.
    before: Vec<Triangle>,
    /// The flips of Flip-Flop; `None` where the star was built from its points.
    flips: Option<usize>,
}

impl Built {
    /// The star of `v`: made convex from what the triangulation has, if that was found to have failed; else taken as it
    /// is, unless a tetrahedron is flat or inverted.
    fn new(
        space: &Space<'_>,
        mesh: &Triangulation,
        incident: &[u32],
        links: &mut LinkFinder,
        v: u32,
        failed: bool,
    ) -> Result<Self, GaveUp> {
        let mut star = links.star(mesh, v, incident[v as usize])?;
        let is_oriented = star.is_oriented(space);
        if is_oriented && !failed {
            return Ok(Built { star, change: None });
        }
        let before = star.triangles.clone();
        let flips = is_oriented.then(|| flip_flop(&mut star, space)).flatten();
        if flips.is_none() {
            let mut points: Vec<u32> = before.iter().flat_map(|t| t.vertices).collect();
            points.sort_unstable();
            points.dedup();
            star = Star::from_points(space, v, points.into_iter(), &mut Changes::default())?;
        }
        Ok(Built { star, change: Some(Change { before, flips }) })
    }
}

/// The bit of a vertex in [`Held::by`].
fn bit(key: Key, vertex: u32) -> u8 {
    key.iter().position(|&v| v == vertex).map_or(0, |k| 1 << k)
}
