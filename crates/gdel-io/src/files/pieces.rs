//! Point clouds that are read a few points at a time, since they may be larger than memory.

use super::{FileError, Input, InputFormat, read};
use crate::{FormatError, PointBuf, PointCloud, PointFormat, Position, las, npy, raw};
use std::{
    fs::File,
    io::{self, Read, Seek, SeekFrom},
    path::Path,
};

/// So many bytes hold the header of any file of a format that is read in pieces, except for the records of LAS.
const HEADER: u64 = 1 << 16;

/// How the points of a file lie in it, one after the other.
struct Layout<const D: usize> {
    offset: u64,
    /// Bytes of a point.
    stride: usize,
    count: u64,
    decode: Decode<D>,
}

/// Decodes the bytes of some points.
type Decode<const D: usize> = Box<dyn Fn(&[u8]) -> Result<PointCloud<D>, FormatError>>;

impl Input {
    /// Reads all points, at most `most` at a time, and hands each piece to `take`.
    ///
    /// LAS, `.npy` and raw files, whose points lie one after the other, are never in memory as a whole, and LAZ files only
    /// as they are compressed. Other files are read like [`Input::read`], in one piece.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Input::read`], and those of `take`.
    pub fn read_in_pieces<const D: usize, E: From<FileError>>(
        &self,
        most: usize,
        take: &mut dyn FnMut(PointBuf<D>) -> Result<(), E>,
    ) -> Result<(), E> {
        let path = self.path();
        let is_file = path.metadata().is_ok_and(|data| data.is_file() && data.len() > 0);
        if is_file && let InputFormat::Points(format) = self.format {
            if let Some((file, layout)) = layout::<D>(path, format)? {
                return read_rows(path, file, &layout, most, take);
            }
            if format == PointFormat::Las {
                return read_laz(path, most, take);
            }
        }
        take(self.read::<D>()?.points)
    }
}

/// Returns how the points of a file lie in it; `None` if they are not one after the other.
fn layout<const D: usize>(path: &Path, format: PointFormat) -> Result<Option<(File, Layout<D>)>, FileError> {
    if !matches!(format, PointFormat::RawF32 | PointFormat::RawF64 | PointFormat::Npy | PointFormat::Las) {
        return Ok(None);
    }
    let in_file = |source| FileError::Read { path: path.into(), source };
    let mut file = File::open(path).map_err(in_file)?;
    let size = file.metadata().map_err(in_file)?.len();
    let layout = match format {
        PointFormat::RawF32 => raw_layout(size, 12, raw::read_f32),
        PointFormat::RawF64 => raw_layout(size, 24, raw::read_f64),
        PointFormat::Npy => {
            let beginning = beginning(&mut file, HEADER).map_err(in_file)?;
            let rows = npy::Rows::new::<D>(&beginning, size);
            rows.map_err(|source| FileError::Format { path: path.into(), source })?.map(|rows| Layout {
                offset: rows.offset as u64,
                stride: rows.stride,
                count: rows.count as u64,
                decode: Box::new(move |bytes| rows.points(bytes)),
            })
        }
        _ => {
            let offset = las::Records::offset(&beginning(&mut file, HEADER).map_err(in_file)?);
            let mut before = beginning(&mut file, offset.unwrap_or(0) as u64).map_err(in_file)?;
            las::Records::new(&mut before, size).map(|records| Layout {
                offset: records.offset as u64,
                stride: records.stride,
                count: records.count,
                decode: Box::new(move |bytes| records.points(bytes).map(PointCloud::resize)),
            })
        }
    };
    Ok(layout.map(|layout| (file, layout)))
}

/// Returns the layout of a file of bare coordinates.
fn raw_layout<const D: usize>(
    size: u64,
    stride: usize,
    decode: fn(&[u8]) -> Result<PointCloud, FormatError>,
) -> Option<Layout<D>> {
    // A file that ends within a point is read as a whole, which says so.
    let is_whole = size.is_multiple_of(stride as u64);
    let decode = Box::new(move |bytes: &[u8]| decode(bytes).map(PointCloud::resize));
    is_whole.then(|| Layout { offset: 0, stride, count: size / stride as u64, decode })
}

/// Reads at most so many bytes from the beginning of a file.
fn beginning(file: &mut File, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn read_rows<const D: usize, E: From<FileError>>(
    path: &Path,
    mut file: File,
    layout: &Layout<D>,
    most: usize,
    take: &mut dyn FnMut(PointBuf<D>) -> Result<(), E>,
) -> Result<(), E> {
    let in_file = |source| FileError::Read { path: path.into(), source };
    file.seek(SeekFrom::Start(layout.offset)).map_err(in_file)?;
    let mut done = 0;
    while done < layout.count {
        let rows = (layout.count - done).min(most as u64);
        let mut bytes = vec![0; rows as usize * layout.stride];
        file.read_exact(&mut bytes).map_err(in_file)?;
        let points = (layout.decode)(&bytes);
        take(points.map_err(|source| FileError::Format { path: path.into(), source: after(source, done) })?.points)?;
        done += rows;
    }
    Ok(())
}

/// Moves the position of an error in a piece to that in the file.
fn after(error: FormatError, points: u64) -> FormatError {
    match error.at {
        Position::Point(n) => FormatError::point(n + points as usize, error.what),
        _ => error,
    }
}

fn read_laz<const D: usize, E: From<FileError>>(
    path: &Path,
    most: usize,
    take: &mut dyn FnMut(PointBuf<D>) -> Result<(), E>,
) -> Result<(), E> {
    let mut result = Ok(());
    let mut done = 0;
    let whole = las::read_in_pieces(read(path)?, most, &mut |points| {
        let count = points.len() as u64;
        let points = PointCloud::new(points).map(|cloud| cloud.resize().points);
        let points = points.map_err(|error| FileError::Format { path: path.into(), source: after(error, done) });
        done += count;
        result = points.map_err(E::from).and_then(&mut *take);
        result.is_ok()
    });
    result?;
    Ok(whole.map_err(|source| FileError::Format { path: path.into(), source })?)
}
