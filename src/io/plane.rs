//! Meshes of the plane in files.
//!
//! Files have triangles counter-clockwise where *y* points up, as [`Mesh2`] has them. Formats of space get z = 0.

use crate::io::{FormatError, MeshData2, PointBuf, PointCloud, glb, obj, ply, stl, tetgen, vtu};
use crate::{Mesh2, Points, Points2, index::NONE};
use std::io::{self, Write};

fn in_space(points: Points2<'_>) -> PointBuf {
    match points {
        Points::F32(p) => PointBuf::F32(p.iter().map(|&[x, y]| [x, y, 0.0]).collect()),
        Points::F64(p) => PointBuf::F64(p.iter().map(|&[x, y]| [x, y, 0.0]).collect()),
    }
}

/// The x and y of all points, and whether a z that is not 0 is lost.
pub fn drop_z(cloud: &PointCloud) -> (PlanePoints, bool) {
    match &cloud.points {
        PointBuf::F32(p) => {
            (PlanePoints::F32(p.iter().map(|&[x, y, _]| [x, y]).collect()), p.iter().any(|p| p[2] != 0.0))
        }
        PointBuf::F64(p) => {
            (PlanePoints::F64(p.iter().map(|&[x, y, _]| [x, y]).collect()), p.iter().any(|p| p[2] != 0.0))
        }
    }
}

/// Owned points of the plane in the precision of their file.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanePoints {
    /// Single precision.
    F32(Vec<[f32; 2]>),
    /// Double precision.
    F64(Vec<[f64; 2]>),
}

impl<'a> From<&'a PlanePoints> for Points2<'a> {
    fn from(points: &'a PlanePoints) -> Self {
        match points {
            PlanePoints::F32(p) => p.into(),
            PlanePoints::F64(p) => p.into(),
        }
    }
}

/// Writes the triangles for Triangle, counted from 0.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_ele2<W: Write>(to: W, mesh: &Mesh2) -> io::Result<()> {
    tetgen::write_rows(to, " 0", &mesh.triangles)
}

/// Writes the neighbours for Triangle: the *k*-th is across the edge opposite the *k*-th vertex in [`write_ele2`]'s file, -1
/// outside.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_neigh2<W: Write>(to: W, mesh: &Mesh2) -> io::Result<()> {
    let triangle = |halfedge: i32| if halfedge == NONE { NONE } else { halfedge / 3 };
    let neighbors: Vec<[i32; 3]> = mesh.halfedges.iter().map(|&[ab, bc, ca]| [bc, ca, ab].map(triangle)).collect();
    tetgen::write_rows(to, "", &neighbors)
}

/// Writes points and triangles as VTK's unstructured grid.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_vtu2<W: Write>(to: W, points: Points2<'_>, mesh: &Mesh2) -> io::Result<()> {
    vtu::write_cells(to, (&in_space(points)).into(), &mesh.triangles, vtu::TRIANGLE)
}

/// Writes the triangles as binary little-endian PLY, in the points' precision, without the points that are no vertices.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_ply2<W: Write>(to: W, points: Points2<'_>, mesh: &Mesh2) -> io::Result<()> {
    ply::write_surface(to, (&in_space(points)).into(), &mesh.triangles)
}

/// Writes the triangles as Wavefront OBJ, without the points that are no vertices.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_obj2<W: Write>(to: W, points: Points2<'_>, mesh: &Mesh2) -> io::Result<()> {
    obj::write_surface(to, (&in_space(points)).into(), &mesh.triangles)
}

/// Writes the triangles as STL: binary where that holds the coordinates exactly, which is in single precision, else ASCII.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_stl2<W: Write>(to: W, points: Points2<'_>, mesh: &Mesh2) -> io::Result<()> {
    stl::write_surface(to, (&in_space(points)).into(), &mesh.triangles, "triangulation")
}

/// Writes the triangles as binary glTF, without the points that are no vertices: see [`write_hull_glb`](crate::io::write_hull_glb).
///
/// # Errors
///
/// When `to` cannot be written; [`io::ErrorKind::FileTooLarge`] beyond 4 GB.
pub fn write_glb2<W: Write>(to: W, points: Points2<'_>, mesh: &Mesh2) -> io::Result<()> {
    glb::write_surface(to, (&in_space(points)).into(), &mesh.triangles, "triangulation")
}

/// Reads the triangles of an `.ele` file of Triangle's. One whose first triangle is number 1 counts from 1.
///
/// # Errors
///
/// Where the file is broken, and how.
pub fn read_ele2(bytes: &[u8]) -> Result<MeshData2, FormatError> {
    Ok(MeshData2 { triangles: tetgen::read_simplices(bytes, "triangles")?, halfedges: None })
}

/// Reads the triangles of VTK's unstructured grid.
///
/// # Errors
///
/// Where the file is broken, and how; when it has cells that are no triangles.
pub fn read_vtu2(bytes: &[u8]) -> Result<MeshData2, FormatError> {
    Ok(MeshData2 { triangles: vtu::read_cells(bytes, vtu::TRIANGLE, "triangle", ["", "s"])?, halfedges: None })
}
