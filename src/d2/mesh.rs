//! The result: triangles, their half-edges, and the hull.

use crate::{
    index::NONE,
    input::points::Points2,
    mesh::{self, Stars, common_methods},
    stats::Stats,
};

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
    pub halfedges: Vec<[i32; 3]>,
    /// The vertices of the convex hull, including those in the middle of its sides,
    /// counter-clockwise with *y* up from the lowest index. If all points are collinear: the
    /// distinct points in ascending order of x, or of y where all x are equal.
    pub hull: Vec<u32>,
    /// One entry per point: the lowest index of a point with the same coordinates, which stands for
    /// this one in the mesh; [`NONE`](crate::NONE) for points that are vertices themselves.
    pub duplicate_of: Vec<i32>,
    /// The affine dimension of the input: 2; or 1 or 0 if all points are collinear or equal, in
    /// which case there are no triangles. No points at all have dimension 0.
    pub dimension: u8,
    /// How the mesh was computed.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub stats: Stats,
}

common_methods!(Mesh2);

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

    /// Returns the triangles around every vertex.
    pub fn stars(&self) -> Stars {
        let mut stars = Stars::new(&self.triangles, self.duplicate_of.len());
        stars.arrange(|v, star| self.turn(v, star));
        stars
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
    /// It is computed in `f64`, so it is exact for no mesh, and far off or not finite for triangles
    /// that are nearly flat.
    ///
    /// # Panics
    ///
    /// Panics if there is no triangle `t`, or if its vertices are not among the points.
    pub fn circumcenter<'a>(&self, points: impl Into<Points2<'a>>, t: usize) -> [f64; 2] {
        let points = points.into();
        let [[ax, ay], b, c] = self.triangles[t].map(|v| points.get(v as usize));
        let [[bx, by], [cx, cy]] = [b, c].map(|[x, y]| [x - ax, y - ay]);
        let (bb, cc) = (bx * bx + by * by, cx * cx + cy * cy);
        let twice_det = 2.0 * (bx * cy - by * cx);
        [ax + (cy * bb - by * cc) / twice_det, ay + (bx * cc - cx * bb) / twice_det]
    }

    /// Returns the triangles in a form that is equal for equal meshes: the vertices ascend within
    /// each triangle, and the triangles ascend.
    pub fn canonical(&self) -> Vec<[u32; 3]> {
        mesh::canonical(&self.triangles)
    }
}
