//! The files of meshes that are larger than memory: one for each tile.

use crate::{
    FormatError, Mesh, archive, npy,
    npz::{array, open, read_array, read_indices},
    surface::{MARK, padded},
    vtu,
};
use gdel::{
    NONE,
    tiles::{Link, Piece},
};
use std::io::{self, Read, Seek, Write};

/// The name of the array of links in the file of a tile.
const LINKS: &str = "links";

/// Writes the file of a tile without its links, which are [appended](append_links): NumPy arrays, uncompressed as
/// `numpy.savez` does.
///
/// | array | type, shape | |
/// | --- | --- | --- |
/// | `points` | f8, n × 3 or 2 | the tile's points, and the vertices of its simplices that belong to other tiles, in the order of their indices |
/// | `indices` | u4, n | the index of each in the whole input |
/// | `tiles` | u4, n | the tile that each belongs to |
/// | `tetrahedra` or `triangles` | u4, m × 4 or 3 | rows of `points` |
/// | `neighbors` or `halfedges` | i4, m × 4 or 3 | as in the file of a whole mesh; −1 on the hull and where the neighbour is in another tile |
/// | `duplicates` | u4, d × 2 | the indices of points of the tile that duplicate others, and of those |
/// | `links` | u4, l × 3 | where the neighbour is in another tile: a place in the flat `neighbors`, the tile, and the neighbour there |
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_tile<M: Mesh<D, N>, const D: usize, const N: usize>(
    to: impl Write,
    piece: &Piece<D, N>,
) -> io::Result<()> {
    archive::write(to, |archive| {
        array(archive, "points", |to| npy::write_array(to, "<f8", &piece.points, f64::to_le_bytes))?;
        array(archive, "indices", |to| npy::write_vector(to, "<u4", &piece.indices, u32::to_le_bytes))?;
        array(archive, "tiles", |to| npy::write_vector(to, "<u4", &piece.owners, u32::to_le_bytes))?;
        let (simplices, neighbors) = (&piece.part.simplices, &piece.part.neighbors);
        array(archive, M::NAMES.simplices, |to| npy::write_array(to, "<u4", simplices, u32::to_le_bytes))?;
        array(archive, M::NAMES.adjacency, |to| npy::write_array(to, "<i4", neighbors, u32::to_le_bytes))?;
        array(archive, "duplicates", |to| npy::write_array(to, "<u4", &piece.part.duplicates, u32::to_le_bytes))
    })
}

/// Appends its links to the file of a tile.
///
/// # Errors
///
/// Returns an error if `file` is not an archive that can be written.
pub fn append_links(file: impl Read + Write + Seek, links: &[Link]) -> io::Result<()> {
    let rows: Vec<[u32; 3]> = links.iter().map(|link| [link.place, link.tile, link.entry]).collect();
    archive::append(file, &format!("{LINKS}.npy"), |to| npy::write_array(to, "<u4", &rows, u32::to_le_bytes))
}

/// Reads the file of a tile, and its links.
///
/// # Errors
///
/// Returns an error if the file or an array is broken or missing.
pub fn read_tile<M: Mesh<D, N>, const D: usize, const N: usize>(
    from: impl Read + Seek,
) -> Result<(Piece<D, N>, Vec<Link>), FormatError> {
    let mut archive = open(from)?;
    let missing = |name: &str| FormatError::byte(0, format!("the archive has no array `{name}`"));
    let points = read_array(&mut archive, "points", |array| array.points::<D>())?.ok_or_else(|| missing("points"))?;
    let points = gdel::Points::from(&points.points).iter().collect();
    let mut vector = |name: &str| read_array(&mut archive, name, |array| array.vector())?.ok_or_else(|| missing(name));
    let vectors = [vector("indices")?, vector("tiles")?];
    let index = 0..=i64::from(u32::MAX);
    let words = |row: [i64; N]| row.map(|n| if n == -1 { NONE } else { n as u32 });
    let name = M::NAMES.simplices;
    let simplices = read_indices::<N>(&mut archive, name, index.clone())?.ok_or_else(|| missing(name))?;
    let name = M::NAMES.adjacency;
    let neighbors = read_indices::<N>(&mut archive, name, -1..=i32::MAX.into())?.ok_or_else(|| missing(name))?;
    let duplicates =
        read_indices::<2>(&mut archive, "duplicates", index.clone())?.ok_or_else(|| missing("duplicates"))?;
    let links = read_indices::<3>(&mut archive, LINKS, index)?.ok_or_else(|| missing(LINKS))?;
    let arrays = [simplices, neighbors].map(|rows| rows.into_iter().map(words).collect());
    let duplicates = duplicates.into_iter().map(|row| row.map(|n| n as u32)).collect();
    let link = |row: [i64; 3]| {
        let [place, tile, entry] = row.map(|n| n as u32);
        Link { place, tile, entry }
    };
    Ok((Piece::from_arrays(points, vectors, arrays, duplicates), links.into_iter().map(link).collect()))
}

/// Writes the piece of a tile as VTK's unstructured grid, without its neighbours. Point data are the index of each point in
/// the whole input (`index`), the tile that it belongs to (`tile`), and the index of the point that it duplicates, or its
/// own (`duplicate_of`). 2D points get *z* = 0.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_tile_vtu<M: Mesh<D, N>, const D: usize, const N: usize>(
    to: impl Write,
    piece: &Piece<D, N>,
) -> io::Result<()> {
    let (points, cells) = (piece.points.len() as u64, piece.part.simplices.len() as u64);
    let vector = |values: &[u32], to: &mut dyn Write| values.iter().try_for_each(|x| to.write_all(&x.to_le_bytes()));
    let indices = |to: &mut dyn Write| vector(&piece.indices, to);
    let tiles = |to: &mut dyn Write| vector(&piece.owners, to);
    let mut duplicate_of = piece.indices.clone();
    for [i, first] in &piece.part.duplicates {
        if let Ok(v) = piece.indices.binary_search(i) {
            duplicate_of[v] = *first;
        }
    }
    let duplicates = |to: &mut dyn Write| vector(&duplicate_of, to);
    let coordinates = |to: &mut dyn Write| {
        piece.points.iter().copied().flat_map(padded).try_for_each(|x| to.write_all(&x.to_le_bytes()))
    };
    let connectivity = |to: &mut dyn Write| vector(piece.part.simplices.as_flattened(), to);
    let offsets = |to: &mut dyn Write| (1..=cells).try_for_each(|cell| to.write_all(&(N as u64 * cell).to_le_bytes()));
    let types = |to: &mut dyn Write| (0..cells).try_for_each(|_| to.write_all(&[M::NAMES.vtk]));
    let arrays = [
        vtu::Array::written("PointData", "index", "UInt32", 1, points * 4, &indices),
        vtu::Array::written("PointData", "tile", "UInt32", 1, points * 4, &tiles),
        vtu::Array::written("PointData", "duplicate_of", "UInt32", 1, points * 4, &duplicates),
        vtu::Array::written("Points", "Points", "Float64", 3, points * 24, &coordinates),
        vtu::Array::written("Cells", "connectivity", "UInt32", 1, cells * N as u64 * 4, &connectivity),
        vtu::Array::written("Cells", "offsets", "Int64", 1, cells * 8, &offsets),
        vtu::Array::written("Cells", "types", "UInt8", 1, cells, &types),
    ];
    vtu::write_arrays(to, piece.points.len(), piece.part.simplices.len(), &arrays)
}

/// Reads a file that [`write_tile_vtu`] has written.
///
/// # Errors
///
/// Returns an error if the file or an array is broken or missing.
pub fn read_tile_vtu<M: Mesh<D, N>, const D: usize, const N: usize>(bytes: &[u8]) -> Result<Piece<D, N>, FormatError> {
    let mesh = vtu::read_vtu::<M, D, N>(bytes)?;
    let points = mesh.points.ok_or_else(|| FormatError::byte(0, "there are no points"))?;
    let points: Vec<[f64; D]> = gdel::Points::from(&points).iter().collect();
    let [indices, owners, duplicate_of] = vtu::read_words(bytes, ["index", "tile", "duplicate_of"])?;
    let duplicates = indices.iter().zip(&duplicate_of).filter(|(i, first)| i != first).map(|(&i, &first)| [i, first]);
    let duplicates = duplicates.collect();
    Ok(Piece::from_arrays(points, [indices, owners], [mesh.simplices, Vec::new()], duplicates))
}

/// Writes the file that names those of all tiles, which [`write_tile_vtu`] has written, for VTK.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_pvtu(mut to: impl Write, files: &[String]) -> io::Result<()> {
    write!(
        to,
        r#"<?xml version="1.0"?>
<VTKFile type="PUnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <!-- {MARK} -->
  <PUnstructuredGrid GhostLevel="0">
    <PPointData>
      <PDataArray type="UInt32" Name="index"/>
      <PDataArray type="UInt32" Name="tile"/>
      <PDataArray type="UInt32" Name="duplicate_of"/>
    </PPointData>
    <PPoints>
      <PDataArray type="Float64" Name="Points" NumberOfComponents="3"/>
    </PPoints>
"#
    )?;
    for file in files {
        writeln!(to, r#"    <Piece Source="{file}"/>"#)?;
    }
    to.write_all(b"  </PUnstructuredGrid>\n</VTKFile>\n")
}
