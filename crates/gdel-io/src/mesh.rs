//! The trait that lets formats handle meshes of either dimension.

use crate::PointBuf;
use gdel::{Mesh2, Mesh3, MeshView2, MeshView3};
use std::borrow::Cow;

/// The names of the weights of points, and of those that are hidden, in files.
pub(super) const WEIGHT: &str = "weight";
pub(super) const HIDDEN: &str = "hidden";

/// The names of the parts of a mesh, in files and messages.
#[doc(hidden)]
#[derive(Debug, Clone, Copy)]
pub struct Names {
    pub(super) simplex: &'static str,
    /// Also the name of the array of NumPy.
    pub(super) simplices: &'static str,
    /// The name of NumPy's second array.
    pub(super) adjacency: &'static str,
    /// The name of the surface in formats of triangles.
    pub(super) surface: &'static str,
    /// VTK's number for a simplex.
    pub(super) vtk: u8,
}

/// A mesh that files can hold.
pub trait Mesh<const D: usize, const N: usize>: gdel::Mesh<D, N> {
    #[doc(hidden)]
    const NAMES: Names;

    /// Returns the rows of the second array in NumPy's files: neighbours, or half-edges.
    #[doc(hidden)]
    fn adjacency(&self) -> &[[u32; N]];

    /// Returns the triangles of the hull, or all triangles of a 2D mesh, in the orientation of
    /// files.
    #[doc(hidden)]
    fn surface(&self) -> Cow<'_, [[u32; 3]]>;

    /// Returns the points that are no vertices because of their weights.
    #[doc(hidden)]
    fn hidden(&self) -> &[u32];

    /// Creates the data of a file from NumPy's arrays.
    #[doc(hidden)]
    fn from_arrays(simplices: Vec<[u32; N]>, adjacency: Option<Vec<[u32; N]>>) -> MeshData<D, N>;
}

impl Mesh<3, 4> for Mesh3 {
    const NAMES: Names = Names {
        simplex: "tetrahedron",
        simplices: "tetrahedra",
        adjacency: "neighbors",
        surface: "convex hull",
        vtk: 10,
    };

    fn adjacency(&self) -> &[[u32; 4]] {
        &self.neighbors
    }

    fn surface(&self) -> Cow<'_, [[u32; 3]]> {
        Cow::Borrowed(&self.hull)
    }

    fn hidden(&self) -> &[u32] {
        &self.hidden
    }

    fn from_arrays(simplices: Vec<[u32; 4]>, neighbors: Option<Vec<[u32; 4]>>) -> MeshData3 {
        MeshData { simplices, neighbors, ..MeshData::default() }
    }
}

impl Mesh<2, 3> for Mesh2 {
    const NAMES: Names =
        Names { simplex: "triangle", simplices: "triangles", adjacency: "halfedges", surface: "triangulation", vtk: 5 };

    fn adjacency(&self) -> &[[u32; 3]] {
        &self.halfedges
    }

    fn surface(&self) -> Cow<'_, [[u32; 3]]> {
        Cow::Borrowed(&self.triangles)
    }

    fn hidden(&self) -> &[u32] {
        &self.hidden
    }

    fn from_arrays(simplices: Vec<[u32; 3]>, halfedges: Option<Vec<[u32; 3]>>) -> MeshData2 {
        MeshData { simplices, halfedges, ..MeshData::default() }
    }
}

/// A mesh as a file gives it: nothing about it has been checked.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct MeshData<const D: usize, const N: usize> {
    /// The indices of the vertices of each tetrahedron, or of each triangle in the orientation of
    /// [`Mesh2`].
    pub simplices: Vec<[u32; N]>,
    /// Entry *k* is the tetrahedron, or triangle, opposite vertex *k*, [`NONE`](gdel::NONE) outside; `None` when the
    /// file does not say.
    pub neighbors: Option<Vec<[u32; N]>>,
    /// The half-edges of a 2D mesh as in [`Mesh2`]; `None` when the file does not say.
    pub halfedges: Option<Vec<[u32; N]>>,
    /// The points that the vertices are indices of; `None` when the file does not have them.
    pub points: Option<PointBuf<D>>,
    /// The weights of the points, whose regular triangulation the mesh is; `None` when the file does not have them.
    pub weights: Option<Vec<f64>>,
    /// The points that are no vertices because of their weights; `None` when the file does not say.
    pub hidden: Option<Vec<u32>>,
}

/// A 3D mesh as a file gives it.
pub type MeshData3 = MeshData<3, 4>;

/// A 2D mesh as a file gives it.
pub type MeshData2 = MeshData<2, 3>;

impl<'a> From<&'a MeshData3> for MeshView3<'a> {
    fn from(mesh: &'a MeshData3) -> Self {
        let mut view = MeshView3::of_tetrahedra(&mesh.simplices);
        view.neighbors = mesh.neighbors.as_deref();
        (view.weights, view.hidden) = (mesh.weights.as_deref(), mesh.hidden.as_deref());
        view
    }
}

impl<'a> From<&'a MeshData2> for MeshView2<'a> {
    fn from(mesh: &'a MeshData2) -> Self {
        let mut view = MeshView2::of_triangles(&mesh.simplices);
        (view.halfedges, view.neighbors) = (mesh.halfedges.as_deref(), mesh.neighbors.as_deref());
        (view.weights, view.hidden) = (mesh.weights.as_deref(), mesh.hidden.as_deref());
        view
    }
}
