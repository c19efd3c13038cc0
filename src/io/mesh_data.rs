//! Meshes as files give and take them.

use crate::{Points, d2::verify::MeshView2, d3::verify::MeshView};

/// A mesh as a file gives it: nothing about it has been checked.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MeshData {
    /// Four indices of points a tetrahedron.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Entry *k* is the tetrahedron across the facet opposite vertex *k*, -1 outside; `None` when the file does not
    /// say.
    pub neighbors: Option<Vec<[i32; 4]>>,
}

impl<'a> From<&'a MeshData> for MeshView<'a> {
    fn from(mesh: &'a MeshData) -> Self {
        MeshView { neighbors: mesh.neighbors.as_deref(), ..MeshView::of_tetrahedra(&mesh.tetrahedra) }
    }
}

/// A mesh of the plane as a file gives it: nothing about it has been checked.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MeshData2 {
    /// Three indices of points a triangle, in the sense that [`Mesh2`](crate::Mesh2) has.
    pub triangles: Vec<[u32; 3]>,
    /// As in [`Mesh2`](crate::Mesh2); `None` when the file does not say.
    pub halfedges: Option<Vec<[i32; 3]>>,
}

impl<'a> From<&'a MeshData2> for MeshView2<'a> {
    fn from(mesh: &'a MeshData2) -> Self {
        MeshView2 { halfedges: mesh.halfedges.as_deref(), ..MeshView2::of_triangles(&mesh.triangles) }
    }
}

/// Triangles and their vertices, counted anew.
pub(super) struct Surface<'a> {
    points: Points<'a>,
    triangles: &'a [[u32; 3]],
    /// The points that are vertices, ascending.
    used: Vec<u32>,
}

impl<'a> Surface<'a> {
    pub(super) fn new(points: Points<'a>, triangles: &'a [[u32; 3]]) -> Self {
        let mut used = triangles.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        Surface { points, triangles, used }
    }

    pub(super) fn vertices(&self) -> impl ExactSizeIterator<Item = [f64; 3]> {
        self.used.iter().map(|&v| self.points.get(v as usize))
    }

    /// Whether the file's points are single precision.
    pub(super) fn is_single(&self) -> bool {
        matches!(self.points, Points::F32(_))
    }

    /// Indices into [`vertices`](Self::vertices).
    pub(super) fn triangles(&self) -> impl ExactSizeIterator<Item = [u32; 3]> {
        // `partition_point` counts the smaller vertices, which is the new number of `v`.
        self.triangles.iter().map(|t| t.map(|v| self.used.partition_point(|&w| w < v) as u32))
    }
}
