//! Wavefront OBJ.
//!
//! Read here because the crates do not do what is needed: `tobj` returns no vertices but those of faces, and so
//! nothing for a point cloud; `obj` reads single precision only.

use crate::io::{
    FormatError, PointBuf, PointCloud,
    mesh_data::Surface,
    text::{fields, lines, number},
};
use crate::{Mesh3, Points};
use std::io::{self, Write};

pub(super) fn read(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    let mut points = Vec::new();
    for (line, content) in lines(bytes) {
        let mut words = fields(content);
        if words.next() != Some(b"v") {
            continue;
        }
        let mut point = [0.0; 3];
        for x in &mut point {
            let word = words.next().ok_or_else(|| FormatError::line(line, "a vertex needs x, y and z"))?;
            *x = number(word, line)?;
        }
        points.push(point);
    }
    if points.is_empty() {
        return Err(FormatError::line(1, "the file has no vertices (lines that start with `v`)"));
    }
    PointCloud::new(PointBuf::F64(points))
}

pub(super) fn write_points<W: Write>(mut to: W, points: Points<'_>) -> io::Result<()> {
    points.iter().try_for_each(|[x, y, z]| writeln!(to, "v {x:?} {y:?} {z:?}"))
}

/// Writes the hull as Wavefront OBJ, with the vertices of the hull only.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_hull_obj<W: Write>(to: W, points: Points<'_>, mesh: &Mesh3) -> io::Result<()> {
    write_surface(to, points, &mesh.hull)
}

pub(super) fn write_surface(mut to: impl Write, points: Points<'_>, triangles: &[[u32; 3]]) -> io::Result<()> {
    let surface = Surface::new(points, triangles);
    surface.vertices().try_for_each(|[x, y, z]| writeln!(to, "v {x:?} {y:?} {z:?}"))?;
    surface.triangles().try_for_each(|t| {
        let [a, b, c] = t.map(|v| v + 1);
        writeln!(to, "f {a} {b} {c}")
    })
}
