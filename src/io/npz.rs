//! NumPy's `.npz`: a ZIP archive of arrays.

use crate::io::{
    FormatError, MeshData, MeshData2,
    npy::{self, Array},
};
use crate::{Mesh2, Mesh3, Points, Points2};
use std::io::{self, Cursor, Read, Write};
use zip::{
    CompressionMethod, ZipArchive, ZipWriter,
    result::ZipError,
    write::{SimpleFileOptions, StreamWriter},
};

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

fn read_indices<const N: usize>(
    archive: &mut ZipArchive<Cursor<&[u8]>>,
    name: &str,
    range: std::ops::RangeInclusive<i64>,
) -> Result<Option<Vec<[i64; N]>>, FormatError> {
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
    write_arrays(to, |archive| {
        archive.array("points")?;
        npy::write(&mut archive.0, points)?;
        archive.array("tetrahedra")?;
        npy::write_array(&mut archive.0, "<u4", &mesh.tetrahedra, u32::to_le_bytes)?;
        archive.array("neighbors")?;
        npy::write_array(&mut archive.0, "<i4", &mesh.neighbors, i32::to_le_bytes)
    })
}

/// Writes `points` (f4 or f8, n × 2), `triangles` (u4, m × 3) and `halfedges` (i4, m × 3), as [`Mesh2`] has them.
///
/// # Errors
///
/// When `to` cannot be written.
pub fn write_npz2<W: Write>(to: W, points: Points2<'_>, mesh: &Mesh2) -> io::Result<()> {
    write_arrays(to, |archive| {
        archive.array("points")?;
        npy::write(&mut archive.0, points)?;
        archive.array("triangles")?;
        npy::write_array(&mut archive.0, "<u4", &mesh.triangles, u32::to_le_bytes)?;
        archive.array("halfedges")?;
        npy::write_array(&mut archive.0, "<i4", &mesh.halfedges, i32::to_le_bytes)
    })
}

/// Reads the arrays `triangles` and, where there is one, `halfedges`.
///
/// # Errors
///
/// When the archive or an array is broken, or `triangles` is missing.
pub fn read_npz2(bytes: &[u8]) -> Result<MeshData2, FormatError> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| FormatError::byte(0, error.to_string()))?;
    let Some(triangles) = read_indices(&mut archive, "triangles", 0..=u32::MAX.into())? else {
        return Err(FormatError::byte(0, "the archive has no array `triangles`"));
    };
    let halfedges = read_indices(&mut archive, "halfedges", -1..=i32::MAX.into())?;
    Ok(MeshData2 {
        triangles: triangles.into_iter().map(|t| t.map(|v| v as u32)).collect(),
        halfedges: halfedges.map(|rows| rows.into_iter().map(|h| h.map(|e| e as i32)).collect()),
    })
}

/// An archive that is being written.
struct Archive<W: Write>(ZipWriter<StreamWriter<W>>);

impl<W: Write> Archive<W> {
    /// Begins the array of that name.
    fn array(&mut self, name: &str) -> io::Result<()> {
        // 64-bit sizes, so that no mesh is too large, and no date, so that equal meshes make equal files.
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(true)
            .last_modified_time(zip::DateTime::default());
        self.0.start_file(format!("{name}.npy"), options).map_err(Into::into)
    }
}

fn write_arrays<W: Write>(to: W, write: impl FnOnce(&mut Archive<W>) -> io::Result<()>) -> io::Result<()> {
    let mut archive = Archive(ZipWriter::new_stream(to));
    write(&mut archive)?;
    archive.0.finish()?.into_inner().flush()
}
