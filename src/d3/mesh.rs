//! The result: tetrahedra, their neighbours, and the hull.

use crate::{
    geometry,
    index::NONE,
    input::points::Points3,
    mesh::{self, Csr, common_methods},
    stats::Stats,
};
use std::borrow::Cow;

/// The corners of the facet opposite vertex *k* of a positively oriented tetrahedron,
/// counter-clockwise as seen from outside the tetrahedron.
pub const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The vertices of the edges of a tetrahedron.
pub(crate) const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// A 3D Delaunay triangulation.
///
/// All vertices are indices of input points. Facet *k* of a tetrahedron is the one opposite its
/// vertex *k*.
///
/// # Examples
///
/// ```
/// let mut points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0f64]];
/// points.push([1.0, 1.0, 1.0]);
/// let mesh = gdel::delaunay3d(&points)?;
///
/// // Two tetrahedra with a facet in common.
/// assert_eq!((mesh.tetrahedra.len(), mesh.hull.len()), (2, 6));
/// assert_eq!((mesh.facets().count(), mesh.edges().count()), (7, 9));
/// let across: Vec<_> = (0..4).filter_map(|k| mesh.neighbor(0, k)).collect();
/// assert_eq!(across, [1]);
/// // The facet's vertices are in both, the others in one.
/// let stars = mesh.stars();
/// assert_eq!([0, 1, 2, 3, 4].map(|v| stars.of(v).len()), [1, 2, 2, 2, 1]);
/// # Ok::<(), gdel::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Mesh3 {
    /// Four vertices per tetrahedron, positively oriented: det(b − a, c − a, d − a) > 0. None is
    /// flat.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Entry *k* of each tetrahedron is the tetrahedron across its facet *k*, or [`NONE`] outside
    /// the hull.
    pub neighbors: Vec<[u32; 4]>,
    /// The triangles of the convex hull's boundary, counter-clockwise as seen from outside. None for points in a
    /// plane, whose polygon, from both sides, is the [`AlphaShape`](crate::AlphaShape)'s surface for an infinite
    /// radius.
    pub hull: Vec<[u32; 3]>,
    /// One entry per point: the lowest index of a point with the same coordinates, which stands for
    /// this one in the mesh; [`NONE`] for points that are vertices themselves. Points
    /// that were [removed](crate::Triangulator::remove) are unused, and their own duplicates. With weights,
    /// the heaviest of equal points stands for the others; of several, that with the lowest index.
    pub duplicate_of: Vec<u32>,
    /// The points that are no vertices because of their weights, in ascending order, without duplicates; always empty if
    /// there are no [`weights`](Self::weights), or no tetrahedra.
    #[cfg_attr(feature = "serde", serde(default))]
    pub hidden: Vec<u32>,
    /// The weights of the points, if the mesh is their regular triangulation:
    /// [`Triangulator::regular3d`](crate::Triangulator::regular3d). Empty for a Delaunay triangulation.
    #[cfg_attr(feature = "serde", serde(default))]
    pub weights: Vec<f64>,
    /// The affine dimension of the input: 3; or 2, 1 or 0 if all points are coplanar, collinear or
    /// equal, in which case there are no tetrahedra. No points at all have dimension 0.
    pub dimension: u8,
    /// How the mesh was computed.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub stats: Stats,
}

common_methods!(Mesh3<3, 4>, tetrahedra);

impl Mesh3 {
    /// Returns the tetrahedron across facet `k` of tetrahedron `t`; `None` outside the hull.
    ///
    /// # Panics
    ///
    /// Panics if there is no tetrahedron `t` or if `k` exceeds 3.
    pub fn neighbor(&self, t: usize, k: usize) -> Option<usize> {
        mesh::index(self.neighbors[t][k])
    }

    /// Returns the vertices of facet `k` of tetrahedron `t`, counter-clockwise as seen from outside
    /// the tetrahedron.
    ///
    /// # Panics
    ///
    /// Panics if there is no tetrahedron `t` or if `k` exceeds 3.
    pub fn facet(&self, t: usize, k: usize) -> [u32; 3] {
        FACETS[k].map(|corner| self.tetrahedra[t][corner])
    }

    /// Returns every facet of the tetrahedra once, the hull's included, counter-clockwise as seen
    /// from outside the tetrahedron with the lower index.
    pub fn facets(&self) -> impl Iterator<Item = [u32; 3]> + Clone + '_ {
        self.neighbors.iter().enumerate().flat_map(move |(t, across)| {
            (0..4).filter(move |&k| mesh::index(across[k]).is_none_or(|u| t < u)).map(move |k| self.facet(t, k))
        })
    }

    /// Returns every edge of the tetrahedra once, with the lower vertex first.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> + Clone + '_ {
        (0..self.tetrahedra.len()).flat_map(move |t| {
            EDGES.into_iter().filter(move |&edge| self.is_first_around(t, edge)).map(move |[i, j]| {
                let [a, b] = [i, j].map(|corner| self.tetrahedra[t][corner]);
                [a.min(b), a.max(b)]
            })
        })
    }

    /// Returns whether no tetrahedron around an edge has a lower index than `t`.
    fn is_first_around(&self, t: usize, [i, j]: [usize; 2]) -> bool {
        let ends = [i, j].map(|corner| self.tetrahedra[t][corner]);
        // Both ways around the edge, each until it leaves the hull; where it does not, the first
        // way comes back.
        for enter in (0..4).filter(|&k| k != i && k != j) {
            let (mut from, mut at) = (t, self.neighbors[t][enter]);
            // No edge has more tetrahedra than there are.
            for _ in 0..self.tetrahedra.len() {
                if at == NONE || at as usize == t {
                    break;
                }
                if (at as usize) < t {
                    return false;
                }
                let here = at as usize;
                // Of the two facets at the edge, the one that was not come through.
                let leave = (0..4)
                    .find(|&k| !ends.contains(&self.tetrahedra[here][k]) && self.neighbors[here][k] as usize != from);
                // Two tetrahedra can share two facets only if there are no others around the edge.
                let Some(leave) = leave else { break };
                from = here;
                at = self.neighbors[here][leave];
            }
            if at != NONE {
                break;
            }
        }
        true
    }

    /// Returns the vertices on the hull in ascending order.
    pub fn hull_vertices(&self) -> Vec<u32> {
        let mut vertices = self.hull.as_flattened().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// Returns the tetrahedra around every vertex, in ascending order; none around duplicates.
    pub fn stars(&self) -> Csr {
        Csr::stars(&self.tetrahedra, self.duplicate_of.len())
    }

    /// Returns the vertices that every vertex has an edge to, in ascending order; none for
    /// duplicates.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0f64]];
    /// let neighbors = gdel::delaunay3d(&points)?.vertex_neighbors();
    /// assert_eq!(neighbors.of(0), [1, 2, 3]);
    /// assert_eq!(neighbors.of(1), [0, 2, 3, 4]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn vertex_neighbors(&self) -> Csr {
        Csr::vertex_neighbors(&self.tetrahedra, self.duplicate_of.len())
    }

    /// Returns for every point the lowest tetrahedron that has it as a vertex; [`NONE`] for
    /// duplicates, and for all points if there are no tetrahedra.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0f64]];
    /// assert_eq!(gdel::delaunay3d(&points)?.vertex_tetrahedron(), [0, 0, 0, 0, gdel::NONE]);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn vertex_tetrahedron(&self) -> Vec<u32> {
        mesh::vertex_simplex(&self.tetrahedra, self.duplicate_of.len())
    }

    /// Returns the centre of the sphere through the vertices of tetrahedron `t`, where `points` are
    /// those of the mesh.
    ///
    /// The error is at most 2⁻³⁷ times the radius, however flat the tetrahedron is, plus the
    /// rounding of the result.
    ///
    /// # Panics
    ///
    /// Panics if there is no tetrahedron `t`, or if its vertices are not among the points.
    pub fn circumcenter<'a>(&self, points: impl Into<Points3<'a>>, t: usize) -> [f64; 3] {
        let points = points.into();
        geometry::circumcenter(&self.tetrahedra[t].map(|v| points.get(v as usize)))
    }

    /// Returns the centres of the spheres through the vertices of all tetrahedra: the vertices of
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
    /// let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0f64]];
    /// let mesh = gdel::delaunay3d(&points)?;
    /// assert_eq!(mesh.circumcenters(&points).next(), Some([1.0, 1.0, 1.0]));
    /// assert_eq!(mesh.circumradii(&points).next(), Some(3f64.sqrt()));
    /// assert_eq!(mesh.volumes(&points).sum::<f64>(), 4.0 / 3.0);
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn circumcenters<'a>(&'a self, points: impl Into<Points3<'a>>) -> impl ExactSizeIterator<Item = [f64; 3]> + 'a {
        geometry::coordinates(points.into(), &self.tetrahedra).map(|t| geometry::circumcenter(&t))
    }

    /// Returns the radii of the spheres through the vertices of all tetrahedra, with relative
    /// errors below 2⁻³⁶.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    pub fn circumradii<'a>(&'a self, points: impl Into<Points3<'a>>) -> impl ExactSizeIterator<Item = f64> + 'a {
        geometry::coordinates(points.into(), &self.tetrahedra).map(|t| geometry::circumradius(&t))
    }

    /// Returns the volumes of all tetrahedra. The errors are at most 2⁻⁵⁰ times the product of the
    /// edges at a vertex.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    pub fn volumes<'a>(&'a self, points: impl Into<Points3<'a>>) -> impl ExactSizeIterator<Item = f64> + 'a {
        geometry::coordinates(points.into(), &self.tetrahedra).map(|t| geometry::measure(&t))
    }

    /// Returns three times the radius of the inscribed sphere by that of the circumscribed sphere
    /// for all tetrahedra: 1 for regular tetrahedra, near 0 for flat ones.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    ///
    /// # Examples
    ///
    /// ```
    /// let points = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0f64]];
    /// let mesh = gdel::delaunay3d(&points)?;
    /// let quality = mesh.radius_ratios(&points).next().unwrap();
    /// assert!((quality - 1.0).abs() < 1e-15);
    /// // All six dihedral angles are arccos(1/3).
    /// let angles = mesh.dihedral_angles(&points).next().unwrap();
    /// assert!(angles.iter().all(|angle| (angle.to_degrees() - 70.528779).abs() < 1e-6));
    /// # Ok::<(), gdel::Error>(())
    /// ```
    pub fn radius_ratios<'a>(&'a self, points: impl Into<Points3<'a>>) -> impl ExactSizeIterator<Item = f64> + 'a {
        geometry::coordinates(points.into(), &self.tetrahedra).map(|t| geometry::radius_ratio(&t))
    }

    /// Returns the dihedral angles of all tetrahedra in radians, at the edges between vertices 0
    /// and 1, 0 and 2, 0 and 3, 1 and 2, 1 and 3, 2 and 3.
    ///
    /// # Panics
    ///
    /// The iterator panics if vertices are not among the points.
    pub fn dihedral_angles<'a>(
        &'a self,
        points: impl Into<Points3<'a>>,
    ) -> impl ExactSizeIterator<Item = [f64; 6]> + 'a {
        geometry::coordinates(points.into(), &self.tetrahedra).map(|t| geometry::dihedral_angles(&t))
    }

    /// Returns the tetrahedra in a form that is equal for equal meshes: the vertices ascend within
    /// each tetrahedron, and the tetrahedra ascend.
    pub fn canonical(&self) -> Vec<[u32; 4]> {
        mesh::canonical(&self.tetrahedra)
    }
}

impl Mesh3 {
    /// Returns the constrained edges, which exist in 2D only.
    fn constrained_edges(&self) -> &[[u32; 2]] {
        &[]
    }

    /// Returns for each simplex the simplices opposite its vertices.
    fn opposites(&self) -> Cow<'_, [[u32; 4]]> {
        Cow::Borrowed(&self.neighbors)
    }
}
