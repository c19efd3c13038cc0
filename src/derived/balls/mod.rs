//! The alpha complex of balls (Edelsbrunner, *Weighted alpha shapes*, 1992; *The union of balls and its dual shape*,
//! 1995).

mod faces;
mod spheres;

use super::{
    alpha::FaceClass,
    complex::Complex,
    flat::{Flat, Shape},
    sets::DisjointSets,
};
use crate::{
    error::Error,
    geometry::{Euclidean, Geometry, facet},
    index::NONE,
    input::points::Points,
    mesh::Mesh,
};
use faces::{Balls, Faces};
use std::borrow::Cow;

/// The alpha complex of weighted points, whose weights are the squares of the radii of balls.
///
/// A simplex or a face of the regular triangulation is part of the complex of a radius alpha if the balls of its vertices,
/// when alpha² has been added to all weights, meet where the power cells of the vertices do. For alpha 0 that is the *dual
/// complex* of the balls: it has the components, the tunnels and the voids of their union. In other words, a face is part
/// of it by itself if its smallest sphere that is orthogonal to the balls has a radius of at most alpha and intersects no
/// other ball at more than a right angle; and so are all faces of what is.
///
/// Without weights it is the complex that [`AlphaShape::at`](crate::AlphaShape::at) returns. A larger alpha stands for
/// larger balls; smaller ones need smaller weights.
///
/// Hidden points are not part of it: the union of the balls is the same without them. Points in a plane of space, or on a
/// line, have [singular](FaceClass::Singular) triangles or edges in the place of simplices. Which faces are part of the
/// complex is decided exactly, also where balls touch.
///
/// # Examples
///
/// ```
/// use gdel::{BallComplex, NONE, Triangulator};
///
/// // Three balls of radius 1 that touch each other, and one far away, in which there is a smaller one.
/// let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 3f64.sqrt(), 0.0], [0.0, 0.0, 9.0], [0.0, 0.5, 9.0]];
/// let radii = [1.0, 1.0, 1.0, 2.0, 0.5];
/// let weights = radii.map(|r| r * r);
/// let mesh = Triangulator::new().regular3d(&points, &weights)?;
/// let complex = BallComplex::new(&mesh, &points, &weights, 0.0)?;
/// assert_eq!(complex.components(), (vec![0, 0, 0, 1, NONE], 2));
/// // As large as they have to be for the middle of the triangle.
/// let grown = BallComplex::new(&mesh, &points, &weights, 0.6)?;
/// assert_eq!(grown.facets().iter().filter(|(_, class)| class.is_part()).count(), 1);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct BallComplex<const D: usize = 3, const N: usize = 4> {
    /// The number of points.
    points: usize,
    /// Whether each simplex is part of the complex.
    is_solid: Vec<bool>,
    surface: Vec<[u32; D]>,
    facets: Faces<D>,
    edges: Faces<2>,
    vertices: Vec<(u32, FaceClass)>,
}

/// The alpha complex of disks.
///
/// # Examples
///
/// ```
/// use gdel::{BallComplex, BallComplex2, Triangulator};
///
/// let points = [[0.0, 0.0], [3.0, 0.0], [0.0, 4.0f64]];
/// let weights = [4.0, 1.0, 4.0];
/// let mesh = Triangulator::new().regular2d(&points, &weights)?;
/// let complex: BallComplex2 = BallComplex::new(&mesh, &points, &weights, 0.0)?;
/// assert_eq!(complex.edges().iter().filter(|(_, class)| class.is_part()).count(), 2);
/// # Ok::<(), gdel::Error>(())
/// ```
pub type BallComplex2 = BallComplex<2, 3>;

impl<const D: usize, const N: usize> BallComplex<D, N>
where
    Euclidean: Geometry<D, N>,
{
    /// Finds the complex of a mesh for a radius `alpha`, with the points and weights that it was made of. A mesh of equal
    /// weights does not have these, so that they are given here. No weights are zeros.
    ///
    /// # Errors
    ///
    /// [`Error::BadAlpha`] if `alpha` is negative or NaN. [`Error::ValueCount`] if there is not one weight per point,
    /// [`Error::BadWeight`] if one is NaN or infinite. [`Error::PointCount`], [`Error::NotFinite`] or
    /// [`Error::BrokenMesh`] as for [`Locator::new`](crate::Locator::new), the last one also if the mesh has other weights
    /// than these; and [`Error::ConstrainedMesh`].
    pub fn new<'a>(
        mesh: &'a impl Mesh<D, N>,
        points: impl Into<Points<'a, D>>,
        weights: &'a [f64],
        alpha: f64,
    ) -> Result<Self, Error> {
        if alpha.is_nan() || alpha < 0.0 {
            return Err(Error::BadAlpha);
        }
        let mut complex = Complex::new(mesh, points.into())?;
        complex.check_unconstrained()?;
        complex.weights = Cow::Borrowed(checked(weights, &complex)?);
        let balls = Balls { complex: &complex, radius: alpha };
        match Flat::new(&complex)? {
            None => Ok(Self::of_space(&balls)),
            Some(flat) => Ok(Self::of_flat(&balls, &flat)),
        }
    }

    fn of_space(balls: &Balls<'_, D, N>) -> Self {
        let complex = balls.complex;
        let is_solid = balls.are_small(&complex.simplices);
        let rows = (&*complex.simplices, &*complex.neighbors);
        let facets = balls.of_cells(rows, &is_solid, true, facet::<u32, D, N>);
        let edges = if D == 2 { ascending(resized(&facets)) } else { balls.of_triangles(&resized(&facets)) };
        let is_outer = |t: usize, k: usize| complex.across(t, k).is_none_or(|across| !is_solid[across]);
        let solid = (0..is_solid.len()).filter(|&t| is_solid[t]);
        let outer = solid.flat_map(|t| (0..N).filter(move |&k| is_outer(t, k)).map(move |k| (t, k)));
        let surface = outer.map(|(t, k)| facet(&complex.simplices[t], k)).collect();
        let vertices = balls.of_edges(&edges, complex.vertices());
        BallComplex { points: complex.points().len(), is_solid, surface, facets, edges, vertices }
    }

    /// Finds the complex of points in a plane of space, or on a line.
    fn of_flat(balls: &Balls<'_, D, N>, flat: &Flat) -> Self {
        let (facets, edges) = match &flat.shape {
            Shape::Line { vertices, .. } => {
                let cells: Vec<[u32; 2]> = vertices.windows(2).map(|pair| [pair[0], pair[1]]).collect();
                let edges = balls.of_cells_alone(&cells);
                (if D == 2 { resized(&edges) } else { Vec::new() }, edges)
            }
            Shape::Plane(plane) => {
                let cells: Vec<[u32; 3]> = plane.triangles().collect();
                // From vertex k to the next one, opposite the one after that.
                let across = |halfedge: u32| if halfedge == NONE { NONE } else { halfedge / 3 };
                let halfedges = plane.mesh.halfedges.iter();
                let neighbors: Vec<[u32; 3]> = halfedges.map(|&[a, b, c]| [b, c, a].map(across)).collect();
                let triangles = balls.of_cells_alone(&cells);
                let is_in: Vec<bool> = triangles.iter().map(|(_, class)| class.is_part()).collect();
                let edge = |cell: &[u32; 3], k: usize| [cell[(k + 1) % 3], cell[(k + 2) % 3]];
                (resized(&triangles), balls.of_cells((&cells, &neighbors), &is_in, false, edge))
            }
        };
        let edges = ascending(edges);
        let turned = |mut facet: [u32; D]| {
            facet.swap(0, 1);
            facet
        };
        let solid = facets.iter().filter(|(_, class)| class.is_part());
        let surface = solid.flat_map(|&(facet, _)| [facet, turned(facet)]).collect();
        let vertices = balls.complex.vertices().filter(|v| !flat.hidden.contains(v));
        let vertices = balls.of_edges(&edges, vertices);
        BallComplex { points: balls.complex.points().len(), is_solid: Vec::new(), surface, facets, edges, vertices }
    }
}

impl<const D: usize, const N: usize> BallComplex<D, N> {
    /// Returns the simplices that are part of the complex, in ascending order.
    pub fn solid(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.is_solid.len()).filter(|&t| self.is_solid[t])
    }

    /// Returns the boundary of the simplices that are part of the complex, as
    /// [`AlphaComplex::surface`](crate::AlphaComplex::surface) does: closed, and triangles are counter-clockwise as seen
    /// from outside; in 2D edges have the inside on their left.
    pub fn surface(&self) -> &[[u32; D]] {
        &self.surface
    }

    /// Returns all facets and what they are, in the order of the simplices. They are counter-clockwise as seen from
    /// outside the simplex with the lower index, and in 2D have the triangle with the lower index on the left.
    pub fn facets(&self) -> &[([u32; D], FaceClass)] {
        &self.facets
    }

    /// Returns all edges and what they are, in ascending order, the lower vertex first. In 2D they are the facets.
    pub fn edges(&self) -> &[([u32; 2], FaceClass)] {
        &self.edges
    }

    /// Returns all vertices and what they are, in ascending order. Exterior are those whose ball does not meet their power
    /// cell, as where its square is negative.
    pub fn vertices(&self) -> &[(u32, FaceClass)] {
        &self.vertices
    }

    /// Returns for each point the number of its component, and the number of components: those of the union of the
    /// balls. They are counted in the order of their lowest points; points that are no part of the complex have
    /// [`NONE`].
    ///
    /// # Examples
    ///
    /// ```
    /// // Two balls that touch, and a third one.
    /// let points = [[0.0, 0.0], [3.0, 0.0], [0.0, 9.0f64]];
    /// let weights = [4.0, 1.0, 1.0];
    /// let mesh = gdel::Triangulator::new().regular2d(&points, &weights)?;
    /// let (components, count) = gdel::BallComplex::new(&mesh, &points, &weights, 0.0)?.components();
    /// assert_eq!((&components[..], count), (&[0, 0, 1][..], 2));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn components(&self) -> (Vec<u32>, usize) {
        let mut sets = DisjointSets::new(self.points);
        for &([v, w], _) in self.edges.iter().filter(|(_, class)| class.is_part()) {
            sets.unite(v, w);
        }
        let mut labels = vec![NONE; self.points];
        let mut count = 0;
        for &(v, _) in self.vertices.iter().filter(|(_, class)| class.is_part()) {
            // The lowest vertex of a component comes first.
            let root = sets.find(v);
            if root == v {
                labels[v as usize] = count;
                count += 1;
            } else {
                labels[v as usize] = labels[root as usize];
            }
        }
        (labels, count as usize)
    }
}

/// Returns weights if they are those that a mesh was made with.
///
/// # Errors
///
/// Those of [`BallComplex::new`].
fn checked<'a, const D: usize, const N: usize>(
    weights: &'a [f64],
    complex: &Complex<'_, D, N>,
) -> Result<&'a [f64], Error> {
    let points = complex.points().len();
    if weights.len() != points && !weights.is_empty() {
        return Err(Error::ValueCount { values: weights.len(), points });
    }
    if let Some(index) = weights.iter().position(|weight| !weight.is_finite()) {
        return Err(Error::BadWeight { index });
    }
    let are_those = match &*complex.weights {
        [] => weights.windows(2).all(|pair| pair[0] == pair[1]),
        of_mesh => of_mesh == weights,
    };
    match are_those {
        true => Ok(weights),
        false => Err(Error::BrokenMesh { reason: "they have other weights" }),
    }
}

/// Returns faces as arrays of another length, which is theirs.
fn resized<const K: usize, const L: usize>(faces: &Faces<K>) -> Faces<L> {
    faces.iter().map(|&(face, class)| (std::array::from_fn(|k| face[k]), class)).collect()
}

/// Returns edges in ascending order, the lower vertex first.
fn ascending(mut edges: Faces<2>) -> Faces<2> {
    edges.iter_mut().for_each(|(edge, _)| edge.sort_unstable());
    edges.sort_unstable_by_key(|&(edge, _)| edge);
    edges
}
