//! NumPy's `.npz`: a ZIP archive of arrays.

use crate::{
    FormatError, Mesh, MeshData,
    archive::{self, Archive},
    mesh::{HIDDEN, Names, WEIGHT},
    npy::{self, Array},
};
use gdel::{NONE, Points};
use std::{
    io::{self, Cursor, Read, Seek, Write},
    ops::RangeInclusive,
};
use zip::{CompressionMethod, ZipArchive, result::ZipError};

/// No ZIP member expands by more: DEFLATE's limit.
const LARGEST_RATIO: u64 = 1032;

/// Reads the arrays of [`write_npz`]. Only the array of tetrahedra or triangles is required.
///
/// # Errors
///
/// Returns an error if the archive or an array is broken or missing.
pub fn read_npz<M: Mesh<D, N>, const D: usize, const N: usize>(bytes: &[u8]) -> Result<MeshData<D, N>, FormatError> {
    let mut archive = open(Cursor::new(bytes))?;
    let Names { simplices, adjacency, .. } = M::NAMES;
    let Some(rows) = read_indices(&mut archive, simplices, 0..=u32::MAX.into())? else {
        return Err(FormatError::byte(0, format!("the archive has no array `{simplices}`")));
    };
    let simplices = rows.into_iter().map(|row| row.map(|v| v as u32)).collect();
    let adjacency = read_indices(&mut archive, adjacency, -1..=i32::MAX.into())?;
    let adjacency =
        adjacency.map(|rows| rows.into_iter().map(|row| row.map(|n| if n == -1 { NONE } else { n as u32 })).collect());
    let points = read_array(&mut archive, "points", |array| array.points())?.map(|cloud| cloud.points);
    let weights = read_array(&mut archive, WEIGHT, |array| array.numbers())?;
    let hidden = if weights.is_some() { read_array(&mut archive, HIDDEN, |array| array.vector())? } else { None };
    Ok(MeshData { points, weights, hidden, ..M::from_arrays(simplices, adjacency) })
}

/// Opens an archive.
pub(super) fn open<R: Read + Seek>(from: R) -> Result<ZipArchive<R>, FormatError> {
    let not_whole = |error| FormatError::byte(0, format!("not a whole ZIP archive, which .npz is: {error}"));
    ZipArchive::new(from).map_err(not_whole)
}

pub(super) fn read_indices<const N: usize>(
    archive: &mut ZipArchive<impl Read + Seek>,
    name: &str,
    range: RangeInclusive<i64>,
) -> Result<Option<Vec<[i64; N]>>, FormatError> {
    let rows: Option<Vec<[i64; N]>> = read_array(archive, name, |array| array.indices())?;
    match rows.iter().flatten().flatten().find(|index| !range.contains(index)) {
        Some(index) => Err(FormatError::byte(0, format!("array `{name}`: {index} is not an index"))),
        None => Ok(rows),
    }
}

/// Reads the array of that name, where there is one.
pub(super) fn read_array<T>(
    archive: &mut ZipArchive<impl Read + Seek>,
    name: &str,
    read: impl FnOnce(Array<'_>) -> Result<T, FormatError>,
) -> Result<Option<T>, FormatError> {
    let in_array = |what: String| FormatError::byte(0, format!("array `{name}`: {what}"));
    let member = match archive.by_name(&format!("{name}.npy")) {
        Ok(member) => member,
        Err(ZipError::FileNotFound) => return Ok(None),
        Err(error) => return Err(in_array(error.to_string())),
    };
    let limit = member.compressed_size().saturating_mul(LARGEST_RATIO);
    let mut array = Vec::new();
    member.take(limit).read_to_end(&mut array).map_err(|error| in_array(error.to_string()))?;
    let array = Array::parse(&array).and_then(read).map_err(|error| in_array(error.to_string()))?;
    Ok(Some(array))
}

/// Writes `points` (f4 or f8, n × 3) and, of a 3D mesh, `tetrahedra` (u4, m × 4) and `neighbors`
/// (i4, m × 4), uncompressed as `numpy.savez` does; of a 2D mesh `points` (n × 2), `triangles` (m ×
/// 3) and `halfedges` (m × 3), as [`Mesh2`](gdel::Mesh2) has them. A mesh of weighted points also has `weight` (f8, n) and
/// `hidden` (u4), the points that are no vertices because of these.
///
/// # Errors
///
/// Returns an error if `to` cannot be written.
pub fn write_npz<const D: usize, const N: usize, M: Mesh<D, N>>(
    to: impl Write,
    points: Points<'_, D>,
    mesh: &M,
) -> io::Result<()> {
    archive::write(to, |archive| {
        array(archive, "points", |to| npy::write(to, points))?;
        array(archive, M::NAMES.simplices, |to| npy::write_array(to, "<u4", mesh.simplices(), u32::to_le_bytes))?;
        array(archive, M::NAMES.adjacency, |to| npy::write_array(to, "<i4", mesh.adjacency(), u32::to_le_bytes))?;
        if mesh.weights().is_empty() {
            return Ok(());
        }
        array(archive, WEIGHT, |to| npy::write_vector(to, "<f8", mesh.weights(), f64::to_le_bytes))?;
        array(archive, HIDDEN, |to| npy::write_vector(to, "<u4", mesh.hidden(), u32::to_le_bytes))
    })
}

/// Writes the array of that name.
pub(super) fn array(
    archive: &mut Archive<'_>,
    name: &str,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    archive.file(&format!("{name}.npy"), CompressionMethod::Stored, write)
}
