//! The compressed points of LAZ.
//!
//! The crate `laz` (0.13) decodes the items of a point. This module combines them to records and
//! chunks, because of one item: the crate follows a switch between sequences of GPS times by
//! recursion, and a broken file can have a million switches in a row, which would overflow the
//! stack. In formats that code all items in one stream, [`GpsTime`] replaces the crate's decoder.
//! In formats with a layer per item, only the layers of coordinates and colours are read.

use super::{gps_time::GpsTime, in_header, is_end};
use crate::FormatError;
use las::{Header, laz::is_laszip_vlr};
use laz::{
    DecompressionSelection, LasZipError, LazItem, LazItemRecordBuilder, LazItemType, LazVlr,
    las::{v1, v2},
    laszip::{ChunkTable, CompressorType},
    record::{LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor},
};
use std::{
    io::{self, Cursor},
    iter,
};

/// Decodes all points of a file, which begin at the byte `start`, and hands their records to `add`.
pub(super) fn decode(
    bytes: &[u8],
    start: usize,
    header: &Header,
    mut add: impl FnMut(&[u8]),
) -> Result<(), FormatError> {
    let size = bytes.len();
    let vlr = header.vlrs().iter().find(|vlr| is_laszip_vlr(vlr));
    let vlr = vlr.ok_or_else(|| in_header(las::Error::LasZipVlrNotFound, size))?;
    // The crate does not tell which kind of compressor it has read.
    let compressor = vlr.data.first_chunk().map_or(0, |kind| u16::from_le_bytes(*kind));
    let vlr = LazVlr::from_buffer(&vlr.data).map_err(|error| in_header(error, size))?;
    check_items(vlr.items(), compressor, start, header.point_format().len())?;
    let mut source = Cursor::new(bytes);
    source.set_position(start as u64);
    let is_whole = compressor == CompressorType::PointWise as u16;
    let mut chunks = if is_whole { Box::new(iter::once(u64::MAX)) } else { chunks(&mut source, &vlr)? };

    let mut read = 0;
    let mut record = vec![0; header.point_format().len().into()];
    while (read as u64) < header.number_of_points() {
        let at = source.position() as usize;
        let count = chunks
            .next()
            .ok_or_else(|| FormatError::byte(at, format!("the chunks of points end after {read} points")))?;
        check_chunk(bytes, at, record.len(), layers(vlr.items()))?;
        let mut decompressor = decompressor(vlr.items(), &mut source).map_err(|error| in_header(error, size))?;
        let left = header.number_of_points() - read as u64;
        for _ in 0..count.min(left) {
            decompressor.decompress_next(&mut record).map_err(|error| in_points(&error, read, size))?;
            add(&record);
            read += 1;
        }
    }
    Ok(())
}

/// Checks that the items make a record, whatever sizes the file gives them, and that the first item
/// has coordinates and suits the kind of compressor.
fn check_items(items: &[LazItem], compressor: u16, start: usize, record: u16) -> Result<(), FormatError> {
    const ONE_STREAM: [u16; 2] = [CompressorType::PointWise as u16, CompressorType::PointWiseChunked as u16];
    const LAYERS: u16 = CompressorType::LayeredChunked as u16;
    let mut exact = LazItemRecordBuilder::new();
    for item in items {
        exact.add_item(item.item_type());
    }
    let size: u64 = exact.build().iter().map(|item| u64::from(item.size())).sum();
    if size != u64::from(record) {
        let what = format!("points of {record} bytes cannot be made of items of {size} bytes");
        return Err(FormatError::byte(start, what));
    }
    match items.first().map(LazItem::item_type) {
        Some(LazItemType::Point10) if ONE_STREAM.contains(&compressor) => Ok(()),
        Some(LazItemType::Point14) if compressor == LAYERS => Ok(()),
        _ => Err(FormatError::byte(start, format!("points that a compressor of kind {compressor} cannot have"))),
    }
}

/// Returns the number of points of each chunk, never zero, and moves `source` to the first chunk.
fn chunks(source: &mut Cursor<&[u8]>, vlr: &LazVlr) -> Result<Box<dyn Iterator<Item = u64>>, FormatError> {
    let start = source.position();
    check_table(source.get_ref(), start as usize)?;
    if vlr.uses_variable_size_chunks() {
        let table =
            ChunkTable::read_from(&mut *source, vlr).map_err(|error| in_header(error, source.get_ref().len()))?;
        let counts: Vec<u64> =
            table.as_ref().iter().map(|chunk| chunk.point_count).filter(|&count| count > 0).collect();
        return Ok(Box::new(counts.into_iter()));
    }
    source.set_position(start + ChunkTable::OFFSET_SIZE as u64);
    // As in LASzip, a chunk size of zero means one chunk with all points.
    Ok(Box::new(iter::repeat(if vlr.chunk_size() == 0 { u64::MAX } else { vlr.chunk_size().into() })))
}

/// Checks the number of chunks in their table, for which the crate allocates memory. The offset of
/// the table is at the byte `start`.
fn check_table(bytes: &[u8], start: usize) -> Result<(), FormatError> {
    let i64_at = |at: usize| Some(i64::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    // A writer that could not seek has put the table's offset at the end of the file.
    let places = [Some(start), bytes.len().checked_sub(8)].into_iter().flatten().filter_map(i64_at);
    let place = places.filter_map(|place| usize::try_from(place).ok()).find(|&place| place > start);
    match place.and_then(|place| Some((place, u32_at(bytes, place.checked_add(4)?)?))) {
        Some((place, chunks)) if chunks > bytes.len() => {
            Err(FormatError::byte(place, format!("the file is too short for {chunks} chunks")))
        }
        _ => Ok(()),
    }
}

/// Returns how many layers a chunk has: none where all items are in one stream.
fn layers(items: &[LazItem]) -> usize {
    let layers = items.iter().map(|item| match item.item_type() {
        LazItemType::Point14 => 9,
        LazItemType::RGB14 | LazItemType::WavePacket14 => 1,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(count) => count.into(),
        _ => 0,
    });
    layers.sum()
}

/// Checks that the file holds the chunk at a byte: its first point and, where it has layers, the
/// number of its points, the layers' sizes, and the layers, for which the crate allocates memory.
fn check_chunk(bytes: &[u8], at: usize, record: usize, layers: usize) -> Result<(), FormatError> {
    let mut end = at.saturating_add(record);
    if layers > 0 {
        let sizes = end.saturating_add(4);
        end = sizes.saturating_add(4 * layers);
        for layer in 0..layers {
            end = u32_at(bytes, sizes + 4 * layer).map_or(usize::MAX, |size| end.saturating_add(size));
        }
    }
    match end <= bytes.len() {
        true => Ok(()),
        false => {
            Err(FormatError::byte(at, "the file ends within the chunk of points that starts here: it is truncated"))
        }
    }
}

/// Returns the number in the four bytes at `at`, where the file has so many.
fn u32_at(bytes: &[u8], at: usize) -> Option<usize> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize)
}

type Source<'a, 'b> = &'a mut Cursor<&'b [u8]>;

/// Returns the decompressor of a chunk's records.
fn decompressor<'a, 'b: 'a>(
    items: &Vec<LazItem>,
    source: Source<'a, 'b>,
) -> Result<Box<dyn RecordDecompressor<Source<'a, 'b>> + 'a>, LasZipError> {
    if layers(items) > 0 {
        let mut record = LayeredPointRecordDecompressor::new(source);
        record.set_fields_from(items)?;
        record.set_selection(selection());
        return Ok(Box::new(record));
    }
    let mut record = SequentialPointRecordDecompressor::new(source);
    for item in items {
        match (item.item_type(), item.version()) {
            (LazItemType::Point10, 1) => record.add_field_decompressor(v1::LasPoint0Decompressor::default()),
            (LazItemType::Point10, 2) => record.add_field_decompressor(v2::LasPoint0Decompressor::default()),
            (LazItemType::GpsTime, 1) => record.add_field_decompressor(v1::LasGpsTimeDecompressor::default()),
            (LazItemType::GpsTime, 2) => record.add_field_decompressor(GpsTime::default()),
            (LazItemType::RGB12, 1) => record.add_field_decompressor(v1::LasRGBDecompressor::default()),
            (LazItemType::RGB12, 2) => record.add_field_decompressor(v2::LasRGBDecompressor::default()),
            // The second version did not change the wave packets.
            (LazItemType::WavePacket13, 1 | 2) => {
                record.add_field_decompressor(v1::LasWavepacketDecompressor::default());
            }
            (LazItemType::Byte(count), 1) => {
                record.add_field_decompressor(v1::LasExtraByteDecompressor::new(count.into()));
            }
            (LazItemType::Byte(count), 2) => {
                record.add_field_decompressor(v2::LasExtraByteDecompressor::new(count.into()));
            }
            (item, version) => return Err(LasZipError::UnsupportedLazItemVersion(item, version)),
        }
    }
    Ok(Box::new(record))
}

/// Returns the layers that are read: those of coordinates and colours.
fn selection() -> DecompressionSelection {
    DecompressionSelection::xy_returns_channel().decompress_z().decompress_intensity().decompress_rgb()
}

/// Describes an error of the decompressor after the first `read` points, in a file of `size` bytes.
fn in_points(error: &io::Error, read: usize, size: usize) -> FormatError {
    if is_end(error) {
        let what = format!("the file ends within its compressed points: it is truncated after about {read} of them");
        return FormatError::byte(size, what);
    }
    FormatError::point(read, format!("the compressed data is broken: {error}"))
}
