//! NumPy's `.npz`: a ZIP archive of arrays.

use super::{FormatError, MeshData, npy, npy::Array};
use crate::{Mesh3, Points};
use std::io::{self, Cursor, Read, Write};
use zip::{CompressionMethod, ZipArchive, ZipWriter, result::ZipError, write::SimpleFileOptions};

/// No ZIP member expands by more: DEFLATE's limit.
const LARGEST_RATIO: u64 = 1032;

/// Reads the arrays `tetrahedra` and, where there is one, `neighbors`.
///
/// # Errors
///
/// When the archive or an array is broken, or `tetrahedra` is missing.
pub fn read_npz(bytes: &[u8]) -> Result<MeshData, FormatError> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| FormatError::byte(0, error.to_string()))?;
    let Some(tetrahedra) = read_indices(&mut archive, "tetrahedra", 0..=u32::MAX.into())? else {
        return Err(FormatError::byte(0, "the archive has no array `tetrahedra`"));
    };
    let neighbors = read_indices(&mut archive, "neighbors", -1..=i32::MAX.into())?;
    Ok(MeshData {
        tetrahedra: tetrahedra.into_iter().map(|t| t.map(|v| v as u32)).collect(),
        neighbors: neighbors.map(|rows| rows.into_iter().map(|n| n.map(|t| t as i32)).collect()),
    })
}

fn read_indices(
    archive: &mut ZipArchive<Cursor<&[u8]>>,
    name: &str,
    range: std::ops::RangeInclusive<i64>,
) -> Result<Option<Vec<[i64; 4]>>, FormatError> {
    let in_array = |what: String| FormatError::byte(0, format!("array `{name}`: {what}"));
    let member = match archive.by_name(&format!("{name}.npy")) {
        Ok(member) => member,
        Err(ZipError::FileNotFound) => return Ok(None),
        Err(error) => return Err(in_array(error.to_string())),
    };
    let limit = member.compressed_size().saturating_mul(LARGEST_RATIO);
    let mut array = Vec::new();
    member.take(limit).read_to_end(&mut array).map_err(|error| in_array(error.to_string()))?;
    let rows = Array::parse(&array).and_then(|array| array.indices()).map_err(|error| in_array(error.to_string()))?;
    match rows.as_flattened().iter().find(|index| !range.contains(index)) {
        Some(index) => Err(in_array(format!("{index} is no index"))),
        None => Ok(Some(rows)),
    }
}

/// Writes `points` (f4 or f8, n × 3), `tetrahedra` (u4, m × 4) and `neighbors` (i4, m × 4), uncompressed as
/// `numpy.savez` does.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_npz<W: Write>(to: W, points: Points<'_>, mesh: &Mesh3) -> io::Result<()> {
    let mut archive = ZipWriter::new_stream(to);
    // 64-bit sizes, so that no mesh is too large, and no date, so that equal meshes make equal files.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .large_file(true)
        .last_modified_time(zip::DateTime::default());
    archive.start_file("points.npy", options)?;
    npy::write(&mut archive, points)?;
    archive.start_file("tetrahedra.npy", options)?;
    npy::write_array(&mut archive, "<u4", &mesh.tetrahedra, u32::to_le_bytes)?;
    archive.start_file("neighbors.npy", options)?;
    npy::write_array(&mut archive, "<i4", &mesh.neighbors, i32::to_le_bytes)?;
    archive.finish()?.into_inner().flush()
}
