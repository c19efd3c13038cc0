//! What the dimensions supply to tiles.

use crate::{
    cpu::Incremental,
    error::Error,
    options::Winding,
    parallel::Threads,
    predicates::Sign,
    slots::Slots,
    triangulator::Triangulator,
    verify::{Check, input::Input, report::Findings},
};
use std::fmt::Debug;

/// What tiles need of a dimension, with `N` vertices per simplex.
pub trait Tiled<const D: usize, const N: usize>: Incremental<D, Triangulation: Slots<N> + Debug + Send + Sync> {
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
    fn rename(threads: Threads, triangulation: &mut Self::Triangulation, names: &[u32], infinite: u32);

    /// Gives the infinite vertex another number.
    fn move_infinite(triangulation: &mut Self::Triangulation, infinite: u32);

    /// Returns the mesh that a triangulator makes of points.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Triangulator::delaunay3d`].
    fn delaunay(triangulator: &Triangulator, points: &[[f64; D]]) -> Result<Self::Mesh, Error>;

    /// Returns the triangulation of a mesh that [`delaunay`](Self::delaunay) has made, with ghosts; `infinite` is the
    /// number of its points.
    fn of_mesh(threads: Threads, mesh: Self::Mesh, infinite: u32) -> Self::Triangulation;

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

/// What the [`Proof`](super::Proof) of tiles needs of a dimension. Vertices of simplices are as in a mesh.
pub trait Provable<const D: usize, const N: usize>: Tiled<D, N> {
    /// Returns the affine dimension of points.
    fn dimension_of(points: &[[f64; D]]) -> u8;

    /// Returns the place of the facet opposite vertex `k` of simplex `t` among the entries of `neighbors`, and the entry
    /// that stands for this facet elsewhere.
    fn side(t: u32, k: usize) -> [u32; 2];

    /// Returns the orientation of a simplex.
    fn orientation(corners: [[f64; D]; N]) -> Sign;

    /// Returns where a point with an index is: the sign of the in-sphere determinant, or of the in-circle determinant, and if
    /// that vanishes the sign of the tie.
    fn in_sphere(corners: [[f64; D]; N], indices: [u32; N], q: [f64; D], index: u32) -> [Sign; 2];

    /// Checks all that can be said of the simplices of a piece alone, and what it states of neighbours in it. Returns the
    /// facets with one simplex: the simplex, and the vertex opposite the facet.
    fn check_simplices(
        input: &Input<D>,
        simplices: &[[u32; N]],
        neighbors: Option<&[[u32; N]]>,
        found: &mut dyn FnMut(Check, Findings),
    ) -> Vec<[u32; 2]>;

    /// Checks that none of these simplices contains a point inside another one, which has these corners.
    fn check_overlaps(inside: [[f64; D]; N], points: &[[f64; D]], simplices: &[[u32; N]]) -> Findings;

    /// Checks the hull, whose facets are opposite these vertices of simplices. A simplex has the corners `inside`.
    fn check_hull(
        inside: [[f64; D]; N],
        points: &[[f64; D]],
        simplices: &[[u32; N]],
        opposite: &[usize],
    ) -> Vec<(Check, Findings)>;
}
