//! A mesh while vertices are removed and inserted.

use crate::{
    cpu::{
        Incremental, Insert,
        edit::{
            dim::Edit,
            removal::{Small, Star, facet_of},
            sparse::Sparse,
        },
    },
    dimension::Dimension,
    error::Error,
    input::{lattice::Lattice, order::mix, points::Points},
    mesh::MeshInfo,
    options::Options,
    predicates::filter::PredicateContext,
    slots::Slots,
    stats::{Phase, Restart, UpdateStats},
};
use rustc_hash::FxHashMap;

/// The number of points between two reports of progress.
const REPORT: usize = 1 << 6;

/// A mesh that is edited.
pub(super) struct Editing<'m, 'p, const D: usize, const N: usize>
where
    Dimension<D>: Edit<D, N>,
{
    pub(super) sparse: Sparse<'m, 'p, D, N>,
    pub(super) points: Points<'p, D>,
    pub(super) lattice: &'m Lattice<D>,
    pub(super) context: &'m PredicateContext<'p, D>,
    pub(super) options: &'m Options,
    /// A simplex where the next walk starts.
    pub(super) last: u32,
    /// The number of vertices that may still be around those that are removed.
    pub(super) max_around: f64,
    /// The field of the mesh.
    pub(super) duplicate_of: Vec<u32>,
    /// Receives what was done.
    pub(super) update: UpdateStats,
}

impl<const D: usize, const N: usize> Editing<'_, '_, D, N>
where
    Dimension<D>: Edit<D, N>,
    for<'m, 'p> Sparse<'m, 'p, D, N>: Insert<D>,
{
    /// Removes vertices, then inserts others, or notes what they duplicate. Returns why that is left
    /// to a run from scratch, if it is.
    pub(super) fn run(&mut self, removed: &[u32], inserted: &[u32]) -> Result<Result<(), Restart>, Error> {
        let all = (removed.len() + inserted.len()) as f64;
        let options = self.options;
        let report = |done: usize| match done % REPORT {
            0 => options.report(Phase::Insert, done as f64 / all),
            _ => Ok(()),
        };
        for (i, &v) in removed.iter().enumerate() {
            report(i)?;
            if let Err(why) = self.remove(v)? {
                return Ok(Err(why));
            }
        }
        self.update.removed = removed.len();
        let mut scratch = self.sparse.scratch();
        let mut aliases = FxHashMap::default();
        for (i, &p) in inserted.iter().enumerate() {
            report(removed.len() + i)?;
            let at = self.sparse.locate(self.context, p, self.last);
            let is_there =
                |&v: &u32| (v as usize) < self.points.len() && self.context.point(v) == self.context.point(p);
            if let Some(v) = self.sparse.corners(at).into_iter().find(is_there) {
                if v >= p {
                    return Ok(Err(Restart::Broken));
                }
                self.duplicate_of[p as usize] = v;
                aliases.insert(p, v);
                continue;
            }
            match self.sparse.insert(self.context, p, at, &mut scratch)? {
                Some(t) if self.sparse.is_sound() => self.last = t,
                _ => return Ok(Err(Restart::Broken)),
            }
            self.update.inserted += 1;
        }
        self.sparse.finish(scratch);
        if !aliases.is_empty() {
            // Other new points may be duplicates of those that turned out to be duplicates.
            let known = self.sparse.mesh().duplicate_of().len();
            for first in &mut self.duplicate_of[known..] {
                *first = aliases.get(first).copied().unwrap_or(*first);
            }
        }
        Ok(Ok(()))
    }

    /// Removes vertex `v`, or says why that does not work.
    fn remove(&mut self, v: u32) -> Result<Result<(), Restart>, Error> {
        let at = self.sparse.locate(self.context, v, self.last);
        let Some(Star { simplices, facets, around, beyond }) = Star::new(&self.sparse, at, v) else {
            return Ok(Err(Restart::Broken));
        };
        self.max_around -= around.len() as f64;
        if self.max_around < 0.0 {
            return Ok(Err(Restart::Points));
        }
        let mut order = around;
        // In no order that a caller could choose.
        order.sort_unstable_by_key(|&v| mix(v.into()));
        if usize::from(Dimension::<D>::spanning_first(self.points, &mut order)) < D {
            order.extend(beyond);
            order.sort_unstable();
            order.dedup();
            if usize::from(Dimension::<D>::spanning_first(self.points, &mut order)) < D {
                return Ok(Err(Restart::Degenerate));
            }
        }
        order.push(v);
        let Some(small) = Small::new::<N>(self.points, self.lattice, order)? else {
            return Ok(Err(Restart::Broken));
        };
        let Some(cavity) = small.cavity::<N>() else { return Ok(Err(Restart::Broken)) };

        let infinite = self.sparse.infinite();
        let name = |v: u32| small.names.get(v as usize).copied().unwrap_or(infinite);
        let mut slots = simplices;
        let unused = slots.split_off(cavity.len().min(slots.len()));
        unused.into_iter().for_each(|t| self.sparse.discard(t));
        while slots.len() < cavity.len() {
            slots.push(self.sparse.push()?);
        }
        let places: FxHashMap<u32, u32> = cavity.iter().copied().zip(slots.iter().copied()).collect();
        let mut sewn = 0;
        for (&t, &slot) in cavity.iter().zip(&slots) {
            let simplex = small.triangulation.simplex(t).map(name);
            let mut neighbors = small.triangulation.neighbors(t);
            for (k, neighbor) in neighbors.iter_mut().enumerate() {
                if let Some(slot) = places.get(&(*neighbor >> 2)) {
                    *neighbor = 4 * slot + (*neighbor & 3);
                    continue;
                }
                let Some(&across) = facets.get(&facet_of(simplex, k)) else { return Ok(Err(Restart::Broken)) };
                self.sparse.set_neighbor(across, 4 * slot + k as u32);
                *neighbor = across;
                sewn += 1;
            }
            self.sparse.set_simplex(slot, simplex);
            self.sparse.set_neighbors(slot, neighbors);
        }
        self.context.add_counts(small.context.exact_counts());
        self.last = slots[0];
        Ok(if sewn == facets.len() && self.sparse.is_sound() { Ok(()) } else { Err(Restart::Broken) })
    }
}
