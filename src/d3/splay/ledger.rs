//! The ledger: the tetrahedra on which the stars and the triangulation disagree, or have disagreed.

use crate::d3::splay::{
    Aborted,
    star::{Star, Triangle},
};
use crate::{
    index::NONE,
    parallel::{self, Threads},
};
use rustc_hash::FxHashMap;

/// An oriented tetrahedron: its vertices in ascending order, the first two exchanged if sorting
/// would invert it. So an inverted tetrahedron of the triangulation differs from the tetrahedron of
/// the same vertices in the stars.
pub(super) type Key = [u32; 4];

/// The number of parts of the ledger, each of which is updated by one thread at a time. It does not depend on the
/// number of threads, because what is unsettled comes in the order of the parts.
const PARTS: usize = 16;

/// The number of stars that enter a tetrahedron which is new to the ledger, as a rule.
const STARS: usize = 4;

/// From how many entries on it is worth that threads share them.
const SHARED_FROM: usize = 1 << 11;

/// Which stars have a tetrahedron.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    /// The stars that have it: bit *k* for the star of the key's vertex *k*. A star that has not
    /// been built has what the triangulation has.
    by: u8,
    /// The stars that will never have it, because all its vertices are among their points, but it
    /// is not theirs.
    never: u8,
    /// Whether it has changed and is still to be examined.
    touched: bool,
    /// The slot of the tetrahedron in the triangulation, or [`NONE`].
    tetrahedron: u32,
}

/// What happened to a tetrahedron in the star of a vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    key: Key,
    vertex: u32,
    event: Event,
}

/// What can happen to a tetrahedron in a star.
#[derive(Debug, Clone, Copy)]
pub(super) enum Event {
    /// The star has it now.
    Gained,
    /// The star no longer has it. The triangulation has it in this slot, or [`NONE`].
    Lost(u32),
    /// Its vertices were inserted into the star.
    Tried,
    /// The triangulation has it once more, in this slot: where it has inverted tetrahedra, it may have
    /// the others twice.
    Double(u32),
}

/// Entries, grouped by the part of the ledger that they belong to, and in each group those of a
/// star in their order.
pub(super) struct Entries {
    sorted: Vec<Entry>,
    ends: [u32; PARTS],
}

impl Entries {
    /// Returns the entries for part `i` of the ledger.
    fn of_part(&self, i: usize) -> &[Entry] {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.sorted[start as usize..self.ends[i] as usize]
    }
}

/// The tetrahedra that differ, in some star, from the triangulation.
#[derive(Debug)]
pub(super) struct Ledger {
    parts: Vec<FxHashMap<Key, Held>>,
    /// The slots of tetrahedra that the triangulation has more than once, but for the first of each.
    doubles: Vec<u32>,
    infinite: u32,
    threads: Threads,
}

/// Returns the key of a positively oriented tetrahedron.
pub(super) fn key(mut v: [u32; 4]) -> Key {
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

/// Returns the bit of a vertex in [`Held`].
fn bit(key: Key, vertex: u32) -> u8 {
    key.iter().position(|&v| v == vertex).map_or(0, |k| 1 << k)
}

impl Held {
    /// Creates the state of a tetrahedron that the stars `by` have.
    fn new(by: u8, tetrahedron: u32) -> Self {
        Held { by, never: 0, touched: false, tetrahedron }
    }

    /// Returns whether the star of a vertex has it.
    pub(super) fn has(&self, key: Key, vertex: u32) -> bool {
        self.by & bit(key, vertex) != 0
    }

    /// Returns whether the star of a vertex will never have it.
    pub(super) fn never(&self, key: Key, vertex: u32) -> bool {
        self.never & bit(key, vertex) != 0
    }

    /// Applies an event of the star with this bit.
    fn enter(&mut self, bit: u8, event: Event) -> Result<(), Aborted> {
        const HAS: Aborted = Aborted::Inconsistent("a star gains what it has, or loses what it has not");
        let has = self.by & bit != 0;
        match event {
            Event::Gained if has || self.never & bit != 0 => return Err(HAS),
            Event::Lost(_) if !has => return Err(HAS),
            Event::Gained => self.by |= bit,
            Event::Lost(_) => {
                self.by &= !bit;
                self.never |= bit;
            }
            Event::Tried if has => {}
            Event::Double(_) => {}
            Event::Tried => self.never |= bit,
        }
        Ok(())
    }
}

impl Entry {
    /// Creates the entry for a star into which the vertices of a tetrahedron have been inserted.
    pub(super) fn tried(key: Key, vertex: u32) -> Self {
        Entry { key, vertex, event: Event::Tried }
    }

    /// Creates the entry for a triangle of a star that the triangulation has more than once.
    pub(super) fn double(star: &Star, triangle: &Triangle) -> Self {
        let key = key(star.tetrahedron(triangle.vertices));
        Entry { key, vertex: star.vertex, event: Event::Double(triangle.tetrahedron) }
    }

    /// Returns the entries for a star that has lost the triangles `removed`, and gained those in
    /// the slots `added`.
    pub(super) fn changes(star: &Star, removed: &[Triangle], added: &[u32]) -> impl Iterator<Item = Self> {
        let entry = |vertices, event| Entry { key: key(star.tetrahedron(vertices)), vertex: star.vertex, event };
        let lost = removed.iter().map(move |t| entry(t.vertices, Event::Lost(t.tetrahedron)));
        lost.chain(added.iter().map(move |&t| entry(star.triangles[t as usize].vertices, Event::Gained)))
    }
}

impl Ledger {
    /// Creates an empty ledger, in the memory of an empty one if there is one.
    pub(super) fn new(emptied: Option<Ledger>, infinite: u32, threads: Threads) -> Self {
        let (parts, doubles) = match emptied {
            Some(Ledger { parts, doubles, .. }) => (parts, doubles),
            None => (vec![FxHashMap::default(); PARTS], Vec::new()),
        };
        Ledger { parts, doubles, infinite, threads }
    }

    /// Removes all entries.
    pub(super) fn clear(&mut self) {
        self.parts.iter_mut().for_each(FxHashMap::clear);
        self.doubles.clear();
    }

    /// Returns which stars have a tetrahedron, if it was entered.
    pub(super) fn held(&self, key: Key) -> Option<&Held> {
        self.parts[part(key)].get(&key)
    }

    /// Returns the finite vertices of a tetrahedron. Infinity, which has the highest number, is the
    /// last vertex.
    pub(super) fn finite<'k>(&self, key: &'k Key) -> &'k [u32] {
        &key[..if key[3] == self.infinite { 3 } else { 4 }]
    }

    /// Groups entries for [`Ledger::enter`].
    pub(super) fn sorted(entries: &[Entry]) -> Entries {
        let mut ends = [0; PARTS];
        // A stable counting sort.
        entries.iter().for_each(|entry| ends[part(entry.key)] += 1);
        let mut place = 0;
        for end in &mut ends {
            place += std::mem::replace(end, place);
        }
        let mut sorted = entries.to_vec();
        for &entry in entries {
            let place = &mut ends[part(entry.key)];
            sorted[*place as usize] = entry;
            *place += 1;
        }
        Entries { sorted, ends }
    }

    /// Enters what has happened. Returns the tetrahedra that it leaves unsettled: those that are in
    /// some stars of their vertices, but not in all.
    pub(super) fn enter(&mut self, entries: &[Entries]) -> Result<Vec<Key>, Aborted> {
        let infinite = self.infinite;
        let len: usize = entries.iter().map(|entries| entries.sorted.len()).sum();
        let threads = if len < SHARED_FROM { Threads::One } else { self.threads };
        let results = parallel::map_mut(threads, &mut self.parts, |i, held_by_key| {
            let (mut touched, mut doubles) = (Vec::new(), Vec::new());
            let len: usize = entries.iter().map(|entries| entries.of_part(i).len()).sum();
            held_by_key.reserve(len / STARS);
            for entry in entries.iter().flat_map(|entries| entries.of_part(i)) {
                let key = entry.key;
                let held = match entry.event {
                    Event::Double(slot) => {
                        doubles.push(slot);
                        continue;
                    }
                    Event::Lost(NONE) | Event::Tried => held_by_key.get_mut(&key).ok_or(UNKNOWN)?,
                    Event::Lost(tetrahedron) => {
                        held_by_key.entry(key).or_insert(Held::new(all(key, infinite), tetrahedron))
                    }
                    Event::Gained => held_by_key.entry(key).or_insert(Held::new(0, NONE)),
                };
                held.enter(bit(key, entry.vertex), entry.event)?;
                if !std::mem::replace(&mut held.touched, true) {
                    touched.push(key);
                }
            }
            touched.retain(|key| {
                held_by_key.get_mut(key).is_some_and(|held| {
                    held.touched = false;
                    held.by != 0 && held.by != all(*key, infinite)
                })
            });
            Ok((touched, doubles))
        });
        let mut unsettled = Vec::new();
        for result in results {
            let (touched, doubles) = result?;
            unsettled.extend(touched);
            self.doubles.extend(doubles);
        }
        Ok(unsettled)
    }

    /// Returns the tetrahedra on which the consistent stars and the triangulation differ: the slots
    /// of those to remove, and those to add.
    pub(super) fn difference(&mut self) -> Result<(Vec<u32>, Vec<Key>), Aborted> {
        let infinite = self.infinite;
        let len: usize = self.parts.iter().map(FxHashMap::len).sum();
        let threads = if len < SHARED_FROM { Threads::One } else { self.threads };
        let parts = parallel::map_mut(threads, &mut self.parts, |_, held_by_key| {
            let (mut remove, mut add) = (Vec::new(), Vec::new());
            for (&key, held) in held_by_key.iter() {
                match (held.by, held.tetrahedron) {
                    (0, NONE) => {}
                    (0, slot) => remove.push(slot),
                    (by, NONE) if by == all(key, infinite) => add.push(key),
                    _ => return Err(Aborted::Inconsistent("a tetrahedron is unsettled at the end")),
                }
            }
            Ok((remove, add))
        });
        let (mut remove, mut add) = (Vec::new(), Vec::new());
        for part in parts {
            let (slots, keys) = part?;
            remove.extend(slots);
            add.extend(keys);
        }
        remove.extend(&self.doubles);
        // The order in the hash tables is arbitrary, and each star has its doubles.
        parallel::sort(self.threads, &mut remove);
        remove.dedup();
        parallel::sort(self.threads, &mut add);
        Ok((remove, add))
    }
}

const UNKNOWN: Aborted = Aborted::Inconsistent("a star has a tetrahedron that nobody entered");

/// Returns the bits of all stars in which a tetrahedron should be: those of its finite vertices.
fn all(key: Key, infinite: u32) -> u8 {
    if key[3] == infinite { 0b0111 } else { 0b1111 }
}

/// Returns the part of the ledger to which a tetrahedron belongs.
fn part(key: Key) -> usize {
    (mixed(&key) >> 16) as usize % PARTS
}

/// Returns a number that differs for most lists of vertices.
pub(super) fn mixed(vertices: &[u32]) -> u32 {
    vertices.iter().fold(0, |mixed, &v| (mixed.rotate_left(9) ^ v).wrapping_mul(0x9e37_79b9))
}
