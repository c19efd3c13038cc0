//! The result: triangles, their half-edges, and the hull.

use crate::{
    geometry,
    index::NONE,
    input::points::Points2,
    mesh::{self, Csr, common_methods},
    stats::Stats,
};
use std::borrow::Cow;

/// A 2D Delaunay triangulation.
///
/// All vertices are indices of input points. Triangles and hull are counter-clockwise with *y* up.
/// Half-edge 3·*t* + *k* goes from vertex *k* of triangle *t* to its next vertex; edge *k* of a
/// triangle is the one that this half-edge lies on.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
///
/// assert_eq!(mesh.edges().count(), 5);
/// assert_eq!(mesh.hull_edges().collect::<Vec<_>>(), [[0, 1], [1, 2], [2, 3], [3, 0]]);
/// // The two triangles are neighbours across one edge.
/// let across: Vec<_> = (0..3).filter_map(|k| mesh.neighbor(0, k)).collect();
/// assert_eq!(across, [1]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Mesh2 {
    /// Three vertices per triangle, counter-clockwise with *y* up: det(b − a, c − a) > 0. None is
    /// flat.
    pub triangles: Vec<[u32; 3]>,
    /// Entry *k* of each triangle is the half-edge opposite to the one from its vertex *k* to the
    /// next, as 3·(triangle) + (vertex), or [`NONE`](crate::NONE) outside the hull.
    pub halfedges: Vec<[u32; 3]>,
    /// The vertices of the convex hull, including those in the middle of its sides,
    /// counter-clockwise with *y* up from the lowest index. If all points are collinear: the
    /// distinct points in ascending order of x, or of y where all x are equal.
    pub hull: Vec<u32>,
    /// One entry per point: the lowest index of a point with the same coordinates, which stands for
    /// this one in the mesh; [`NONE`](crate::NONE) for points that are vertices themselves. Points
    /// that were [removed](crate::Triangulator::remove) are unused, and their own duplicates. With weights,
    /// the heaviest of equal points stands for the others; of several, that with the lowest index.
    pub duplicate_of: Vec<u32>,
    /// The points that are no vertices because of their weights, in ascending order, without duplicates; always empty if
    /// there are no [`weights`](Self::weights), or no triangles.
    #[cfg_attr(feature = "serde", serde(default))]
    pub hidden: Vec<u32>,
    /// The weights of the points, if the mesh is their regular triangulation:
    /// [`Triangulator::regular2d`](crate::Triangulator::regular2d). Empty for a Delaunay triangulation.
    #[cfg_attr(feature = "serde", serde(default))]
    pub weights: Vec<f64>,
    /// The constrained edges, if the mesh is a constrained Delaunay triangulation:
    /// [`Triangulator::constrained2d`](crate::Triangulator::constrained2d). Each has its lower vertex first, and they
    /// ascend. Empty for a Delaunay triangulation.
    #[cfg_attr(feature = "serde", serde(default))]
    pub constraints: Vec<[u32; 2]>,
    /// The affine dimension of the input: 2; or 1 or 0 if all points are collinear or equal, in
    /// which case there are no triangles. No points at all have dimension 0.
    pub dimension: u8,
    /// How the mesh was computed.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub stats: Stats,
}

common_methods!(Mesh2<2, 3>, triangles);

impl Mesh2 {
    /// Returns the triangle across edge `k` of triangle `t`; `None` outside the hull.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle `t` or if `k` exceeds 2.
    pub fn neighbor(&self, t: usize, k: usize) -> Option<usize> {
        mesh::index(self.halfedges[t][k]).map(|halfedge| halfedge / 3)
    }

    /// Returns the vertices of edge `k` of triangle `t`: its vertex `k` and the next.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle `t` or if `k` exceeds 2.
    pub fn edge(&self, t: usize, k: usize) -> [u32; 2] {
        [self.triangles[t][k], self.triangles[t][(k + 1) % 3]]
    }

    /// Returns every edge of the triangles once, the hull's included, as it runs in the triangle
    /// with the lower index.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> + Clone + '_ {
        self.halfedges.iter().enumerate().flat_map(move |(t, across)| {
            (0..3).filter(move |&k| mesh::index(across[k]).is_none_or(|e| t < e / 3)).map(move |k| self.edge(t, k))
        })
    }

    /// Returns the edges of the hull, counter-clockwise; none if there are no triangles.
    pub fn hull_edges(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + Clone + '_ {
        let count = if self.triangles.is_empty() { 0 } else { self.hull.len() };
        (0..count).map(move |i| [self.hull[i], self.hull[(i + 1) % count]])
    }

    /// Returns whether an edge between two points, which may be duplicates, is one of the
    /// [`constraints`](Self::constraints).
    ///
    /// # Panics
    ///
    /// Panics if there is no such point.
    pub fn is_constrained(&self, edge: [u32; 2]) -> bool {
        let [a, b] = edge.map(|v| self.representative(v));
        self.constraints.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }

    /// Returns the triangles around every vertex, counter-clockwise; the first one lies behind the
    /// hull edge that starts at the vertex if there is one. A duplicate has none.
    pub fn stars(&self) -> Csr {
        let mut stars = Csr::stars(&self.triangles, self.duplicate_of.len());
        stars.arrange(|v, star| self.turn(v, star));
        stars
    }

    /// Returns the vertices that every vertex has an edge to, in ascending order; none for
    /// duplicates.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.5f64]];
    /// let neighbors = gdel::delaunay2d(&points)?.vertex_neighbors();
    /// assert_eq!(neighbors.of(0), [1, 2, 3]);
    /// assert_eq!(neighbors.of(1), [0, 2]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn vertex_neighbors(&self) -> Csr {
        Csr::vertex_neighbors(&self.triangles, self.duplicate_of.len())
    }

    /// Returns for every point the lowest triangle that has it as a vertex; [`NONE`](crate::NONE)
    /// for duplicates, and for all points if there are no triangles.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 0.0f64]];
    /// assert_eq!(gdel::delaunay2d(&points)?.vertex_triangle(), [0, 0, 0, gdel::NONE]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn vertex_triangle(&self) -> Vec<u32> {
        mesh::vertex_simplex(&self.triangles, self.duplicate_of.len())
    }

    /// Orders the triangles around a vertex counter-clockwise, from the one behind the hull edge
    /// that starts there, if any.
    fn turn(&self, v: u32, star: &mut [u32]) {
        let corner = |t: u32| self.triangles[t as usize].iter().position(|&w| w == v).unwrap_or(0);
        let behind_the_hull = |&t: &u32| self.halfedges[t as usize][corner(t)] == NONE;
        let Some(&first) = star.iter().find(|t| behind_the_hull(t)).or(star.first()) else { return };
        let mut t = first;
        for place in star {
            *place = t;
            // Across the edge that ends at the vertex.
            match self.neighbor(t as usize, (corner(t) + 2) % 3) {
                Some(next) => t = next as u32,
                None => break,
            }
        }
    }

    /// Returns the centre of the circle through the vertices of triangle `t`, where `points` are
    /// those of the mesh.
    ///
    /// The error is at most 2⁻³⁷ times the radius, however flat the triangle is, plus the rounding
    /// of the result.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle `t`, or if its vertices are not among the points.
    pub fn circumcenter<'a>(&self, points: impl Into<Points2<'a>>, t: usize) -> [f64; 2] {
        let points = points.into();
        geometry::circumcenter(&self.triangles[t].map(|v| points.get(v as usize)))
    }

    /// Returns the centres of the circles through the vertices of all triangles: the vertices of
    /// the Voronoi diagram.
    ///
    /// `points` are those of the mesh. The errors are those of
    /// [`circumcenter`](Self::circumcenter).
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [8.0, 0.0], [0.0, 6.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// assert_eq!(mesh.circumcenters(&points).next(), Some([4.0, 3.0]));
    /// assert_eq!(mesh.circumradii(&points).next(), Some(5.0));
    /// assert_eq!(mesh.areas(&points).next(), Some(24.0));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn circumcenters<'a>(&'a self, points: impl Into<Points2<'a>>) -> impl ExactSizeIterator<Item = [f64; 2]> + 'a {
        geometry::coordinates(points.into(), &self.triangles).map(|t| geometry::circumcenter(&t))
    }

    /// Returns the radii of the circles through the vertices of all triangles, with relative errors
    /// below 2⁻³⁶.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    pub fn circumradii<'a>(&'a self, points: impl Into<Points2<'a>>) -> impl ExactSizeIterator<Item = f64> + 'a {
        geometry::coordinates(points.into(), &self.triangles).map(|t| geometry::circumradius(&t))
    }

    /// Returns the areas of all triangles. The errors are at most 2⁻⁵⁰ times the product of the
    /// edges at a vertex.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    pub fn areas<'a>(&'a self, points: impl Into<Points2<'a>>) -> impl ExactSizeIterator<Item = f64> + 'a {
        geometry::coordinates(points.into(), &self.triangles).map(|t| geometry::measure(&t))
    }

    /// Returns twice the radius of the inscribed circle by that of the circumscribed circle for all
    /// triangles: 1 for equilateral triangles, near 0 for flat ones.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0f64]];
    /// let mesh = gdel::delaunay2d(&points)?;
    /// // The radii are 1 and 2.5.
    /// let quality = mesh.radius_ratios(&points).next().unwrap();
    /// assert!((quality - 0.8).abs() < 1e-15);
    /// let angles = mesh.angles(&points).next().unwrap();
    /// assert!((angles.iter().sum::<f64>().to_degrees() - 180.0).abs() < 1e-12);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn radius_ratios<'a>(&'a self, points: impl Into<Points2<'a>>) -> impl ExactSizeIterator<Item = f64> + 'a {
        geometry::coordinates(points.into(), &self.triangles).map(|t| geometry::radius_ratio(&t))
    }

    /// Returns the angles of all triangles at their vertices, in radians.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    pub fn angles<'a>(&'a self, points: impl Into<Points2<'a>>) -> impl ExactSizeIterator<Item = [f64; 3]> + 'a {
        geometry::coordinates(points.into(), &self.triangles).map(|t| geometry::angles(&t))
    }

    /// Returns the triangles in a form that is equal for equal meshes: the vertices ascend within
    /// each triangle, and the triangles ascend.
    pub fn canonical(&self) -> Vec<[u32; 3]> {
        mesh::canonical(&self.triangles)
    }
}

impl Mesh2 {
    /// Returns the constrained edges.
    fn constrained_edges(&self) -> &[[u32; 2]] {
        &self.constraints
    }

    /// Returns for each simplex the simplices opposite its vertices.
    fn opposites(&self) -> Cow<'_, [[u32; 3]]> {
        let triangle = |halfedge: u32| if halfedge == NONE { NONE } else { halfedge / 3 };
        self.halfedges.iter().map(move |&[ab, bc, ca]| [bc, ca, ab].map(triangle)).collect()
    }
}
