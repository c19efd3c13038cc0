//! LAZ as other encoders write it: items of the first version, chunks of every kind, times that
//! need every symbol, and times that no encoder writes.

use crate::samples::{self, las_points};
use gdel_io::{FormatError, PointBuf, PointFormat, Position};
use laz::{
    LasZipCompressor, LazItemRecordBuilder, LazVlr, LazVlrBuilder,
    encoders::ArithmeticEncoder,
    las::{Point1, Point3, v2},
    models::{ArithmeticModel, ArithmeticModelBuilder},
    record::{FieldCompressor, RecordCompressor, SequentialPointRecordCompressor},
};
use rand::{RngExt, SeedableRng, seq::IndexedRandom};
use rand_pcg::Pcg64Mcg;
use std::io::{self, Cursor, Seek, SeekFrom, Write};

fn read(bytes: Vec<u8>) -> Result<Vec<[f64; 3]>, FormatError> {
    match PointFormat::Las.read(bytes)?.points {
        PointBuf::F64(points) => Ok(points),
        PointBuf::F32(_) => panic!("single precision where double was expected"),
    }
}

/// The place and the content of the record that describes the compression.
const VLR_START: usize = 375 + 54;
/// Where in it the kind of compressor stands.
const KIND: usize = VLR_START;

/// Returns the byte where the points of a file begin.
fn start(file: &[u8]) -> usize {
    u32::from_le_bytes(*file[96..].first_chunk().unwrap()) as usize
}

/// Returns the records of [`las_points`], uncompressed.
fn records(format: u8) -> Vec<u8> {
    let file = samples::las(format, false, 0);
    file[start(&file)..].to_vec()
}

/// Returns what goes before the points in LAZ whose compression `vlr` describes.
fn header(format: u8, vlr: &LazVlr) -> Vec<u8> {
    let mut file = samples::las(format, true, 0);
    file.truncate(start(&file));
    let mut described = Vec::new();
    vlr.write_to(&mut described).unwrap();
    assert_eq!(VLR_START + described.len(), file.len());
    file[VLR_START..].copy_from_slice(&described);
    file
}

/// Returns LAZ of the records, in chunks of the given numbers of points where their size varies.
fn compress(format: u8, vlr: LazVlr, records: &[u8], chunks: &[usize]) -> Vec<u8> {
    let size = vlr.items_size() as usize;
    let varies = vlr.uses_variable_size_chunks();
    let mut file = Cursor::new(header(format, &vlr));
    file.seek(SeekFrom::End(0)).unwrap();
    let mut compressor = LasZipCompressor::new(file, vlr).unwrap();
    let mut rest = records;
    for chunk in chunks {
        let (chunk, after) = rest.split_at(chunk * size);
        compressor.compress_many(chunk).unwrap();
        if varies && !after.is_empty() {
            compressor.finish_current_chunk().unwrap();
        }
        rest = after;
    }
    assert!(rest.is_empty());
    compressor.done().unwrap();
    compressor.into_inner().into_inner()
}

/// Replaces the GPS times of records: several sequences, most of which pass by multiples of a
/// difference, small and large, of both signs.
fn set_times(format: u8, records: &mut [u8], random: &mut Pcg64Mcg) {
    let at = if format < 6 { 20 } else { 22 };
    let size = records.len() / las_points().len();
    let mut sequences: Vec<i64> = (0..6).map(|i| i << 40).collect();
    let (mut s, mut multiple) = (0, 1_i64);
    for record in records.chunks_exact_mut(size) {
        match random.random_range(0..8) {
            0 => s = random.random_range(0..sequences.len()),
            1 => multiple = *[0, 1, 7, 80, 500, 10_000, -1, -9, -10, -600].choose(random).expect("ten"),
            2 => sequences[s] += i64::from(*[i32::MIN, i32::MAX].choose(random).expect("two")),
            3 => sequences[s] = i64::from(random.random::<i32>()) << 20,
            _ => {}
        }
        sequences[s] += 1000 * multiple + random.random_range(-200..200);
        record[at..at + 8].copy_from_slice(&sequences[s].to_le_bytes());
    }
}

#[test]
fn times_that_need_every_symbol() {
    for format in [1, 3, 6, 7, 8] {
        for seed in 0..20 {
            let mut records = records(format);
            set_times(format, &mut records, &mut Pcg64Mcg::seed_from_u64(seed));
            let items = LazItemRecordBuilder::default_for_point_format_id(format, 0).unwrap();
            let file = compress(format, LazVlr::from_laz_items(items), &records, &[300]);
            assert_eq!(read(file), Ok(las_points()), "format {format}, seed {seed}");
        }
    }
}

#[test]
fn items_of_every_version() {
    let versions = [
        (1, LazItemRecordBuilder::version_1_of::<Point1>(0)),
        (3, LazItemRecordBuilder::version_1_of::<Point3>(0)),
        (6, LazItemRecordBuilder::version_4_of::<laz::las::Point6>(0)),
        (7, LazItemRecordBuilder::version_4_of::<laz::las::Point7>(0)),
        (8, LazItemRecordBuilder::version_4_of::<laz::las::Point8>(0)),
    ];
    for (format, items) in versions {
        let mut records = records(format);
        set_times(format, &mut records, &mut Pcg64Mcg::seed_from_u64(0));
        let file = compress(format, LazVlr::from_laz_items(items), &records, &[300]);
        assert_eq!(read(file), Ok(las_points()), "format {format}");
    }
}

#[test]
fn chunks_of_every_kind() {
    for format in [0, 1, 3, 6, 7] {
        let records = records(format);
        let vlr = || LazVlrBuilder::default().with_point_format(format, 0).unwrap();
        for size in [1, 7, 299, 300, 1000] {
            let file = compress(format, vlr().with_fixed_chunk_size(size).build(), &records, &[300]);
            assert_eq!(read(file), Ok(las_points()), "format {format}, chunks of {size}");
        }
        let file = compress(format, vlr().with_variable_chunk_size().build(), &records, &[100, 1, 150, 49]);
        assert_eq!(read(file), Ok(las_points()), "format {format}, chunks of various sizes");
    }
}

/// As the first LASzip wrote it: one chunk, and no table of chunks.
#[test]
fn points_without_chunks() {
    let items = LazItemRecordBuilder::default_version_of::<Point1>(0);
    let mut file = compress(1, LazVlr::from_laz_items(items), &records(1), &[300]);
    let start = start(&file);
    let table = u64::from_le_bytes(*file[start..].first_chunk().unwrap()) as usize;
    file.truncate(table);
    file.drain(start..start + 8);
    file[KIND..KIND + 2].copy_from_slice(&1u16.to_le_bytes());
    assert_eq!(read(file), Ok(las_points()));
}

#[test]
fn variable_chunks_with_fewer_points_than_the_header_says() {
    let vlr = LazVlrBuilder::default().with_point_format(1, 0).unwrap().with_variable_chunk_size().build();
    let records = records(1);
    let file = compress(1, vlr, &records[..200 * 28], &[120, 80]);
    let error = read(file).unwrap_err();
    assert!(error.what.contains("end after 200 points"), "{error}");
}

#[test]
fn compressors_and_items_that_do_not_agree() {
    for (format, kinds) in [(1, [0, 3]), (6, [1, 2])] {
        for kind in kinds {
            let mut file = samples::las(format, true, 0);
            file[KIND] = kind;
            let error = read(file.clone()).unwrap_err();
            assert_eq!(error.at, Position::Byte(start(&file)));
            assert!(error.what.contains(&format!("compressor of kind {kind}")), "{error}");
        }
    }
}

/// Compresses each GPS time as switches to another sequence of times, and then the same time.
struct Switches {
    count: usize,
    symbols: ArithmeticModel,
}

impl<W: Write> FieldCompressor<W> for Switches {
    fn size_of_field(&self) -> usize {
        8
    }

    fn compress_first(&mut self, target: &mut W, time: &[u8]) -> io::Result<()> {
        target.write_all(time)
    }

    fn compress_with(&mut self, encoder: &mut ArithmeticEncoder<W>, _time: &[u8]) -> io::Result<()> {
        for _ in 0..self.count {
            encoder.encode_symbol(&mut self.symbols, 3)?;
        }
        encoder.encode_symbol(&mut self.symbols, 0)
    }
}

/// Returns LAZ of format 1 whose times come after so many switches between sequences.
fn switches(count: usize) -> Vec<u8> {
    let mut file = header(1, &LazVlr::from_laz_items(LazItemRecordBuilder::default_version_of::<Point1>(0)));
    let mut compressor = SequentialPointRecordCompressor::new(Vec::new());
    compressor.add_field_compressor(v2::LasPoint0Compressor::default());
    let symbols = ArithmeticModelBuilder::new(6).with_compression(true).build();
    compressor.add_field_compressor(Switches { count, symbols });
    for record in records(1).chunks_exact(28) {
        compressor.compress_next(record).unwrap();
    }
    compressor.done().unwrap();
    let data = compressor.into_inner();
    // A table of no chunks.
    file.extend((file.len() as u64 + 8 + data.len() as u64).to_le_bytes());
    file.extend(data);
    file.extend([0; 8]);
    file
}

#[test]
fn switches_that_an_encoder_may_write() {
    for count in 0..=3 {
        assert_eq!(read(switches(count)), Ok(las_points()), "{count} switches");
    }
}

/// The crate's decompressor calls itself for each, until the stack overflows.
#[test]
fn a_million_switches_between_sequences_of_times() {
    for count in [4, 1_000_000] {
        let error = read(switches(count)).unwrap_err();
        assert_eq!(error.at, Position::Point(1));
        assert!(error.what.contains("switches between sequences"), "{error}");
    }
}
