//! ASPRS LAS and LAZ, by the crates `las` and `laz`.
//!
//! The crates allocate what a broken file promises, and panic on some broken files. So sizes are
//! checked here first, and a panic becomes an error. A stack overflow cannot be caught, so the
//! decoder of GPS times that recurses is not used (`laz` 0.13).

mod gps_time;
mod laz;
#[cfg(not(target_arch = "wasm32"))]
mod pieces;

#[cfg(not(target_arch = "wasm32"))]
pub(super) use pieces::{Records, read_in_pieces};

use crate::{
    FormatError, PointBuf, PointCloud,
    colors::{CHANNELS, Colors, INTENSITY, Range},
};
use ::las::{Header, point::Format, raw};
use ::laz::LasZipError;
use std::{
    cell::Cell,
    io::{self, Cursor},
    panic::{AssertUnwindSafe, catch_unwind},
};

thread_local! {
    static PANICS_ARE_CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// Returns whether this thread runs a decoder whose panics become errors. A program's panic hook
/// prints nothing then.
pub fn panics_are_caught() -> bool {
    PANICS_ARE_CAUGHT.get()
}

/// The extended variable-length records' place and number, in the header of LAS 1.4.
const EVLR: std::ops::Range<usize> = 235..247;

pub(super) fn read(mut bytes: Vec<u8>) -> Result<PointCloud, FormatError> {
    let start = prepare(&mut bytes)?;
    guarded(start, || decode(&bytes, start))
}

/// Checks the sizes in a file. Returns the byte at which the points begin.
fn prepare(bytes: &mut [u8]) -> Result<usize, FormatError> {
    let size = bytes.len();
    let header = raw::Header::read_from(&*bytes).map_err(|error| in_header(error, size))?;
    check_size(&header, size)?;
    if header.evlr.is_some() {
        // These records have nothing about coordinates, and the crate allocates the size that they
        // promise.
        bytes[EVLR].fill(0);
    }
    Ok(header.offset_to_point_data as usize)
}

/// Runs a decoder, whose panics become errors.
fn guarded<T>(start: usize, decode: impl FnOnce() -> Result<T, FormatError>) -> Result<T, FormatError> {
    PANICS_ARE_CAUGHT.set(true);
    let result = catch_unwind(AssertUnwindSafe(decode));
    PANICS_ARE_CAUGHT.set(false);
    result.unwrap_or_else(|_| Err(FormatError::byte(start, "the compressed data is broken")))
}

/// Compares the header's counts with the file's size.
fn check_size(header: &raw::Header, size: usize) -> Result<(), FormatError> {
    let points = point_count(header);
    let is_compressed = header.point_data_record_format & 0xc0 != 0;
    let data = (size as u64).checked_sub(header.offset_to_point_data.into());
    let promised = points.checked_mul(header.point_data_record_length.into());
    match (data, promised) {
        (None, _) => Err(FormatError::byte(size, "the file ends before its points")),
        // A mesh has no indices for more points, and later products cannot overflow.
        (_, promised) if points > u32::MAX.into() || promised.is_none() => {
            Err(FormatError::byte(0, format!("{points} points are too many")))
        }
        (Some(data), Some(promised)) if !is_compressed && promised > data => {
            Err(FormatError::byte(size, format!("the file ends here, but its header promises {points} points")))
        }
        _ => Ok(()),
    }
}

fn point_count(header: &raw::Header) -> u64 {
    match (header.number_of_point_records, &header.large_file) {
        (0, Some(large)) => large.number_of_point_records,
        (count, _) => count.into(),
    }
}

/// How the coordinates of records become those of points.
struct Axes(::las::Vector<::las::Transform>);

impl Axes {
    /// Returns the point of a record: every format's begins with the three coordinates.
    fn point(&self, record: &[u8]) -> [f64; 3] {
        let [x, y, z] = [0, 4, 8].map(|at| i32::from_le_bytes(*record[at..].first_chunk().expect("20 bytes or more")));
        [self.0.x.direct(x), self.0.y.direct(y), self.0.z.direct(z)]
    }
}

/// Hands the records of all points, which begin at the byte `start`, to `add`.
fn records(bytes: &[u8], start: usize, mut add: impl FnMut(&Axes, &[u8])) -> Result<(), FormatError> {
    let header = Header::new(Cursor::new(bytes)).map_err(|error| in_header(error, bytes.len()))?;
    let axes = Axes(*header.transforms());
    if header.point_format().is_compressed {
        return laz::decode(bytes, start, &header, |record| add(&axes, record));
    }
    let records = bytes[start..].chunks_exact(header.point_format().len().into());
    records.take(header.number_of_points() as usize).for_each(|record| add(&axes, record));
    Ok(())
}

/// Reads the points, which begin at the byte `start`.
fn decode(bytes: &[u8], start: usize) -> Result<PointCloud, FormatError> {
    let header = Header::new(Cursor::new(bytes)).map_err(|error| in_header(error, bytes.len()))?;
    let rgb = rgb_at(header.point_format());
    let mut points = Vec::new();
    let has = std::array::from_fn(|channel| channel == INTENSITY || channel < 3 && rgb.is_some());
    let mut colors = Colors::new(has, Range::Words);
    let mut sample = [f64::NAN; CHANNELS];
    records(bytes, start, |axes, record| {
        points.push(axes.point(record));
        let word =
            |at: usize| record.get(at..at + 2).map_or(0.0, |word| f64::from(u16::from_le_bytes([word[0], word[1]])));
        // Every format has the intensity after the coordinates.
        sample[INTENSITY] = word(12);
        if let Some(rgb) = rgb {
            for (k, x) in sample[..3].iter_mut().enumerate() {
                *x = word(rgb + 2 * k);
            }
        }
        colors.push(&sample);
    })?;
    Ok(PointCloud::new(PointBuf::F64(points))?.colored(colors))
}

/// Returns the byte of a point's record at which red, green and blue begin, if it has them.
fn rgb_at(format: &Format) -> Option<usize> {
    let before = match (format.is_extended, format.has_gps_time) {
        (true, _) => 30,
        (false, true) => 28,
        (false, false) => 20,
    };
    format.has_color.then_some(before)
}

/// Describes an error of the crates before the points, in a file of `size` bytes.
fn in_header(error: impl Into<::las::Error>, size: usize) -> FormatError {
    match error.into() {
        ::las::Error::Io(error) | ::las::Error::LasZipError(LasZipError::IoError(error)) if is_end(&error) => {
            FormatError::byte(size, "the file ends within its header: it is truncated")
        }
        error => FormatError::byte(0, format!("not a LAS or LAZ file that can be read: {error}")),
    }
}

/// Returns whether an error is that the file has ended.
fn is_end(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::UnexpectedEof
}
