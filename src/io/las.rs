//! ASPRS LAS and LAZ, by the crates `las` and `laz`.
//!
//! The crates allocate what a broken file says, and panic on some. So what a file says is checked
//! here before they see it, and a panic is taken for what it is: a broken file.

use crate::io::{FormatError, PointBuf, PointCloud};
use las::raw;
use laz::{LasZipError, LazItemType, LazVlr};
use std::{
    cell::Cell,
    io::{self, Cursor},
    panic::{AssertUnwindSafe, catch_unwind},
};

thread_local! {
    static PANICS_ARE_CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// Returns whether this thread runs a decoder whose panics become errors. A program's panic hook
/// asks this to know when to be silent.
pub fn panics_are_caught() -> bool {
    PANICS_ARE_CAUGHT.get()
}

/// The extended variable-length records' place and number, in the header of LAS 1.4.
const EVLR: std::ops::Range<usize> = 235..247;

/// Points decoded at a time.
const BATCH: u64 = 1 << 14;

pub(super) fn read(mut bytes: Vec<u8>) -> Result<PointCloud, FormatError> {
    let size = bytes.len();
    let header = raw::Header::read_from(bytes.as_slice()).map_err(|error| in_header(&error, size))?;
    check_size(&header, bytes.len())?;
    if header.evlr.is_some() {
        // Nothing in these is about coordinates, and the crate allocates what they say.
        bytes[EVLR].fill(0);
    }
    PANICS_ARE_CAUGHT.set(true);
    let result = catch_unwind(AssertUnwindSafe(|| decode(bytes)));
    PANICS_ARE_CAUGHT.set(false);
    result.unwrap_or_else(|_| {
        Err(FormatError::byte(header.offset_to_point_data as usize, "the compressed data is broken"))
    })
}

/// Checks the header's counts against the file's size.
fn check_size(header: &raw::Header, size: usize) -> Result<(), FormatError> {
    let points = point_count(header);
    let is_compressed = header.point_data_record_format & 0xc0 != 0;
    let data = (size as u64).checked_sub(header.offset_to_point_data.into());
    let promised = points.checked_mul(header.point_data_record_length.into());
    match (data, promised) {
        (None, _) => Err(FormatError::byte(size, "the file ends before its points")),
        // A mesh cannot name more points than this, and the product cannot overflow in what
        // follows.
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

fn decode(bytes: Vec<u8>) -> Result<PointCloud, FormatError> {
    let size = bytes.len();
    let header = las::Header::new(Cursor::new(bytes.as_slice())).map_err(|error| in_header(&error, size))?;
    if header.point_format().is_compressed {
        let start = raw::Header::read_from(bytes.as_slice()).map_err(|error| in_header(&error, size))?;
        let vlr = header.laz_vlr().map_err(|error| in_header(&error, size))?;
        check_laz(&bytes, start.offset_to_point_data as usize, &vlr, header.point_format().len())?;
    }
    let mut reader = las::Reader::new(Cursor::new(bytes)).map_err(|error| in_header(&error, size))?;
    let mut points = Vec::new();
    let mut batch = reader.read_points(0).map_err(|error| in_points(&error, 0, size))?;
    while (points.len() as u64) < header.number_of_points() {
        reader.fill_points(BATCH, &mut batch).map_err(|error| in_points(&error, points.len(), size))?;
        points.extend(batch.x().zip(batch.y()).zip(batch.z()).map(|((x, y), z)| [x, y, z]));
    }
    PointCloud::new(PointBuf::F64(points))
}

/// Describes an error of the crate in what goes before the points, in a file of `size` bytes.
fn in_header(error: &las::Error, size: usize) -> FormatError {
    if is_end(error) {
        return FormatError::byte(size, "the file ends within its header: it is truncated");
    }
    FormatError::byte(0, format!("not a LAS or LAZ file that can be read: {error}"))
}

/// Describes an error of the crate after the first `read` points.
fn in_points(error: &las::Error, read: usize, size: usize) -> FormatError {
    if is_end(error) {
        let what = format!("the file ends within its compressed points: it is truncated after about {read} of them");
        return FormatError::byte(size, what);
    }
    FormatError::point(read, format!("the compressed data is broken: {error}"))
}

/// Returns whether an error of the crate is that the file has ended.
fn is_end(error: &las::Error) -> bool {
    match error {
        las::Error::Io(error) | las::Error::LasZipError(LasZipError::IoError(error)) => {
            error.kind() == io::ErrorKind::UnexpectedEof
        }
        _ => false,
    }
}

/// Checks what the decompressor of LAZ would allocate: its table of chunks, and in each chunk the
/// layers of the point formats from 6 on. `start` is the byte where the chunks begin, after the
/// eight bytes that say where their table is.
fn check_laz(bytes: &[u8], start: usize, vlr: &LazVlr, record: u16) -> Result<(), FormatError> {
    if vlr.items_size() != u64::from(record) {
        let what = format!("points of {record} bytes cannot be made of items of {} bytes", vlr.items_size());
        return Err(FormatError::byte(start, what));
    }
    let i64_at = |at: usize| Some(i64::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    let u32_at = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize);
    // A writer that could not seek left the table's place at the end of the file.
    let table = [Some(start), bytes.len().checked_sub(8)].into_iter().flatten().filter_map(i64_at);
    let table = table.filter_map(|place| usize::try_from(place).ok()).find(|&place| place > start);
    let chunks = table.and_then(|place| u32_at(place + 4)).unwrap_or(0);
    if chunks > bytes.len() {
        return Err(FormatError::byte(table.unwrap_or(0), format!("the file is too short for {chunks} chunks")));
    }
    let layers: usize = vlr
        .items()
        .iter()
        .map(|item| match item.item_type() {
            LazItemType::Point14 => 9,
            LazItemType::RGB14 | LazItemType::WavePacket14 => 1,
            LazItemType::RGBNIR14 => 2,
            LazItemType::Byte14(count) => count.into(),
            _ => 0,
        })
        .sum();
    if layers == 0 {
        return Ok(());
    }
    // Each chunk is its first point, the number of its points, the sizes of its layers, and the
    // layers.
    let end = table.map_or(bytes.len(), |place| place.min(bytes.len()));
    let mut at = start + 8;
    while at < end {
        let sizes = at + usize::from(record) + 4;
        let mut next = sizes + 4 * layers;
        for layer in 0..layers {
            next = u32_at(sizes + 4 * layer).and_then(|size| next.checked_add(size)).unwrap_or(usize::MAX);
        }
        if next > end {
            return Err(FormatError::byte(
                at,
                "the chunk of points that starts here goes on behind the end of the data",
            ));
        }
        at = next;
    }
    Ok(())
}
