//! Every format of point clouds: what is read is what was written, in the file's precision.

use crate::samples::{self, POINTS, las_points, points_f64};
use gdel::internals::io::{PointBuf, PointCloud, PointFormat, files};
use std::path::Path;

fn read(format: PointFormat, bytes: impl Into<Vec<u8>>) -> PointCloud {
    format.read(bytes.into()).expect("a valid file")
}

fn read_f64(format: PointFormat, bytes: impl Into<Vec<u8>>) -> Vec<[f64; 3]> {
    match read(format, bytes).points {
        PointBuf::F64(points) => points,
        PointBuf::F32(_) => panic!("single precision where double was expected"),
    }
}

fn single(points: &[[f32; 3]]) -> PointCloud {
    PointCloud { points: PointBuf::F32(points.to_vec()), no_return: 0 }
}

#[test]
fn all_samples_are_read() {
    for (format, name, bytes) in samples::point_clouds() {
        let cloud = format.read(bytes).unwrap_or_else(|error| panic!("{format:?} {name}: {error}"));
        assert!(!cloud.points.is_empty(), "{format:?} {name}");
    }
}

#[test]
fn ply_skips_other_elements_properties_and_lists() {
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        assert_eq!(read(PointFormat::Ply, samples::ply(format, "float")), single(&POINTS), "{format}");
    }
    for format in ["binary_little_endian", "binary_big_endian"] {
        assert_eq!(read_f64(PointFormat::Ply, samples::ply(format, "double")), points_f64(), "{format}");
    }
}

#[test]
fn ply_with_integer_coordinates() {
    let header = "ply\nformat ascii 1.0\nelement vertex 1\n";
    let file = format!("{header}property int x\nproperty int y\nproperty int z\nend_header\n16777217 -2 3\n");
    assert_eq!(read_f64(PointFormat::Ply, file), [[16777217.0, -2.0, 3.0]]);
    let file = format!("{header}property short x\nproperty uchar y\nproperty float z\nend_header\n-7 2 3\n");
    assert_eq!(read(PointFormat::Ply, file), single(&[[-7.0, 2.0, 3.0]]));
}

#[test]
fn bunny() {
    let cloud = files::read_points(Path::new("tests/data/bunny.ply")).expect("the fixture");
    assert_eq!(cloud.points.len(), 35_947);
    assert!(matches!(cloud.points, PointBuf::F32(_)));
}

#[test]
fn obj_takes_vertices_without_faces() {
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, -1e-3]];
    let file = "# cloud\nv 0 0 0\nv 1 0 0 1.0\nvn 0 0 1\nvt 0 0\nv\t0 1 -1e-3\r\n";
    assert_eq!(read_f64(PointFormat::Obj, file), expected);
}

#[test]
fn stl_corners_once_each() {
    let expected: Vec<[f64; 3]> = POINTS[..4].iter().map(|p| p.map(|x| format!("{x:?}").parse().unwrap())).collect();
    assert_eq!(read_f64(PointFormat::Stl, samples::ascii_stl()), expected);
    assert_eq!(read(PointFormat::Stl, samples::binary_stl(b"")), single(&POINTS[..4]));
}

#[test]
fn binary_stl_that_begins_with_solid() {
    assert_eq!(read(PointFormat::Stl, samples::binary_stl(b"solid made by some CAD")), single(&POINTS[..4]));
}

#[test]
fn text_separators_comments_and_extra_columns() {
    let expected = [[1.0, 2.0, 3.0], [-4.5e-3, 5.0, 6.0]];
    for file in [
        "1 2 3\n-4.5e-3 5 6\n",
        "# c\n1\t2\t3 255 0 0\r\n\r\n-0.0045  5 6\r\n",
        "1, 2, 3\n-4.5E-3, 5, 6",
        "//X,Y,Z\n1;2;3;x\n-4.5e-3;5;6;y",
        "\u{feff}x y z\n1 2 3\n-4.5e-3 5 6",
    ] {
        assert_eq!(read_f64(PointFormat::Text, file), expected, "{file:?}");
    }
}

#[test]
fn pts_with_one_count_and_with_several_scans() {
    assert_eq!(read_f64(PointFormat::Text, "2\n1 2 3 0.5\n4 5 6 0.5\n"), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(read_f64(PointFormat::Text, "1\n1 2 3\n0\n1\n4 5 6"), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
}

#[test]
fn csv_columns_by_name() {
    let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    for file in [
        "id,y,z,x\n\"a,b\",2,3,1\n2, 5 ,6,4\n",
        "X;Y;Z\n1;2;3\n4;5;6",
        ",x,y,z\n0,1,2,3\n1,4,5,6\n",
        "1,2,3\n4,5,6\n",
        "1\t2\t3\n4\t5\t6\n",
        "1 2 3\n4 5 6\n",
    ] {
        assert_eq!(read_f64(PointFormat::Csv, file), expected, "{file:?}");
    }
}

#[test]
fn pcd_ascii_drops_and_counts_points_without_return() {
    let cloud = read(PointFormat::Pcd, samples::pcd_ascii());
    let points = PointBuf::F32(vec![[0.1, 0.2, 0.3], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
    assert_eq!(cloud, PointCloud { points, no_return: 1 });
}

#[test]
fn pcd_binary_and_compressed_as_pcd_rs_writes_them() {
    for encoding in ["binary", "binary_compressed"] {
        assert_eq!(read(PointFormat::Pcd, samples::pcd(encoding, &POINTS)), single(&POINTS), "{encoding}");
        let mut points = vec![[1.0, 2.0, 3.0]; 1000];
        points[17][1] = f32::NAN;
        points[500] = [f32::NAN; 3];
        let cloud = read(PointFormat::Pcd, samples::pcd(encoding, &points));
        let kept = PointBuf::F32(vec![[1.0, 2.0, 3.0]; 998]);
        assert_eq!(cloud, PointCloud { points: kept, no_return: 2 }, "{encoding}");
    }
}

#[test]
fn las_and_laz_of_all_kinds_of_point_formats() {
    for format in [0, 1, 2, 3, 6, 7, 8] {
        for (is_compressed, extra_bytes) in [(false, 0), (false, 3), (true, 0), (true, 3)] {
            let points = read_f64(PointFormat::Las, samples::las(format, is_compressed, extra_bytes));
            assert_eq!(points, las_points(), "format {format}, compressed: {is_compressed}, {extra_bytes} extra bytes");
        }
    }
}

#[test]
fn npy_as_npyz_writes_it() {
    assert_eq!(read(PointFormat::Npy, samples::npy(&POINTS)), single(&POINTS));
}

#[test]
fn npy_orders_and_types() {
    let file = |header: &str, data: &[u8]| {
        let mut file = b"\x93NUMPY\x01\x00".to_vec();
        file.extend((header.len() as u16).to_le_bytes());
        file.extend(header.bytes());
        file.extend(data);
        file
    };
    let fortran = [1.0f64, 4.0, 2.0, 5.0, 3.0, 6.0].map(f64::to_be_bytes).concat();
    let header = "{\"descr\": \">f8\", 'shape': (2, 3), 'fortran_order': True}\n";
    assert_eq!(read_f64(PointFormat::Npy, file(header, &fortran)), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    let header = "{'descr': '<i4', 'fortran_order': False, 'shape': (1, 3), }\n";
    let integers = [-1i32, 16777217, 3].map(i32::to_le_bytes).concat();
    assert_eq!(read_f64(PointFormat::Npy, file(header, &integers)), [[-1.0, 16777217.0, 3.0]]);
}

/// Numbers that need all digits, and extreme ones.
fn awkward() -> Vec<[f64; 3]> {
    vec![
        [0.1, 1.0 / 3.0, -0.0],
        [f64::MAX, f64::MIN_POSITIVE, 5e-324],
        [1e7 + 1e-9, 123_456_789.123_456_79, -2.225073858507201e-308],
    ]
}

#[test]
fn everything_that_is_written_is_read_back_exactly() {
    let double = awkward();
    // Single precision goes through text as the decimal of its exact value, whatever precision the reader has.
    let single: Vec<[f32; 3]> =
        vec![[0.1, 1.0 / 3.0, -0.0], [f32::MAX, f32::MIN_POSITIVE, 1e-45], [16777216.0, 1e-7, -1e30]];
    for format in PointFormat::ALL.iter().copied().filter(|format| format.is_written()) {
        let [mut of_double, mut of_single] = [const { Vec::new() }; 2];
        format.write(&mut of_double, (&double).into()).unwrap();
        format.write(&mut of_single, (&single).into()).unwrap();
        let exact = |bytes| -> Vec<[f64; 3]> { gdel::Points::from(&read(format, bytes)).iter().collect() };
        let bits = |points: Vec<[f64; 3]>| points.into_iter().map(|p| p.map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(exact(of_single)), bits(single.iter().map(|p| p.map(f64::from)).collect()), "{format:?}");
        if format != PointFormat::RawF32 {
            assert_eq!(bits(exact(of_double)), bits(double.clone()), "{format:?}");
        }
    }
}
