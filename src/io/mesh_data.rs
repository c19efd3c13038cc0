//! Meshes as files give and take them.

use crate::{Mesh3, Points, verify::Statement};

/// A mesh as a file gives it: nothing about it has been checked.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MeshData {
    /// Four indices of points a tetrahedron.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Entry *k* is the tetrahedron across the facet opposite vertex *k*, -1 outside; `None` when the file does not
    /// say.
    pub neighbors: Option<Vec<[i32; 4]>>,
}

impl<'a> From<&'a MeshData> for Statement<'a> {
    fn from(mesh: &'a MeshData) -> Self {
        Statement { neighbors: mesh.neighbors.as_deref(), ..Statement::of_tetrahedra(&mesh.tetrahedra) }
    }
}

/// The hull's triangles and their vertices, counted anew.
pub(super) struct HullSurface<'a> {
    points: Points<'a>,
    hull: &'a [[u32; 3]],
    /// The points on the hull, ascending.
    on_hull: Vec<u32>,
}

impl<'a> HullSurface<'a> {
    pub(super) fn new(points: Points<'a>, mesh: &'a Mesh3) -> Self {
        let mut on_hull = mesh.hull.as_flattened().to_vec();
        on_hull.sort_unstable();
        on_hull.dedup();
        HullSurface { points, hull: &mesh.hull, on_hull }
    }

    pub(super) fn vertices(&self) -> impl ExactSizeIterator<Item = [f64; 3]> {
        self.on_hull.iter().map(|&v| self.points.get(v as usize))
    }

    /// Whether the file's points are single precision.
    pub(super) fn is_single(&self) -> bool {
        matches!(self.points, Points::F32(_))
    }

    /// Indices into [`vertices`](Self::vertices).
    pub(super) fn triangles(&self) -> impl ExactSizeIterator<Item = [u32; 3]> {
        // `partition_point` counts the hull's smaller vertices, which is the new number of `v`.
        self.hull.iter().map(|t| t.map(|v| self.on_hull.partition_point(|&w| w < v) as u32))
    }
}
