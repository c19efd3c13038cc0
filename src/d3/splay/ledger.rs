//! The ledger: the tetrahedra about which the stars and the triangulation disagree, or did.

use crate::d3::splay::{
    Aborted,
    star::{NONE, Star, Triangle},
};
use crate::parallel::{self, Threads};
use rustc_hash::FxHashMap;

/// An oriented tetrahedron: its vertices in ascending order, the first two exchanged if that would invert it. So an
/// inverted tetrahedron of the triangulation is another than the one that the stars have of the same vertices.
pub(super) type Key = [u32; 4];

/// Parts of the ledger, one for each of the threads that there may be.
const PARTS: usize = 16;

/// What the stars make of a tetrahedron.
#[derive(Debug, Clone, Copy)]
pub(super) struct Held {
    /// The stars that have it: bit *k* for that of the key's vertex *k*. A star that was not needed has what the
    /// triangulation has.
    by: u8,
    /// The stars that never will, since all its vertices are among their points, and it is not theirs.
    never: u8,
    /// It was touched, and is still to be looked at.
    touched: bool,
    /// Where the triangulation has it, or [`NONE`].
    tetrahedron: u32,
}

/// What became of a tetrahedron in the star of a vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    key: Key,
    vertex: u32,
    event: Event,
}

/// What can become of it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Event {
    /// The star has it now.
    Gained,
    /// The star has it no more; the triangulation has it there, or [`NONE`].
    Lost(u32),
    /// Its vertices were inserted.
    Tried,
}

/// What has become of tetrahedra in some stars, by the part of the ledger that they belong to; that of each star in order.
pub(super) struct Entries {
    sorted: Vec<Entry>,
    ends: [u32; PARTS],
}

impl Entries {
    /// Those for a part of the ledger.
    fn of_part(&self, i: usize) -> &[Entry] {
        let start = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.sorted[start as usize..self.ends[i] as usize]
    }
}

/// The tetrahedra that are not as they were in the triangulation, in some star.
pub(super) struct Ledger {
    parts: Vec<FxHashMap<Key, Held>>,
    infinite: u32,
    threads: Threads,
}

/// The key of a positively oriented tetrahedron.
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

/// The bit of a vertex in [`Held`].
fn bit(key: Key, vertex: u32) -> u8 {
    key.iter().position(|&v| v == vertex).map_or(0, |k| 1 << k)
}

impl Held {
    fn new(by: u8, tetrahedron: u32) -> Self {
        Held { by, never: 0, touched: false, tetrahedron }
    }

    /// Whether the star of a vertex has it.
    pub(super) fn has(&self, key: Key, vertex: u32) -> bool {
        self.by & bit(key, vertex) != 0
    }

    /// Whether the star of a vertex never will.
    pub(super) fn never(&self, key: Key, vertex: u32) -> bool {
        self.never & bit(key, vertex) != 0
    }

    /// Enters an event of the star with this bit.
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
            Event::Tried => self.never |= bit,
        }
        Ok(())
    }
}

impl Entry {
    /// The vertices of a tetrahedron have been inserted into the star of one of them.
    pub(super) fn tried(key: Key, vertex: u32) -> Self {
        Entry { key, vertex, event: Event::Tried }
    }

    /// The entries for a star that has lost the triangles `removed`, and gained those that are `added`.
    pub(super) fn changes(star: &Star, removed: &[Triangle], added: &[u32]) -> impl Iterator<Item = Self> {
        let entry = |vertices, event| Entry { key: key(star.tetrahedron(vertices)), vertex: star.vertex, event };
        let lost = removed.iter().map(move |t| entry(t.vertices, Event::Lost(t.tetrahedron)));
        lost.chain(added.iter().map(move |&t| entry(star.triangles[t as usize].vertices, Event::Gained)))
    }
}

impl Ledger {
    /// An empty one.
    pub(super) fn new(infinite: u32, threads: Threads) -> Self {
        let parts = match threads {
            Threads::One => 1,
            Threads::All => PARTS,
        };
        Ledger { parts: vec![FxHashMap::default(); parts], infinite, threads }
    }

    /// What the stars make of a tetrahedron that was entered.
    pub(super) fn held(&self, key: Key) -> Option<&Held> {
        self.parts[part(key, self.parts.len())].get(&key)
    }

    /// The finite vertices of a tetrahedron: infinity, being the highest, is the last.
    pub(super) fn finite<'k>(&self, key: &'k Key) -> &'k [u32] {
        &key[..if key[3] == self.infinite { 3 } else { 4 }]
    }

    /// Sorts entries for [`Ledger::enter`].
    pub(super) fn sorted(&self, entries: Vec<Entry>) -> Entries {
        let count = self.parts.len();
        let mut ends = [0; PARTS];
        if count == 1 {
            ends[0] = entries.len() as u32;
            return Entries { sorted: entries, ends };
        }
        // A stable counting sort.
        entries.iter().for_each(|entry| ends[part(entry.key, count)] += 1);
        let mut place = 0;
        for end in &mut ends {
            place += std::mem::replace(end, place);
        }
        let mut sorted = entries.clone();
        for entry in entries {
            let place = &mut ends[part(entry.key, count)];
            sorted[*place as usize] = entry;
            *place += 1;
        }
        Entries { sorted, ends }
    }

    /// Enters what has happened, and gives the tetrahedra that it leaves unsettled: those that
    /// are in some stars, but not in all.
    pub(super) fn enter(&mut self, entries: &[Entries]) -> Result<Vec<Key>, Aborted> {
        let infinite = self.infinite;
        let unsettled = parallel::map_mut(self.threads, &mut self.parts, |i, held_by_key| {
            let mut touched = Vec::new();
            for entry in entries.iter().flat_map(|entries| entries.of_part(i)) {
                let key = entry.key;
                let held = match entry.event {
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
            Ok(touched)
        });
        Ok(unsettled.into_iter().collect::<Result<Vec<_>, Aborted>>()?.concat())
    }

    /// The tetrahedra on which the consistent stars and the triangulation differ: those to remove, as slots, and those
    /// to add.
    pub(super) fn difference(&mut self) -> Result<(Vec<u32>, Vec<Key>), Aborted> {
        let infinite = self.infinite;
        let parts = parallel::map_mut(self.threads, &mut self.parts, |_, held_by_key| {
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
        // The ledger's order is that of hashes.
        remove.sort_unstable();
        add.sort_unstable();
        Ok((remove, add))
    }
}

const UNKNOWN: Aborted = Aborted::Inconsistent("a star has a tetrahedron that nobody entered");

/// The bits of all stars that a tetrahedron should be in.
fn all(key: Key, infinite: u32) -> u8 {
    if key[3] == infinite { 0b0111 } else { 0b1111 }
}

/// The part of the ledger that a tetrahedron is in.
fn part(key: Key, parts: usize) -> usize {
    let mixed = key.iter().fold(0u32, |mixed, &v| (mixed.rotate_left(9) ^ v).wrapping_mul(0x9e37_79b9));
    (mixed >> 16) as usize % parts
}
