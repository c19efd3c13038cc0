//! A mesh with its points.

use crate::{
    error::Error,
    index::NONE,
    input::points::Points,
    mesh::{Mesh, hidden},
    parallel::{self, Threads},
};
use std::borrow::Cow;

/// A mesh and its points, checked as far as indices need it: no index leads out of an array. That
/// the mesh is the Delaunay triangulation of the points is not checked; what walks over the mesh
/// limits its steps.
#[derive(Debug, Clone)]
pub struct Complex<'a, const D: usize, const N: usize> {
    pub(crate) points: Coordinates<'a, D>,
    pub(crate) simplices: Cow<'a, [[u32; N]]>,
    /// Entry *k* is opposite vertex *k*, in 2D too.
    pub(crate) neighbors: Cow<'a, [[u32; N]]>,
    /// For hidden points, these themselves, as for those that were removed.
    pub(crate) duplicate_of: Cow<'a, [u32]>,
    /// The weights of the points; none if the mesh is the Delaunay triangulation.
    pub(crate) weights: Cow<'a, [f64]>,
    /// The neighbours as in `neighbors`, with [`NONE`] across constrained edges; `None` without constraints.
    pub(super) visible: Option<Vec<[u32; N]>>,
}

/// The coordinates of a mesh's points.
#[derive(Debug, Clone)]
pub(crate) enum Coordinates<'a, const D: usize> {
    Borrowed(Points<'a, D>),
    Owned(Vec<[f64; D]>),
}

impl<'a, const D: usize, const N: usize> Complex<'a, D, N> {
    /// Checks and borrows a mesh and its points, for what exists for Delaunay triangulations only.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`unweighted`](Self::unweighted), and [`Error::ConstrainedMesh`].
    pub(crate) fn delaunay(mesh: &'a impl Mesh<D, N>, points: Points<'a, D>) -> Result<Self, Error> {
        let complex = Complex::unweighted(mesh, points)?;
        complex.check_unconstrained()?;
        Ok(complex)
    }

    /// Checks and borrows a mesh and its points, for what exists for those without weights only.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new), and [`Error::WeightedMesh`].
    pub(crate) fn unweighted(mesh: &'a impl Mesh<D, N>, points: Points<'a, D>) -> Result<Self, Error> {
        let complex = Complex::new(mesh, points)?;
        if complex.weights.is_empty() { Ok(complex) } else { Err(Error::WeightedMesh) }
    }

    /// Checks that the mesh has no constraints.
    ///
    /// # Errors
    ///
    /// [`Error::ConstrainedMesh`].
    pub(crate) fn check_unconstrained(&self) -> Result<(), Error> {
        if self.is_constrained() { Err(Error::ConstrainedMesh) } else { Ok(()) }
    }

    /// Checks and borrows a mesh and its points.
    ///
    /// # Errors
    ///
    /// [`Error::PointCount`], [`Error::NotFinite`], [`Error::BrokenMesh`], or [`Error::BadWeight`].
    pub(crate) fn new(mesh: &'a impl Mesh<D, N>, points: Points<'a, D>) -> Result<Self, Error> {
        let (simplices, neighbors, duplicate_of) = (mesh.simplices(), mesh.opposites(), mesh.duplicate_of());
        if points.len() != duplicate_of.len() {
            return Err(Error::PointCount { points: points.len(), expected: duplicate_of.len() });
        }
        let weights = mesh.weights();
        if let Some(index) = weights.iter().position(|w| !w.is_finite()) {
            return Err(Error::BadWeight { index });
        }
        points.validate_by(Threads::All)?;
        let broken = |reason| Err(Error::BrokenMesh { reason });
        if !weights.is_empty() && weights.len() != points.len() {
            return broken("there is not one weight per point");
        }
        if neighbors.len() != simplices.len() || simplices.len() > i32::MAX as usize {
            return broken("there are not as many neighbours as simplices");
        }
        let is_index = |entry: u32, count: usize| entry == NONE || (entry as usize) < count;
        let are_valid = parallel::map_ranges(Threads::All, simplices.len(), |range| {
            let vertices = simplices[range.clone()].as_flattened().iter();
            let neighbors = neighbors[range].as_flattened().iter();
            vertices.fold(true, |valid, &v| valid & ((v as usize) < points.len()))
                & neighbors.fold(true, |valid, &t| valid & is_index(t, simplices.len()))
        });
        if !are_valid.into_iter().all(|valid| valid) {
            return broken("a vertex or neighbour does not exist");
        }
        if !duplicate_of.iter().all(|&i| is_index(i, points.len())) {
            return broken("a duplicate is that of a point that does not exist");
        }
        let points = Coordinates::Borrowed(points);
        let constraints = mesh.constraints();
        let visible = (!constraints.is_empty()).then(|| visible(simplices, &neighbors, constraints));
        let (simplices, duplicate_of) = (Cow::Borrowed(simplices), Cow::Borrowed(duplicate_of));
        let weights = Cow::Borrowed(weights);
        let mut complex = Complex { points, simplices, neighbors, duplicate_of, weights, visible };
        if !complex.weights.is_empty() && !complex.simplices.is_empty() {
            complex.hide(hidden(&complex.simplices, &complex.duplicate_of));
        }
        Ok(complex)
    }

    /// Takes points for hidden ones.
    pub(crate) fn hide(&mut self, points: Vec<u32>) {
        for i in points {
            self.duplicate_of.to_mut()[i as usize] = i;
        }
    }

    /// Returns the weight of vertex `v`, 0 without weights.
    #[inline(always)]
    pub(crate) fn weight(&self, v: u32) -> f64 {
        self.weights.get(v as usize).copied().unwrap_or(0.0)
    }

    /// Returns the points.
    #[inline(always)]
    pub(crate) fn points(&self) -> Points<'_, D> {
        match &self.points {
            Coordinates::Borrowed(points) => *points,
            Coordinates::Owned(points) => Points::F64(points),
        }
    }

    /// Returns the minimum and the maximum of each axis; infinities if there are no points.
    pub(crate) fn bounds(&self) -> [[f64; D]; 2] {
        self.points().bounds().unwrap_or([[f64::INFINITY; D], [f64::NEG_INFINITY; D]])
    }

    /// Returns the coordinates of vertex `v`.
    #[inline(always)]
    pub(crate) fn point(&self, v: u32) -> [f64; D] {
        self.points().get(v as usize)
    }

    /// Returns the vertices of simplex `t` and its neighbours.
    #[inline(always)]
    pub(crate) fn row(&self, t: usize) -> ([u32; N], [u32; N]) {
        (self.simplices[t], self.neighbors[t])
    }

    /// Returns the coordinates of the vertices of simplex `t`.
    #[inline(always)]
    pub(crate) fn corners(&self, t: usize) -> [[f64; D]; N] {
        self.corners_of(&self.simplices[t])
    }

    /// Returns the coordinates of vertices.
    #[inline(always)]
    pub(crate) fn corners_of(&self, simplex: &[u32; N]) -> [[f64; D]; N] {
        let mut corners = [[0.0; D]; N];
        // The kind of coordinates is looked at once.
        match self.points() {
            Points::F64(points) => {
                for (corner, &v) in corners.iter_mut().zip(simplex) {
                    *corner = points[v as usize];
                }
            }
            Points::F32(points) => {
                for (corner, &v) in corners.iter_mut().zip(simplex) {
                    *corner = points[v as usize].map(f64::from);
                }
            }
        }
        corners
    }

    /// Returns the simplex opposite vertex `k` of simplex `t`; `None` outside the hull.
    #[inline(always)]
    pub(crate) fn across(&self, t: usize, k: usize) -> Option<usize> {
        let neighbor = self.neighbors[t][k];
        (neighbor != NONE).then_some(neighbor as usize)
    }

    /// Returns the simplex opposite vertex `k` of simplex `t`; `None` outside the hull, and across a constrained edge.
    #[inline(always)]
    pub(crate) fn visible_across(&self, t: usize, k: usize) -> Option<usize> {
        let neighbor = self.visible.as_deref().unwrap_or(&self.neighbors)[t][k];
        (neighbor != NONE).then_some(neighbor as usize)
    }

    /// Returns whether the mesh has constraints.
    #[inline(always)]
    pub(crate) fn is_constrained(&self) -> bool {
        self.visible.is_some()
    }

    /// Returns the index of the facet that simplices `t` and `u` share, as numbered in `u`; `N` if
    /// there is none.
    #[inline(always)]
    pub(crate) fn facet_towards(&self, u: usize, t: usize) -> usize {
        let mut facet = N;
        for (k, &neighbor) in self.neighbors[u].iter().enumerate() {
            if neighbor == t as u32 {
                facet = k;
            }
        }
        facet
    }

    /// Returns the points that are neither duplicates of others nor hidden.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(&*self.duplicate_of).filter(|&(_, &of)| of == NONE).map(|(i, _)| i)
    }

    /// Returns the vertex that stands for point `i`.
    pub(crate) fn representative(&self, i: u32) -> u32 {
        match self.duplicate_of[i as usize] {
            NONE => i,
            vertex => vertex,
        }
    }
}

/// Returns the neighbours of triangles with [`NONE`] across constrained edges, which are in ascending order.
fn visible<const N: usize>(simplices: &[[u32; N]], neighbors: &[[u32; N]], constraints: &[[u32; 2]]) -> Vec<[u32; N]> {
    let rows = parallel::map_ranges(Threads::All, simplices.len(), |range| {
        let rows = simplices[range.clone()].iter().zip(&neighbors[range]);
        let visible = |(simplex, neighbors): (&[u32; N], &[u32; N])| {
            std::array::from_fn(|k| {
                let [a, b] = [1, 2].map(|i| simplex[(k + i) % N]);
                let is_constrained = constraints.binary_search(&[a.min(b), a.max(b)]).is_ok();
                if is_constrained { NONE } else { neighbors[k] }
            })
        };
        rows.map(visible).collect::<Vec<_>>()
    });
    parallel::joined(rows)
}
