//! What takes the place of a vertex that is removed.
//!
//! The simplices that replace its star are those of the Delaunay triangulation of the vertices around
//! it that are in conflict with it: nothing else lies in their circumspheres, and inserting the vertex
//! would make a cavity of them. Ties are broken by input index in both triangulations, and ghosts are
//! simplices like others, so neither degenerate points nor the hull are special. Only where all
//! vertices around it lie in one plane, or on one line in 2D, those just beyond are taken as well.

use crate::{
    cpu::{
        Grow, Incremental, Insert,
        edit::{dim::Edit, sparse::Sparse},
    },
    dimension::Dimension,
    error::Error,
    index::NONE,
    input::{lattice::Lattice, points::Points},
    predicates::filter::PredicateContext,
    slots::Slots,
};
use rustc_hash::{FxHashMap, FxHashSet};

/// What is around a vertex.
pub(super) struct Star<const N: usize> {
    /// The simplices.
    pub(super) simplices: Vec<u32>,
    /// What is across each facet opposite the vertex, by [`facet_of`].
    pub(super) facets: FxHashMap<[u32; N], u32>,
    /// The vertices of these facets.
    pub(super) around: Vec<u32>,
    /// The vertices opposite these facets on the other side.
    pub(super) beyond: Vec<u32>,
}

impl<const N: usize> Star<N> {
    /// Returns what is around vertex `v`, which simplex `at` has; `None` if it does not, or the star is
    /// none.
    pub(super) fn new<const D: usize>(sparse: &Sparse<'_, '_, D, N>, at: u32, v: u32) -> Option<Self>
    where
        Dimension<D>: Edit<D, N>,
    {
        let infinite = sparse.infinite();
        let mut star =
            Star { simplices: vec![at], facets: FxHashMap::default(), around: Vec::new(), beyond: Vec::new() };
        let mut seen: FxHashSet<u32> = [at].into_iter().collect();
        let mut next = 0;
        while let Some(&t) = star.simplices.get(next) {
            next += 1;
            let simplex = sparse.simplex(t);
            let neighbors = sparse.neighbors(t);
            let place = simplex.iter().position(|&w| w == v)?;
            for (k, &across) in neighbors.iter().enumerate() {
                if k != place && seen.insert(across >> 2) {
                    star.simplices.push(across >> 2);
                }
            }
            let across = neighbors[place];
            let beyond = *sparse.corners(across >> 2).get(across as usize & 3)?;
            if star.facets.insert(facet_of(simplex, place), across).is_some() || beyond == v {
                return None;
            }
            star.around.extend(simplex.into_iter().filter(|&w| w != v && w != infinite));
            star.beyond.extend(Some(beyond).filter(|&w| w != infinite));
        }
        star.around.sort_unstable();
        star.around.dedup();
        Some(star)
    }
}

/// Returns what is the same for both simplices of the facet opposite corner `k`: its vertices,
/// sorted, and [`NONE`].
pub(super) fn facet_of<const N: usize>(mut simplex: [u32; N], k: usize) -> [u32; N] {
    simplex[k] = NONE;
    simplex.sort_unstable();
    simplex
}

/// A triangulation of the vertices around one that is to be removed.
pub(super) struct Small<'p, const D: usize>
where
    Dimension<D>: Incremental<D>,
{
    pub(super) triangulation: <Dimension<D> as Incremental<D>>::Triangulation,
    pub(super) context: PredicateContext<'p, D>,
    /// The input indices of the vertices, of which the last one is not inserted.
    pub(super) names: Vec<u32>,
    /// A simplex.
    last: u32,
}

impl<'p, const D: usize> Small<'p, D>
where
    Dimension<D>: Incremental<D>,
{
    /// Triangulates these vertices except for the last one. The first `D + 1` are positively
    /// oriented. Returns `None` if two of them are equal.
    pub(super) fn new<const N: usize>(
        points: Points<'p, D>,
        lattice: &Lattice<D>,
        names: Vec<u32>,
    ) -> Result<Option<Self>, Error>
    where
        Dimension<D>: Edit<D, N>,
    {
        let context = PredicateContext::new(points, lattice, names.clone());
        let mut triangulation = <Dimension<D> as Incremental<D>>::Triangulation::initial(names.len() as u32);
        let mut scratch = triangulation.scratch();
        let mut last = 0;
        for p in D as u32 + 1..names.len() as u32 - 1 {
            let start = triangulation.locate(&context, p, last);
            let is_there = |&v: &u32| v < p && context.point(v) == context.point(p);
            if triangulation.simplex(start).iter().any(is_there) {
                return Ok(None);
            }
            last = triangulation.insert(&context, p, start, &mut scratch)?.expect("nobody disturbs the only thread");
        }
        triangulation.finish(scratch);
        Ok(Some(Small { triangulation, context, names, last }))
    }

    /// Returns the simplices in conflict with the last vertex; `None` if there are none.
    pub(super) fn cavity<const N: usize>(&self) -> Option<Vec<u32>>
    where
        Dimension<D>: Edit<D, N>,
    {
        let v = self.names.len() as u32 - 1;
        let is_in_conflict = |t: u32| Dimension::<D>::in_conflict(&self.triangulation, &self.context, v, t);
        let start = self.triangulation.locate(&self.context, v, self.last);
        if !is_in_conflict(start) {
            return None;
        }
        let mut cavity = vec![start];
        let mut seen: FxHashSet<u32> = [start].into_iter().collect();
        let mut next = 0;
        while let Some(&t) = cavity.get(next) {
            next += 1;
            for across in Slots::<N>::neighbors(&self.triangulation, t) {
                let u = across >> 2;
                if seen.insert(u) && is_in_conflict(u) {
                    cavity.push(u);
                }
            }
        }
        Some(cavity)
    }
}
