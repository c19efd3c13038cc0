//! What the dimensions supply to tiles.

use crate::{cpu::Incremental, options::Winding, slots::Slots};
use std::fmt::Debug;

/// What tiles need of a dimension, with `N` vertices per simplex.
pub trait Tiled<const D: usize, const N: usize>: Incremental<D, Triangulation: Slots<N> + Debug + Send> {
    /// By how much the entries of `neighbors` grow with each simplex before theirs.
    const STRIDE: u32;

    /// Returns the number of slots.
    fn slots(triangulation: &Self::Triangulation) -> u32;

    /// Returns the vertices of the simplex in slot `t`, if it is used.
    fn simplex(triangulation: &Self::Triangulation, t: u32) -> Option<[u32; N]>;

    /// Returns the facet of the hull that a ghost is on, as [`assemble`](Self::assemble) takes it; `None` if the simplex
    /// is none.
    fn ghost_facet(simplex: [u32; N], infinite: u32) -> Option<[u32; D]>;

    /// Returns the vertices and the neighbours of all slots, whatever unused ones have.
    fn into_arrays(triangulation: Self::Triangulation) -> [Vec<[u32; N]>; 2];

    /// Makes vertex *v* `names[v]`, where there are names; the infinite vertex becomes `infinite`.
    fn rename(triangulation: &mut Self::Triangulation, names: &[u32], infinite: u32);

    /// Gives the infinite vertex another number.
    fn move_infinite(triangulation: &mut Self::Triangulation, infinite: u32);

    /// Returns the vertices of a simplex as a mesh has them.
    fn to_mesh(simplex: [u32; N], winding: Winding) -> [u32; N];

    /// Returns the entries of `neighbors` of a simplex, given what is across its facets, 4·(simplex) + (facet as it is
    /// numbered there) or [`NONE`](crate::index::NONE).
    fn entries(across: [u32; N], winding: Winding) -> [u32; N];

    /// Returns the place of facet `k` of simplex `t` among the entries of `neighbors`, and the entry that stands for
    /// this facet elsewhere.
    fn place(t: u32, k: usize, winding: Winding) -> [u32; 2];

    /// Returns the mesh with these arrays; `hull` has the facets of the ghosts, in any order.
    fn assemble(
        simplices: Vec<[u32; N]>,
        neighbors: Vec<[u32; N]>,
        hull: Vec<[u32; D]>,
        winding: Winding,
    ) -> Self::Mesh;
}
