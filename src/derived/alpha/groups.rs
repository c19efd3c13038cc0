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

impl Groups {
    /// Sorts faces by their rounded squared radii, and exactly where these are too close to tell,
    /// or NaN.
    pub(super) fn new(count: usize, squared: impl Fn(u32) -> f64, compare: impl Fn(u32, u32) -> Ordering) -> Self {
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
            if let &[(_, face)] = run {
                groups.push([face]);
                continue;
            }
            // In a grid, most are equal to one of few.
            let mut equal: Vec<Vec<u32>> = Vec::new();
            for &(_, face) in run {
                match equal.binary_search_by(|group| compare(group[0], face)) {
                    Ok(place) => equal[place].push(face),
                    Err(place) => equal.insert(place, vec![face]),
                }
            }
            equal.into_iter().for_each(|group| groups.push(group));
        }
        groups
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
        let mut is_covered = vec![false; complex.points().len()];
        let mut uncovered = complex.duplicate_of.iter().filter(|&&d| d == NONE).count();
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
