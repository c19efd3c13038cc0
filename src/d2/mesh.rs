//! The result: triangles, their half-edges, and the hull.

use crate::{index::NONE, stats::Stats};

/// A 2D Delaunay triangulation, laid out as in the JavaScript library
/// [delaunator](https://github.com/mapbox/delaunator).
///
/// All vertices are indices of input points. Half-edge 3·*t* + *k* goes from vertex *k* of triangle
/// *t* to the next. Where the *y* axis points down, as on screens, triangles and hull are
/// counter-clockwise; where it points up, clockwise.
#[derive(Debug, Clone, Default)]
pub struct Mesh2 {
    /// Three vertices per triangle: det(b − a, c − a) < 0. Never flat.
    pub triangles: Vec<[u32; 3]>,
    /// Entry *k* is the half-edge opposite to the one from vertex *k* to the next, 3·(triangle) +
    /// (vertex); [`NONE`] on the hull.
    pub halfedges: Vec<[i32; 3]>,
    /// The vertices of the convex hull, those in the middle of its edges included, in the
    /// orientation of the triangles, from the lowest index. If all points are collinear, the
    /// distinct points by ascending x (or y, if all x are equal).
    pub hull: Vec<u32>,
    /// One entry per point: the lowest index of a point with the same coordinates, which represents
    /// this one in the mesh; [`NONE`] for the points that are vertices themselves.
    pub duplicate_of: Vec<i32>,
    /// The affine dimension of the input: 2; 1 or 0 if all points are collinear or equal (then
    /// there are no triangles). 0 for no points at all.
    pub dimension: u8,
    /// How the result came about.
    pub stats: Stats,
}

impl Mesh2 {
    /// Returns the triangles in a form that is equal for equal meshes: the vertices ascending
    /// within each triangle, the triangles ascending.
    pub fn canonical(&self) -> Vec<[u32; 3]> {
        let mut triangles = self.triangles.clone();
        for t in &mut triangles {
            t.sort_unstable();
        }
        triangles.sort_unstable();
        triangles
    }

    /// Returns the number of points that are exact duplicates of others.
    pub fn duplicates(&self) -> usize {
        self.duplicate_of.iter().filter(|&&d| d != NONE).count()
    }
}
