//! The formats of solvers: Gmsh's MSH, and Triangle's `.poly` of a mesh.

use crate::{
    Mesh,
    surface::MARK,
    tetgen::{Shortest, write_node_rows},
};
use gdel::Points;
use std::io::{self, Write};

/// Gmsh's numbers for an edge, and for simplices by their number of vertices.
const LINE: u32 = 1;
const SIMPLEX: [u32; 5] = [0, 0, 0, 2, 4];

/// Writes a mesh as text in version 2.2 of Gmsh's MSH, which most programs read: all points, the constrained edges as the
/// physical group `segments`, and the simplices as another.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
///
/// # Examples
///
/// ```
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0f64]];
/// let mesh = gdel::delaunay2d(&points)?;
/// let mut file = Vec::new();
/// gdel_io::write_msh(&mut file, (&points).into(), &mesh).unwrap();
/// assert!(String::from_utf8(file).unwrap().contains("$Elements\n1\n1 2 2 1 1 "));
/// # Ok::<(), gdel::Error>(())
/// ```
pub fn write_msh<const D: usize, const N: usize, M: Mesh<D, N>>(
    mut to: impl Write,
    points: Points<'_, D>,
    mesh: &M,
) -> io::Result<()> {
    let (segments, simplices) = (mesh.constraints(), mesh.simplices());
    writeln!(to, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n{MARK}\n$EndComments")?;
    writeln!(to, "$PhysicalNames\n{}", 1 + usize::from(!segments.is_empty()))?;
    if !segments.is_empty() {
        writeln!(to, "1 1 \"segments\"")?;
    }
    writeln!(to, "{D} 1 \"{}\"\n$EndPhysicalNames", M::NAMES.simplices)?;
    writeln!(to, "$Nodes\n{}", points.len())?;
    for (i, p) in (1..).zip(points.iter()) {
        write!(to, "{i}")?;
        (0..3).try_for_each(|axis| write!(to, " {}", Shortest(p.get(axis).copied().unwrap_or(0.0))))?;
        writeln!(to)?;
    }
    writeln!(to, "$EndNodes\n$Elements\n{}", segments.len() + simplices.len())?;
    let lines = segments.iter().map(|ends| (LINE, ends.as_slice()));
    let all = lines.chain(simplices.iter().map(|vertices| (SIMPLEX[N], vertices.as_slice())));
    for (i, (kind, vertices)) in (1..).zip(all) {
        write!(to, "{i} {kind} 2 1 1")?;
        vertices.iter().try_for_each(|&v| write!(to, " {}", u64::from(v) + 1))?;
        writeln!(to)?;
    }
    writeln!(to, "$EndElements")
}

/// Writes the points and constrained edges of a 2D mesh as a `.poly` file of Triangle, without holes: these are in
/// the triangles of [`write_ele`](crate::write_ele).
///
/// # Errors
///
/// Returns an error if `to` cannot be written, and [`io::ErrorKind::Unsupported`] for 3D meshes.
pub fn write_poly<const D: usize, const N: usize, M: Mesh<D, N>>(
    mut to: impl Write,
    points: Points<'_, D>,
    mesh: &M,
) -> io::Result<()> {
    if D != 2 {
        return Err(io::Error::new(io::ErrorKind::Unsupported, "only 2D meshes have segments"));
    }
    write_node_rows(&mut to, points)?;
    writeln!(to, "{} 0", mesh.constraints().len())?;
    for (i, [a, b]) in mesh.constraints().iter().enumerate() {
        writeln!(to, "{i} {a} {b}")?;
    }
    writeln!(to, "0\n# {MARK}")
}
