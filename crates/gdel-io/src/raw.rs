//! Bare little-endian coordinates: x, y, z, x, y, z, …

use crate::{FormatError, PointBuf, PointCloud, surface::padded};
use gdel::Points;
use std::io::{self, Write};

pub(super) fn read_f32(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    PointCloud::new(PointBuf::F32(triples(bytes, f32::from_le_bytes)?))
}

pub(super) fn read_f64(bytes: &[u8]) -> Result<PointCloud, FormatError> {
    PointCloud::new(PointBuf::F64(triples(bytes, f64::from_le_bytes)?))
}

fn triples<const N: usize, T>(bytes: &[u8], decode: fn([u8; N]) -> T) -> Result<Vec<[T; 3]>, FormatError> {
    let (numbers, _) = bytes.as_chunks::<N>();
    let (points, _) = numbers.as_chunks::<3>();
    let used = points.len() * 3 * N;
    if used < bytes.len() {
        let what =
            format!("the file ends within a point: a point has {} bytes, {} are left", 3 * N, bytes.len() - used);
        return Err(FormatError::byte(used, what));
    }
    Ok(points.iter().map(|p| p.map(decode)).collect())
}

/// Writes single precision, to which double precision is rounded.
pub(super) fn write_f32<const D: usize>(mut to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    points.iter().flat_map(padded).try_for_each(|x| to.write_all(&(x as f32).to_le_bytes()))
}

pub(super) fn write_f64<const D: usize>(mut to: impl Write, points: Points<'_, D>) -> io::Result<()> {
    points.iter().flat_map(padded).try_for_each(|x| to.write_all(&x.to_le_bytes()))
}
