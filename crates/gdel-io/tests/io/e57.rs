//! E57: scans of every kind as one cloud, files as other programs write them, and those that are
//! broken on purpose behind valid checksums.

use crate::samples::{self, POINTS, Scan, columns, e57, e57_scaled, e57_single, e57_spherical, points_f64};
use ::e57::{Record, RecordDataType, RecordName, RecordValue};
use gdel_io::{FormatError, PointBuf, PointCloud, PointFormat, Position};

fn read(bytes: Vec<u8>) -> Result<PointCloud, FormatError> {
    PointFormat::E57.read(bytes)
}

/// Reads points in double precision, and how many others have no return.
fn read_f64(bytes: Vec<u8>) -> (Vec<[f64; 3]>, usize) {
    let cloud = read(bytes).expect("a valid file");
    match cloud.points {
        PointBuf::F64(points) => (points, cloud.no_return),
        PointBuf::F32(_) => panic!("single precision where double was expected"),
    }
}

fn read_f32(bytes: Vec<u8>) -> Vec<[f32; 3]> {
    match read(bytes).expect("a valid file").points {
        PointBuf::F32(points) => points,
        PointBuf::F64(_) => panic!("double precision where single was expected"),
    }
}

#[track_caller]
fn fails(bytes: Vec<u8>, at: Position, what: &str) {
    let error = read(bytes).expect_err("an error");
    assert_eq!(error.at, at, "{error}");
    assert!(error.what.contains(what), "{error}");
}

fn double(points: &[[f64; 3]]) -> Scan {
    let columns = vec![Record::CARTESIAN_X_F64, Record::CARTESIAN_Y_F64, Record::CARTESIAN_Z_F64];
    Scan { columns, rows: points.iter().map(|p| p.map(RecordValue::Double).to_vec()).collect(), pose: None }
}

#[test]
fn single_precision_stays() {
    assert_eq!(read_f32(e57(&[e57_single(&POINTS)])), POINTS);
    let identity = Scan { pose: Some(([0.0, 0.0, 0.0, 1.0], [0.0; 3])), ..e57_single(&POINTS) };
    let twice = read_f32(e57(&[identity, e57_single(&POINTS)]));
    assert_eq!(twice, [POINTS, POINTS].concat());
}

#[test]
fn one_scan_in_double_precision_makes_all_so() {
    let scans = [e57_single(&POINTS), e57_single(&[]), double(&[[0.1, 0.2, 0.3]])];
    let mut expected = points_f64();
    expected.push([0.1, 0.2, 0.3]);
    assert_eq!(read_f64(e57(&scans)), (expected, 0));
    let moved = Scan { pose: Some(([0.0, 0.0, 1.0, 0.0], [0.1, 0.0, 0.0])), ..e57_single(&[[1.0, 2.0, 3.0]]) };
    assert_eq!(read_f64(e57(&[moved])), (vec![[-0.9, -2.0, 3.0]], 0));
}

#[test]
fn scaled_integers_are_turned_and_moved_by_their_pose() {
    let point = |i: i32| [1.0 + 2.0 * f64::from(i), 2.0 + f64::from(i) / 8.0, 3.0 - f64::from(i)];
    let expected: Vec<_> = (0..300).filter(|i| i % 3 != 2).map(point).collect();
    assert_eq!(read_f64(e57(&[e57_scaled()])), (expected, 100));
}

#[test]
fn spherical_coordinates_become_cartesian() {
    let (points, no_return) = read_f64(e57(&[e57_spherical()]));
    assert_eq!((points.len(), no_return), (3, 1));
    for (point, expected) in points.iter().zip([[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, -4.0]]) {
        let off = (0..3).map(|k| (point[k] - expected[k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-15, "{point:?} is not {expected:?}");
    }
}

/// Where the Cartesian coordinates mean nothing, the spherical ones may.
#[test]
fn each_point_in_the_system_that_it_has() {
    use RecordName::*;
    let axes = [CartesianX, CartesianY, CartesianZ, SphericalRange, SphericalAzimuth, SphericalElevation];
    let mut columns = columns(axes, &RecordDataType::F64);
    columns.extend([Record::CARTESIAN_INVALID_STATE, Record::SPHERICAL_INVALID_STATE]);
    let row = |cartesian, spherical| {
        let numbers = [1.0, 2.0, 3.0, 5.0, 0.0, 0.0].map(RecordValue::Double);
        numbers.into_iter().chain([cartesian, spherical].map(RecordValue::Integer)).collect()
    };
    let rows = vec![row(0, 0), row(0, 2), row(1, 0), row(2, 0), row(2, 1), row(1, 2)];
    let expected = vec![[1.0, 2.0, 3.0], [1.0, 2.0, 3.0], [5.0, 0.0, 0.0], [5.0, 0.0, 0.0]];
    assert_eq!(read_f64(e57(&[Scan { columns, rows, pose: None }])), (expected, 2));
}

#[test]
fn columns_of_any_number_of_bits_over_many_packets() {
    use RecordName::*;
    for bits in [1, 3, 7, 8, 13, 31, 32, 33, 63] {
        let min = -(1i64 << (bits - 1));
        let data_type = RecordDataType::Integer { min, max: min + ((1u64 << bits) - 1) as i64 };
        let mut columns = columns([CartesianX, CartesianY, CartesianZ], &data_type);
        columns.push(Record { name: RowIndex, data_type: RecordDataType::Integer { min: 5, max: 5 } });
        let value = |n: i64| min + (n.wrapping_mul(0x9e37_79b9_7f4a_7c15u64 as i64) as u64 >> (64 - bits)) as i64;
        let points: Vec<[i64; 3]> = (0..60_000).map(|i| [0, 1, 2].map(|k| value(3 * i + k))).collect();
        let rows = points.iter().map(|p| p.iter().chain([&5]).map(|&x| RecordValue::Integer(x)).collect()).collect();
        let file = e57(&[Scan { columns, rows, pose: None }]);
        let expected = points.iter().map(|p| p.map(|x| x as f64)).collect();
        assert_eq!(read_f64(file), (expected, 0), "{bits} bits");
    }
}

/// Where a byte of the content is in a file whose pages of 1020 bytes have checksums.
fn physical(at: usize) -> usize {
    at + at / 1020 * 4
}

/// Puts a file together: the header, one section with packets at byte 48, and the XML, in pages.
fn file(packets: &[Vec<u8>], xml: &str) -> Vec<u8> {
    let packets = packets.concat();
    let xml_start = 80 + packets.len();
    let mut content = b"ASTM-E57".to_vec();
    let length = physical((xml_start + xml.len()).next_multiple_of(1020)) as u64;
    content.extend([1u32, 0].map(u32::to_le_bytes).concat());
    content.extend([length, physical(xml_start) as u64, xml.len() as u64, 1024].map(u64::to_le_bytes).concat());
    content.extend([1, 0, 0, 0, 0, 0, 0, 0]);
    content.extend([32 + packets.len() as u64, physical(80) as u64, 0].map(u64::to_le_bytes).concat());
    content.extend(packets);
    content.extend(xml.bytes());
    content.resize(content.len().next_multiple_of(1020), 0);
    let mut file: Vec<u8> = content.chunks(1020).flat_map(|page| page.iter().copied().chain([0; 4])).collect();
    samples::write_checksums(&mut file);
    file
}

/// Returns a packet with some bytes of each column.
fn packet(columns: &[&[u8]]) -> Vec<u8> {
    let length = (6 + 2 * columns.len() + columns.concat().len()).next_multiple_of(4);
    let mut packet = vec![1, 0];
    packet.extend(((length - 1) as u16).to_le_bytes());
    packet.extend((columns.len() as u16).to_le_bytes());
    columns.iter().for_each(|bytes| packet.extend((bytes.len() as u16).to_le_bytes()));
    packet.extend(columns.concat());
    packet.resize(length, 0);
    packet
}

/// Returns the XML of a file, whose scans are at byte 48.
fn xml(scans: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<e57Root type="Structure" xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0">
<formatName type="String"><![CDATA[ASTM E57 3D Imaging Data File]]></formatName>
<guid type="String"><![CDATA[file]]></guid>
<versionMajor type="Integer">1</versionMajor><versionMinor type="Integer">0</versionMinor>
<data3D type="Vector" allowHeterogeneousChildren="1">{scans}</data3D>
</e57Root>"#
    )
}

fn scan(records: u64, columns: &str) -> String {
    format!(
        r#"<vectorChild type="Structure"><guid type="String">scan</guid>
<points type="CompressedVector" fileOffset="48" recordCount="{records}">
<prototype type="Structure">{columns}</prototype></points></vectorChild>"#
    )
}

const DOUBLES: &str = r#"<cartesianX type="Float"/><cartesianY type="Float"/><cartesianZ type="Float"/>"#;

/// Packets may end anywhere, even within a number, and in each column elsewhere.
#[test]
fn packets_that_end_within_a_point() {
    let [x, y, z] = [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0f64]].map(|axis| axis.map(f64::to_le_bytes).concat());
    let packets = [
        packet(&[&x[..3], &y[..0], &z[..8]]),
        packet(&[&x[3..5], &y[..16], &z[8..]]),
        packet(&[&x[5..9], &[], &[]]),
        packet(&[&x[9..], &[], &[]]),
    ];
    let expected = vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    assert_eq!(read_f64(file(&packets, &xml(&scan(2, DOUBLES)))), (expected, 0));
}

#[test]
fn integers_of_all_bits() {
    let columns = r#"<cartesianX type="Integer"/><cartesianY type="Integer"/><cartesianZ type="Integer"/>"#;
    let stored = [0u64, 1 << 63, u64::MAX].map(u64::to_le_bytes);
    let packets = [packet(&[&stored[0], &stored[1], &stored[2]])];
    let expected = vec![[i64::MIN, 0, i64::MAX].map(|x| x as f64)];
    assert_eq!(read_f64(file(&packets, &xml(&scan(1, columns)))), (expected, 0));
}

/// Columns that other programs add: those of extensions, and states in floating point.
#[test]
fn columns_of_extensions() {
    let columns = format!(
        r#"<nor:normalX xmlns:nor="http://www.libe57.org/E57_NOR_surface_normals.txt" type="Float" precision="single"/>
{DOUBLES}<cartesianInvalidState type="Float"/>"#
    );
    let of = |numbers: [f64; 2]| numbers.map(f64::to_le_bytes).concat();
    let [x, y, z, state] = [of([1.0, 4.0]), of([2.0, 5.0]), of([3.0, 6.0]), of([0.0, 2.0])];
    let packets = [packet(&[&[0; 8], &x, &y, &z, &state])];
    assert_eq!(read_f64(file(&packets, &xml(&scan(2, &columns)))), (vec![[1.0, 2.0, 3.0]], 1));
}

#[test]
fn files_that_promise_more_than_they_hold() {
    let number = 1f64.to_le_bytes();
    let packets = [packet(&[&number[..]; 3])];
    let whole = file(&packets, &xml(&scan(1, DOUBLES)));
    let length = whole.len();
    assert_eq!(read(whole.clone()).map(|cloud| cloud.points.len()), Ok(1));
    // More than the bytes between the header and the XML, and more than those of the file.
    fails(file(&packets, &xml(&scan(2, DOUBLES))), Position::Point(1), "Found unknown packet ID");
    let many = file(&packets, &xml(&scan(u64::MAX, DOUBLES)));
    let at = Position::Byte(many.len());
    fails(many, at, "18446744073709551615 points");
    // Scans that share their points: each is within the file, all are not.
    let shared = file(&packets, &xml(&scan(1, DOUBLES).repeat(100)));
    assert_eq!(read(shared).map(|cloud| cloud.points.len()), Ok(100));
    let scans = xml(&scan(40, DOUBLES).repeat(100));
    let shared = file(&packets, &scans);
    let at = Position::Byte(shared.len());
    fails(shared, at, "4000 points");
    // 2⁴⁰ bytes of XML.
    let mut file = whole;
    file[37] = 1;
    samples::write_checksums(&mut file);
    fails(file, Position::Byte(length), "bytes of XML");
}

/// A column of one value takes no bits: a few bytes of another would become gigabytes of it.
#[test]
fn columns_without_bits() {
    let constant = |name: &str, value: i64| format!(r#"<{name} type="Integer" minimum="{value}" maximum="{value}"/>"#);
    let columns = [constant("cartesianX", 7), constant("cartesianY", -8)].concat();
    let axis = r#"<cartesianZ type="Integer" minimum="0" maximum="255"/>"#;
    let packets = [packet(&[&[], &[], &[1, 2, 3]])];
    let expected = [1.0, 2.0, 3.0].map(|z| [7.0, -8.0, z]).to_vec();
    assert_eq!(read_f64(file(&packets, &xml(&scan(3, &(columns.clone() + axis))))), (expected, 0));

    let flat = columns.clone() + &constant("cartesianZ", 0);
    fails(file(&packets, &xml(&scan(3, &flat))), Position::Byte(0), "points of 3 columns cannot be made of 0 bits");
    let many = columns + axis + &constant("rowIndex", 0).repeat(100);
    fails(file(&packets, &xml(&scan(3, &many))), Position::Byte(0), "points of 103 columns cannot be made of 8 bits");
}

#[test]
fn scans_that_make_no_sense() {
    let packets = [packet(&[&1f64.to_le_bytes()[..]; 3])];
    let of = |scan: &str| file(&packets, &xml(scan));
    let whole = scan(1, DOUBLES);
    fails(of(&scan(1, &DOUBLES.replace("cartesianZ", "timeStamp"))), Position::Point(0), "neither Cartesian nor");
    let numbers =
        |tags: &str| tags.split(' ').map(|tag| format!("<{tag} type=\"Float\">0</{tag}>")).collect::<String>();
    let rotation = format!("<rotation type=\"Structure\">{}</rotation>", numbers("w x y z"));
    let pose = format!("<pose type=\"Structure\">{rotation}</pose><points ");
    fails(of(&whole.replace("<points ", &pose)), Position::Point(0), "no rotation");
    let infinite = pose.replacen(">0<", ">inf<", 1);
    fails(of(&whole.replace("<points ", &infinite)), Position::Point(0), "no rotation");
    fails(of(&whole.replace("fileOffset=\"48\"", "fileOffset=\"999999\"")), Position::Point(0), "behind end of file");
    fails(of(&whole.replace("recordCount=\"1\"", "recordCount=\"-1\"")), Position::Byte(0), "recordCount");
    let nan = file(&[packet(&[&f64::NAN.to_le_bytes()[..]; 3])], &xml(&whole));
    fails(nan, Position::Point(0), "not a finite number");
}

#[test]
fn damage_is_found_by_checksums() {
    let whole = e57(&[e57_scaled()]);
    for at in (0..whole.len()).step_by(97) {
        let mut file = whole.clone();
        file[at] ^= 0x10;
        assert!(read(file).is_err(), "byte {at}");
    }
}

/// Neither elements in elements nor entities of entities take the stack or the memory.
#[test]
fn xml_of_attackers() {
    let deep = xml(&("<a>".repeat(300_000) + &"</a>".repeat(300_000)));
    assert_eq!(read(file(&[], &deep)).map(|cloud| cloud.points.len()), Ok(0));
    fails(file(&[], &"<a>".repeat(300_000)), Position::Byte(0), "XML");
    let laughs = r#"<!DOCTYPE a [<!ENTITY b "c"><!ENTITY d "&b;&b;&b;">]><a>&d;</a>"#;
    fails(file(&[], laughs), Position::Byte(0), "DTD");
    let long = xml(&scan(1, DOUBLES))
        .replace("<points ", &format!("<temperature type=\"Float\">{}</temperature><points ", "x".repeat(9999)));
    let error = read(file(&[], &long)).expect_err("a temperature");
    assert!(error.what.len() < 400, "{error}");
}

/// A file without scans, as some programs write it for images, is an empty cloud.
#[test]
fn no_scans() {
    assert_eq!(read(file(&[], &xml(""))).map(|cloud| cloud.points.len()), Ok(0));
    let empty = scan(0, DOUBLES);
    assert_eq!(read(file(&[], &xml(&empty))).map(|cloud| cloud.points.len()), Ok(0));
    fails(b"ASTM-E57".to_vec(), Position::Byte(8), "truncated");
    fails(vec![7; 2048], Position::Byte(0), "not an E57 file that can be read: Found unsupported signature");
}

/// All scans, in 2D without *z*.
#[test]
fn several_scans_in_2d() {
    let bytes = e57(&[e57_scaled(), e57_spherical()]);
    let cloud: PointCloud = read(bytes.clone()).expect("a valid file");
    assert_eq!((cloud.points.len(), cloud.no_return), (203, 101));
    let flat: PointCloud<2> = PointFormat::E57.read(bytes).expect("a valid file");
    assert_eq!((flat.points.len(), flat.no_return, flat.dropped_z), (203, 101, true));
}
