//! Faces in the order of their radii, those with exactly the same radius together.

use super::{
    super::{complex::Complex, sets::DisjointSets},
    values::certain,
};
use crate::{
    index::NONE,
    parallel::{self, Threads},
};
use std::cmp::Ordering;

/// Faces, by number, in the order of their radii.
#[derive(Debug)]
pub(super) struct Groups {
    faces: Vec<u32>,
    /// Where each group of faces with the same radius starts in `faces`, and where the last one
    /// ends.
    starts: Vec<usize>,
}

/// So few faces are compared exactly at once.
const FEW: usize = 8;

/// A bound of the relative error of the difference of two precise squared radii, generously: 2⁻⁹⁴.
const PRECISE_MARGIN: f64 = 1.0 / (1u128 << 94) as f64;

impl Groups {
    /// Sorts faces by their rounded squared radii, by `precise` ones (see [`precise_squared_radius`])
    /// where these are too close to tell, and by comparing them exactly where those are, too, or the
    /// rounded ones are NaN.
    ///
    /// Points on a sphere have simplices with almost the same radii. To compare two of them exactly
    /// takes about as long as to compute one of them precisely.
    ///
    /// [`precise_squared_radius`]: crate::geometry::precise_squared_radius
    pub(super) fn new(
        count: usize,
        squared: impl Fn(u32) -> f64,
        precise: impl Fn(u32) -> [f64; 2] + Sync,
        compare: impl Fn(u32, u32) -> Ordering,
    ) -> Self {
        // Positive numbers are in the order of their bits, and NaN comes last.
        let mut keyed: Vec<(u64, u32)> = (0..count as u32).map(|i| (squared(i).to_bits(), i)).collect();
        parallel::sort(Threads::All, &mut keyed);
        let mut groups = Groups { faces: Vec::with_capacity(count), starts: vec![0] };
        let unknown = keyed.partition_point(|&(bits, _)| !f64::from_bits(bits).is_nan());
        // What is not known may be anywhere between the others.
        let is_same_run = |&(a, _): &(u64, u32), &(b, _): &(u64, u32)| {
            unknown < count || certain(f64::from_bits(a), f64::from_bits(b)).is_none()
        };
        for run in keyed.chunk_by(is_same_run) {
            if unknown < count || run.len() < FEW {
                groups.push_compared(run.iter().map(|&(_, face)| face), &compare);
                continue;
            }
            let mut run: Vec<([f64; 2], u32)> = run.iter().map(|&(_, face)| ([0.0; 2], face)).collect();
            parallel::for_chunks(Threads::All, &mut run, |_, run| {
                run.iter_mut().for_each(|(squared, face)| *squared = precise(*face));
            });
            parallel::sort_by(Threads::All, &mut run, |(a, i), (b, j)| {
                a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(i.cmp(j))
            });
            let is_same_run = |(a, _): &([f64; 2], u32), (b, _): &([f64; 2], u32)| {
                (b[0] - a[0]) + (b[1] - a[1]) <= PRECISE_MARGIN * b[0]
            };
            for run in run.chunk_by(is_same_run) {
                groups.push_compared(run.iter().map(|&(_, face)| face), &compare);
            }
        }
        groups
    }

    /// Adds faces of which only exact comparisons tell the order.
    fn push_compared(&mut self, faces: impl Iterator<Item = u32>, compare: &impl Fn(u32, u32) -> Ordering) {
        // In a grid, most are equal to one of few.
        let mut equal: Vec<Vec<u32>> = Vec::new();
        for face in faces {
            match equal.binary_search_by(|group| compare(group[0], face)) {
                Ok(place) => equal[place].push(face),
                Err(place) => equal.insert(place, vec![face]),
            }
        }
        equal.into_iter().for_each(|group| self.push(group));
    }

    fn push(&mut self, group: impl IntoIterator<Item = u32>) {
        self.faces.extend(group);
        self.starts.push(self.faces.len());
    }

    /// Returns one face of each group.
    pub(super) fn firsts(&self) -> impl Iterator<Item = u32> {
        self.starts[..self.starts.len() - 1].iter().map(|&start| self.faces[start])
    }

    /// Returns a simplex of the first group with which, and those before, all vertices have a
    /// simplex, and the simplices have at most so many components.
    pub(super) fn first_with<const D: usize, const N: usize>(
        &self,
        components: usize,
        complex: &Complex<'_, D, N>,
    ) -> Option<usize> {
        let mut sets = DisjointSets::new(complex.simplices.len());
        let mut is_present = vec![false; complex.simplices.len()];
        // Duplicates, which are vertices of nothing unless the mesh is broken, need not be covered.
        let mut is_covered: Vec<bool> = complex.duplicate_of.iter().map(|&d| d != NONE).collect();
        let mut uncovered = is_covered.iter().filter(|&&is_covered| !is_covered).count();
        let mut count = 0;
        for ends in self.starts.windows(2) {
            let group = &self.faces[ends[0]..ends[1]];
            for &t in group {
                is_present[t as usize] = true;
                count += 1;
                for k in 0..N {
                    if let Some(across) = complex.across(t as usize, k)
                        && is_present[across]
                        && sets.unite(t, across as u32)
                    {
                        count -= 1;
                    }
                }
                for &v in &complex.simplices[t as usize] {
                    uncovered -= usize::from(!std::mem::replace(&mut is_covered[v as usize], true));
                }
            }
            if uncovered == 0 && count <= components {
                return Some(group[0] as usize);
            }
        }
        None
    }
}
