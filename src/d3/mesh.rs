//! The result: tetrahedra, their neighbours, and the hull.

use crate::{index::NONE, stats::Stats};

/// The corners of the facet opposite vertex *k* of a positively oriented tetrahedron,
/// counter-clockwise as seen from outside the tetrahedron.
pub const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// A 3D Delaunay triangulation.
///
/// All vertices are indices of input points.
#[derive(Debug, Clone, Default)]
pub struct Mesh3 {
    /// Four vertices per tetrahedron, positively oriented: det(b − a, c − a, d − a) > 0. Never
    /// flat.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Entry *k* is the tetrahedron across the facet opposite vertex *k*; [`NONE`] on the hull.
    pub neighbors: Vec<[i32; 4]>,
    /// The facets of the convex hull, counter-clockwise as seen from outside.
    pub hull: Vec<[u32; 3]>,
    /// One entry per point: the lowest index of a point with the same coordinates, which represents
    /// this one in the mesh; [`NONE`] for the points that are vertices themselves.
    pub duplicate_of: Vec<i32>,
    /// The affine dimension of the input: 3; 2, 1 or 0 if all points are coplanar, collinear or
    /// equal (then there are no tetrahedra). 0 for no points at all.
    pub dimension: u8,
    /// How the result came about.
    pub stats: Stats,
}

impl Mesh3 {
    /// Returns the tetrahedra in a form that is equal for equal meshes: the vertices ascending
    /// within each tetrahedron, the tetrahedra ascending.
    pub fn canonical(&self) -> Vec<[u32; 4]> {
        let mut tetrahedra = self.tetrahedra.clone();
        for t in &mut tetrahedra {
            t.sort_unstable();
        }
        tetrahedra.sort_unstable();
        tetrahedra
    }

    /// Returns the number of points that are exact duplicates of others.
    pub fn duplicates(&self) -> usize {
        self.duplicate_of.iter().filter(|&&d| d != NONE).count()
    }
}
