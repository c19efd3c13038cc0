//! What the dimensions supply to edits.

use crate::{
    cpu::{
        Incremental,
        edit::patch::{Patch, Row},
    },
    error::Error,
    options::Winding,
    predicates::filter::PredicateContext,
    slots::Slots,
};
use rustc_hash::FxHashSet;

/// What edits need of a dimension, with `N` vertices per simplex.
pub trait Edit<const D: usize, const N: usize>: Incremental<D, Triangulation: Slots<N>> {
    /// The hull of a mesh.
    type Hull;

    /// The maximum number of simplices.
    const MAX_SIMPLICES: usize;
    /// The time that it takes to remove one of many uniform points, by that of inserting one.
    const REMOVAL: f64;
    /// The share of uniform points that one thread inserts in the time of a run from scratch.
    const MAX_SHARE: f64;

    /// Returns the number of simplices of a mesh.
    fn count(mesh: &Self::Mesh) -> usize;

    /// Returns the vertices of simplex `t` of a mesh of this orientation, positively oriented, and
    /// its neighbours as [`Slots`] number them, [`NONE`](crate::index::NONE) outside the hull; `None` if it is not
    /// there, or its neighbours are not.
    fn row(mesh: &Self::Mesh, winding: Winding, t: u32) -> Option<Row<N>>;

    /// Returns the vertices of the simplex that facet `across` belongs to, as [`row`](Self::row) has
    /// them, if `facet` is across that facet.
    fn beyond(mesh: &Self::Mesh, winding: Winding, facet: u32, across: u32) -> Option<[u32; N]>;

    /// Returns the ghost on the facet opposite corner `k`, the infinite vertex last.
    fn ghost(simplex: [u32; N], k: usize, infinite: u32) -> [u32; N];

    /// Returns whether a simplex is positively oriented.
    fn is_positive(vertices: &PredicateContext<'_, D>, simplex: [u32; N]) -> bool;

    /// Returns whether the circumsphere of simplex `t` contains vertex `v`.
    fn in_conflict(triangulation: &Self::Triangulation, vertices: &PredicateContext<'_, D>, v: u32, t: u32) -> bool;

    /// Returns the hull of a mesh without the facets of the ghosts in `removed`, whose vertices are
    /// sorted, and with those of the ghosts in `added`; `None` if that is not closed.
    fn hull(
        mesh: &Self::Mesh,
        removed: &FxHashSet<[u32; N]>,
        added: Vec<[u32; N]>,
        infinite: u32,
        winding: Winding,
    ) -> Option<Self::Hull>;

    /// Changes a mesh, for whose simplices there is room.
    fn apply(mesh: &mut Self::Mesh, patch: Patch<N, Self::Hull>, winding: Winding);

    /// Makes room for `simplices` simplices.
    ///
    /// # Errors
    ///
    /// Returns [`Error::OutOfMemory`].
    fn reserve(mesh: &mut Self::Mesh, simplices: usize) -> Result<(), Error>;
}
