//! A mesh whose simplices are in an order of their own.

use crate::{
    index::NONE,
    mesh::{Mesh, sealed::Sealed},
    parallel::{self, Threads},
};
use std::borrow::Cow;

/// A copy of a mesh in which the order of simplices, and of the vertices of each, is a function of the mesh: threads
/// make another order in every run, and sums of what the simplices contribute would be rounded differently.
#[derive(Debug)]
pub(super) struct InOrder<'a, const N: usize> {
    simplices: Vec<[u32; N]>,
    neighbors: Vec<[u32; N]>,
    duplicate_of: &'a [u32],
    weights: &'a [f64],
}

impl<'a, const N: usize> InOrder<'a, N> {
    pub(super) fn new<const D: usize>(mesh: &'a impl Mesh<D, N>) -> Self {
        let (simplices, opposites) = (mesh.simplices(), mesh.opposites());
        let mut entries = vec![([0; N], 0); simplices.len()];
        parallel::for_chunks(Threads::All, &mut entries, |start, chunk| {
            for ((t, entry), simplex) in (start..).zip(chunk).zip(&simplices[start..]) {
                *entry = (places(simplex).map(|k| simplex[k]), t as u32);
            }
        });
        parallel::sort(Threads::All, &mut entries);
        let mut names = vec![NONE; simplices.len()];
        (0..).zip(&entries).for_each(|(name, &(_, t))| names[t as usize] = name);
        let mut neighbors = vec![[NONE; N]; simplices.len()];
        parallel::for_chunks(Threads::All, &mut neighbors, |start, chunk| {
            for (row, &(_, t)) in chunk.iter_mut().zip(&entries[start..]) {
                let across = &opposites[t as usize];
                let name = |k: usize| names.get(across[k] as usize).copied().unwrap_or(NONE);
                *row = places(&simplices[t as usize]).map(name);
            }
        });
        let simplices = entries.into_iter().map(|(simplex, _)| simplex).collect();
        InOrder { simplices, neighbors, duplicate_of: mesh.duplicate_of(), weights: mesh.weights() }
    }
}

/// Returns the even permutation of a simplex after which its vertices ascend, but for the last two if they must not.
fn places<const N: usize>(simplex: &[u32; N]) -> [usize; N] {
    let mut places = std::array::from_fn(|k| k);
    let mut is_odd = false;
    for end in (1..N).rev() {
        for k in 0..end {
            if simplex[places[k]] > simplex[places[k + 1]] {
                places.swap(k, k + 1);
                is_odd = !is_odd;
            }
        }
    }
    if is_odd {
        places.swap(N - 2, N - 1);
    }
    places
}

impl<const N: usize> Sealed for InOrder<'_, N> {}

impl<const D: usize, const N: usize> Mesh<D, N> for InOrder<'_, N> {
    fn simplices(&self) -> &[[u32; N]] {
        &self.simplices
    }

    fn opposites(&self) -> Cow<'_, [[u32; N]]> {
        Cow::Borrowed(&self.neighbors)
    }

    fn duplicate_of(&self) -> &[u32] {
        self.duplicate_of
    }

    fn weights(&self) -> &[f64] {
        self.weights
    }

    fn constraints(&self) -> &[[u32; 2]] {
        &[]
    }
}
