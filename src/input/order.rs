//! The order in which points are inserted: duplicates are removed, then rounds of growing size
//! (biased randomised insertion order, BRIO: Amenta, Choi and Rote 2003), each along the Hilbert
//! curve.

use crate::{
    index::NONE,
    input::{lattice::Lattice, points::Points},
    parallel::{self, Threads},
};
use std::{cmp::Ordering, ops::Range};

/// An insertion order. The mesh does not depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Order {
    /// Biased randomised rounds, each along the Hilbert curve.
    #[default]
    Brio,
    /// A random order, by seed, with which tests check that the mesh does not depend on the order.
    Shuffled(u64),
}

/// The distinct points in insertion order, and what the others duplicate.
pub(crate) struct Distinct {
    /// The input index of each distinct point.
    pub(crate) order: Vec<u32>,
    /// The parts of `order`, each of which goes along the curve.
    pub(crate) rounds: Vec<Range<u32>>,
    /// One entry per point, as in [`Mesh3::duplicate_of`](crate::Mesh3::duplicate_of).
    pub(crate) duplicate_of: Vec<u32>,
}

/// Maps the coordinates of a cell, and how many of their bits count, to the cell's place along a
/// space-filling curve.
pub(crate) type Curve<const D: usize> = fn([u32; D], u32) -> u64;

/// Each round has an eighth of the points of the next one: 3 bits fewer.
const ROUND_BITS: u32 = 3;
/// No round but the first has fewer points than this. The first round is one sweep along the curve,
/// which takes quadratic time where fans grow, for example on two lines.
const MIN_ROUND: usize = 100;

/// Removes duplicates, and brings the points into insertion order, by `threads`.
pub(crate) fn insertion_order<const D: usize>(
    threads: Threads,
    points: Points<'_, D>,
    lattice: &Lattice<D>,
    curve: Curve<D>,
    order: Order,
) -> Distinct {
    let mut duplicate_of = bytemuck::zeroed_vec(points.len());
    parallel::for_chunks(threads, &mut duplicate_of, |_, chunk| chunk.fill(NONE));
    let (sorted, distinct) = along_curve(threads, points, lattice, curve, &mut duplicate_of);
    // Most inputs have no duplicates, and what they duplicate need not be looked up.
    let is_first = |i: u32| distinct == points.len() || duplicate_of[i as usize] == NONE;
    let (order, rounds) = match order {
        Order::Brio => rounds(threads, &sorted, distinct, is_first),
        Order::Shuffled(seed) => {
            let all = 0..distinct as u32;
            (shuffled(sorted.into_iter().map(|entry| entry as u32).filter(|&i| is_first(i)), seed), vec![all])
        }
    };
    Distinct { order, rounds, duplicate_of }
}

/// Returns the points, in the lower halves of the entries, in the order of the curve, or of their
/// coordinates if their lattice cells coincide; and how many are distinct.
fn along_curve<const D: usize>(
    threads: Threads,
    points: Points<'_, D>,
    lattice: &Lattice<D>,
    curve: Curve<D>,
    duplicate_of: &mut [u32],
) -> (Vec<u64>, usize) {
    let bits = lattice.width().bits();
    // The key takes this many bits of each coordinate, so that it fits beside an index in 64 bits.
    let key_bits = 32 / D as u32;
    // A point's place on the curve through the cells of the next `key_bits` bits after `done`,
    // above its index.
    let key = |i: u32, done: u32| {
        let left = bits - done;
        let cell = lattice
            .coordinates(points.get(i as usize))
            .map(|c| ((c.value as u64 & ((1 << left) - 1)) >> left.saturating_sub(key_bits)) as u32);
        curve(cell, key_bits.min(left)) << 32 | u64::from(i)
    };
    let mut keyed: Vec<u64> = bytemuck::zeroed_vec(points.len());
    parallel::for_chunks(threads, &mut keyed, |start, chunk| {
        chunk.iter_mut().zip(start as u32..).for_each(|(entry, i)| *entry = key(i, 0));
    });
    parallel::sort_keyed(threads, &mut keyed);
    let mut parts = parts(threads, &mut keyed);
    let duplicates = parallel::map_mut(threads, &mut parts, |_, part| sort_runs(points, part, bits, key_bits, key));
    for &[duplicate, first] in duplicates.iter().flatten() {
        duplicate_of[duplicate as usize] = first;
    }
    let distinct = keyed.len() - duplicates.iter().map(Vec::len).sum::<usize>();
    (keyed, distinct)
}

/// Splits sorted entries into parts for threads to share, none of which begins among entries of
/// equal keys.
fn parts(threads: Threads, keyed: &mut [u64]) -> Vec<&mut [u64]> {
    let size = match parallel::count(threads) {
        1 => keyed.len(),
        count => keyed.len().div_ceil(8 * count),
    };
    let mut parts = Vec::new();
    let mut rest = keyed;
    while rest.len() > size {
        let last = rest[size - 1] >> 32;
        let end = size + rest[size..].partition_point(|entry| entry >> 32 == last);
        let (part, others) = rest.split_at_mut(end);
        parts.push(part);
        rest = others;
    }
    parts.push(rest);
    parts
}

/// Sorts runs of entries with equal keys by the bits that the keys did not cover, `key_bits` of
/// `bits` at a time, then by their coordinates. Returns the duplicates, each with the first of its
/// point.
fn sort_runs<const D: usize>(
    points: Points<'_, D>,
    keyed: &mut [u64],
    bits: u32,
    key_bits: u32,
    key: impl Fn(u32, u32) -> u64,
) -> Vec<[u32; 2]> {
    // A run is its start, its end and the number of bits covered.
    let mut runs = Vec::new();
    let push_runs = |keyed: &[u64], start: usize, done: u32, runs: &mut Vec<_>| {
        let mut at = start;
        for run in keyed.chunk_by(|a, b| a >> 32 == b >> 32) {
            if run.len() > 1 {
                runs.push((at, at + run.len(), done));
            }
            at += run.len();
        }
    };
    push_runs(keyed, 0, key_bits, &mut runs);
    let mut duplicates = Vec::new();
    while let Some((start, end, done)) = runs.pop() {
        let run = &mut keyed[start..end];
        if done < bits {
            for entry in run.iter_mut() {
                *entry = key(*entry as u32, done);
            }
            parallel::sort_keyed(Threads::One, run);
            push_runs(run, start, done + key_bits.min(bits - done), &mut runs);
            continue;
        }
        sort_by_place(points, run);
        let point = |entry: u64| points.get(entry as u32 as usize);
        for equal in run.chunk_by(|&i, &j| point(i) == point(j)) {
            duplicates.extend(equal[1..].iter().map(|&duplicate| [duplicate as u32, equal[0] as u32]));
        }
    }
    duplicates
}

/// Sorts entries, each an index with a key in the upper 32 bits: by key, then by the point's
/// coordinates, then by index. Equal points become neighbours, the lowest index first.
pub(crate) fn sort_by_place<const D: usize>(points: Points<'_, D>, entries: &mut [u64]) {
    let point = |entry: u64| points.get(entry as u32 as usize);
    entries.sort_unstable_by(|&i, &j| {
        // −0 and 0 are the same coordinate.
        let by_place = point(i).partial_cmp(&point(j)).unwrap_or(Ordering::Equal);
        (i >> 32).cmp(&(j >> 32)).then(by_place).then(i.cmp(&j))
    });
}

/// Sorts out the points that share a lattice position with a representative, given as pairs
/// `merged`. Notes exact duplicates in `duplicate_of`, and returns the first point at each other
/// position, with its representative.
#[cfg(feature = "gpu")]
pub(crate) fn missing_points<const D: usize>(
    points: Points<'_, D>,
    merged: &[[u32; 2]],
    duplicate_of: &mut [u32],
) -> Vec<[u32; 2]> {
    let point = |i: u32| points.get(i as usize);
    let mut apart = Vec::new();
    for &[i, representative] in merged {
        if point(i) == point(representative) {
            duplicate_of[i as usize] = representative;
        } else {
            apart.push(u64::from(representative) << 32 | u64::from(i));
        }
    }
    sort_by_place(points, &mut apart);
    let mut missing: Vec<[u32; 2]> = Vec::new();
    for entry in apart {
        let (representative, i) = ((entry >> 32) as u32, entry as u32);
        match missing.last() {
            Some(&[first, _]) if point(first) == point(i) => duplicate_of[i as usize] = first,
            _ => missing.push([i, representative]),
        }
    }
    missing
}

/// Returns the points in a random order.
fn shuffled(order: impl Iterator<Item = u32>, seed: u64) -> Vec<u32> {
    let key = |i: u32| mix(u64::from(i) ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)) >> 32;
    let mut keyed: Vec<u64> = order.map(|i| key(i) << 32 | u64::from(i)).collect();
    parallel::sort_keyed(Threads::One, &mut keyed);
    keyed.into_iter().map(|entry| entry as u32).collect()
}

/// Splits the points of sorted entries that are in the set, `distinct` ones, into rounds at random,
/// and keeps the order within each; small rounds come first. Returns the parts, too.
fn rounds(
    threads: Threads,
    sorted: &[u64],
    distinct: usize,
    is_first: impl Fn(u32) -> bool + Sync,
) -> (Vec<u32>, Vec<Range<u32>>) {
    let mut last = 0;
    while distinct >> (ROUND_BITS * (last + 1)) >= MIN_ROUND {
        last += 1;
    }
    let count = last as usize + 1;
    let round = |i: u32| (last - last.min(mix(u64::from(i)).trailing_zeros() / ROUND_BITS)) as usize;
    // The points of each round, chunk by chunk.
    let parts = parallel::map_ranges(threads, sorted.len(), |range| {
        let mut part = vec![Vec::new(); count];
        sorted[range].iter().map(|&entry| entry as u32).filter(|&i| is_first(i)).for_each(|i| part[round(i)].push(i));
        part
    });
    let mut order: Vec<u32> = bytemuck::zeroed_vec(distinct);
    let mut copies = Vec::new();
    let mut starts = vec![0];
    let (mut rest, mut start) = (order.as_mut_slice(), 0);
    for r in 0..count {
        for part in &parts {
            let (to, others) = rest.split_at_mut(part[r].len());
            start += to.len() as u32;
            copies.push((to, &part[r]));
            rest = others;
        }
        starts.push(start);
    }
    parallel::map_mut(threads, &mut copies, |_, (to, from)| to.copy_from_slice(from));
    (order, starts.windows(2).map(|ends| ends[0]..ends[1]).collect())
}

/// Returns a hash, by the finaliser of SplitMix64, so that the same input gives the same order on
/// every machine.
pub(crate) fn mix(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}
