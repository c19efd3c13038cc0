//! Every format of point clouds: what is read is what was written, in the file's precision.

use crate::samples::{self, POINTS, las_points, points_f64};
use gdel_io::{PointBuf, PointCloud, PointFormat, files};
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
    cloud(PointBuf::F32(points.to_vec()), 0)
}

fn cloud(points: PointBuf, no_return: usize) -> PointCloud {
    let mut cloud = PointFormat::Text.read(Vec::new()).expect("no points");
    (cloud.points, cloud.no_return) = (points, no_return);
    cloud
}

#[test]
fn all_samples_are_read() {
    for (format, name, bytes) in samples::point_clouds() {
        let cloud: PointCloud = format.read(bytes).unwrap_or_else(|error| panic!("{format:?} {name}: {error}"));
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
    let cloud: PointCloud = files::read_points(Path::new("../../tests/data/bunny.ply")).expect("the fixture");
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
        "# c\n1\t2\t3 255 0 0\r\n\r\n-0.0045  5 6 7 7 7\r\n",
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
    let points = PointBuf::F32(vec![[0.1, 0.2, 0.3], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
    let read = read(PointFormat::Pcd, samples::pcd_ascii());
    assert_eq!((read.points, read.no_return), (points, 1));
}

#[test]
fn pcd_binary_and_compressed_as_pcd_rs_writes_them() {
    for encoding in ["binary", "binary_compressed"] {
        assert_eq!(read(PointFormat::Pcd, samples::pcd(encoding, &POINTS)), single(&POINTS), "{encoding}");
        let mut points = vec![[1.0, 2.0, 3.0]; 1000];
        points[17][1] = f32::NAN;
        points[500] = [f32::NAN; 3];
        let kept = PointBuf::F32(vec![[1.0, 2.0, 3.0]; 998]);
        assert_eq!(read(PointFormat::Pcd, samples::pcd(encoding, &points)), cloud(kept, 2), "{encoding}");
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
    // Single precision goes through text as the decimal of its exact value, whatever precision the
    // reader has.
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

#[test]
fn line_ends_of_old_macintosh_programs() {
    let expected = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
    assert_eq!(read_f64(PointFormat::Text, "1 2 3\r4 5 6\r"), expected);
    assert_eq!(read_f64(PointFormat::Text, "# c\r2\r1 2 3\r4 5 6"), expected);
    assert_eq!(read_f64(PointFormat::Text, "1 2 3\r\r\n4 5 6\n"), expected);
    assert_eq!(read_f64(PointFormat::Obj, "# c\rv 1 2 3\rv 4 5 6\r"), expected);
    assert_eq!(read_f64(PointFormat::Csv, "x,y,z\r1,2,3\r4,5,6\r"), expected);
    assert_eq!(read_f64(PointFormat::Node, "2 3 0 0\r0 1 2 3\r1 4 5 6\r"), expected);
    assert_eq!(read_f64(PointFormat::Off, "OFF\r2 0 0\r1 2 3\r4 5 6\r"), expected);
    let ply = String::from_utf8(samples::ply("ascii", "float")).unwrap().replace('\n', "\r");
    assert_eq!(read(PointFormat::Ply, ply), single(&POINTS));
    let pcd = samples::pcd_ascii().replace('\n', "\r");
    assert_eq!(read(PointFormat::Pcd, pcd), read(PointFormat::Pcd, samples::pcd_ascii()));
    assert_eq!(read(PointFormat::Stl, samples::ascii_stl().replace('\n', "\r")).points.len(), 4);
    // The first byte of the data is a line end, too.
    let mut binary = b"ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\rproperty uchar y\r\
        property uchar z\rend_header\r"
        .to_vec();
    binary.extend(b"\n\x02\x03");
    assert_eq!(read(PointFormat::Ply, binary), single(&[[10.0, 2.0, 3.0]]));
}

#[test]
fn off_of_all_kinds() {
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1e-3]];
    assert_eq!(read_f64(PointFormat::Off, samples::OFF), expected);
    for file in ["OFF 1 0 0\n1 2 3\n", "OFF1 0 0\n1 2 3", "NOFF\n# c\n1 0\n1 2 3 0 0 1\n", "OFF\n1 1 0\n1 2 3\n1 0\n"] {
        assert_eq!(read_f64(PointFormat::Off, file), [[1.0, 2.0, 3.0]], "{file:?}");
    }
}

#[test]
fn node_files_as_gdel_and_tetgen_write_them() {
    let mut file = Vec::new();
    PointFormat::Node.write(&mut file, (&awkward()).into()).unwrap();
    assert_eq!(read_f64(PointFormat::Node, file), awkward());
    let tetgen =
        "# Node count, 3 dim\n2  3  1  1\n  1   0.5 0 0   7.5 0\n  2   -1 2e3 0   8.5 1\n# Generated by tetgen\n";
    assert_eq!(read_f64(PointFormat::Node, tetgen), [[0.5, 0.0, 0.0], [-1.0, 2000.0, 0.0]]);
}

/// A `.npy` file with a header of these values.
fn npy(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.bytes());
    file.extend(data);
    file
}

#[test]
fn npy_with_long_integers_and_half_precision() {
    let integers = [-1i64, 1 << 53, 1 << 60].map(i64::to_le_bytes).concat();
    let expected = [[-1.0, (1u64 << 53) as f64, (1u64 << 60) as f64]];
    assert_eq!(read_f64(PointFormat::Npy, npy("'<i8'", "(1, 3)", &integers)), expected);
    let integers = [1u64, 2, 1 << 63].map(u64::to_be_bytes).concat();
    assert_eq!(read_f64(PointFormat::Npy, npy("'>u8'", "(1, 3)", &integers)), [[1.0, 2.0, (1u64 << 63) as f64]]);
    // 1, −2, 65504 (the greatest), 2⁻¹⁴ (the least normal), 2⁻²⁴ (the least), −0, 1/3 rounded.
    let halves = [0x3c00u16, 0xc000, 0x7bff, 0x0400, 0x0001, 0x8000, 0x3555, 0x3c00, 0x3c00].map(u16::to_le_bytes);
    let cloud = read(PointFormat::Npy, npy("'<f2'", "(3, 3)", &halves.concat()));
    let expected = [[1.0, -2.0, 65504.0], [6.103_515_6e-5, 5.960_464_5e-8, -0.0], [0.333_251_95, 1.0, 1.0]];
    assert_eq!(cloud, single(&expected));
}

fn read2(format: PointFormat, bytes: impl Into<Vec<u8>>) -> PointCloud<2> {
    format.read(bytes.into()).expect("a valid file")
}

#[test]
fn points_in_2d_of_every_format() {
    let expected = PointBuf::F64(vec![[1.0, 2.0], [4.0, 5.0]]);
    for (format, file) in [
        (PointFormat::Text, "1 2\n4 5\n"),
        (PointFormat::Text, "2\n1,2\n4,5\n"),
        (PointFormat::Text, "# x y\n1 2 0\n4 5 0\n"),
        (PointFormat::Csv, "X,Y\n1,2\n4,5\n"),
        (PointFormat::Csv, "id;y;x\n7;2;1\n8;5;4\n"),
        (PointFormat::Csv, "1,2\n4,5\n"),
        (PointFormat::Node, "2 2 0 1\n1 1 2 1\n2 4 5 1\n"),
        (PointFormat::Obj, "v 1 2 0\nv 4 5 0\n"),
        (PointFormat::Off, "OFF\n2 0 0\n1 2 0\n4 5 0\n"),
    ] {
        let cloud = read2(format, file);
        assert_eq!((&cloud.points, cloud.dropped_z), (&expected, false), "{file:?}");
    }
    let pairs = [1.0f32, 2.0, 4.0, 5.0].map(f32::to_le_bytes).concat();
    assert_eq!(
        read2(PointFormat::Npy, npy("'<f4'", "(2, 2)", &pairs)).points,
        PointBuf::F32(vec![[1.0, 2.0], [4.0, 5.0]])
    );
    // A z that is lost is noted.
    for (format, file) in [
        (PointFormat::Text, "1 2 0\n4 5 6\n"),
        (PointFormat::Csv, "z,x,y\n0,1,2\n6,4,5\n"),
        (PointFormat::Node, "2 3 0 0\n0 1 2 0\n1 4 5 6\n"),
        (PointFormat::Obj, "v 1 2 0\nv 4 5 6\n"),
    ] {
        let cloud = read2(format, file);
        assert_eq!((&cloud.points, cloud.dropped_z), (&expected, true), "{file:?}");
    }
}

#[test]
fn points_in_2d_that_are_written_are_read_back_exactly() {
    let points: Vec<[f64; 2]> = awkward().iter().map(|&[x, y, _]| [x, y]).collect();
    for format in PointFormat::ALL.iter().copied().filter(|&f| f.is_written() && f != PointFormat::RawF32) {
        let mut file = Vec::new();
        format.write(&mut file, (&points).into()).unwrap();
        assert_eq!(read2(format, file).points, PointBuf::F64(points.clone()), "{format:?}");
    }
}

#[test]
fn columns_that_are_ignored_are_counted() {
    let ignored = |format: PointFormat, file: &str| read(format, file).ignored_columns;
    assert_eq!(ignored(PointFormat::Text, "1 2 3\n4 5 6\n"), 0);
    assert_eq!(ignored(PointFormat::Text, "0 0 0 1 0 0\n0 1 0 0 0 1\n"), 3);
    assert_eq!(ignored(PointFormat::Csv, "1,2,3,a\n4,5,6,b\n"), 1);
    assert_eq!(ignored(PointFormat::Csv, "x,y,z,label\n4,5,6,b\n"), 0);
    assert_eq!(read2(PointFormat::Text, "1 2\n4 5\n").ignored_columns, 0);
    assert_eq!(read2(PointFormat::Text, "1 2 3\n4 5 6\n").ignored_columns, 0);
    assert_eq!(read2(PointFormat::Text, "1 2 3 9\n4 5 6 9\n").ignored_columns, 1);
}

#[test]
fn ptx_has_all_scans_in_their_common_coordinates() {
    let cloud = read(PointFormat::Ptx, samples::ptx());
    let points = [
        [10.0, 21.0, 30.0],
        [9.0, 20.0, 30.0],
        [10.0, 20.0, 31.0],
        [9.0, 21.0, 30.0],
        [10.0, 22.0, 30.0],
        [-4.0, 3.0, 5.0],
    ];
    assert_eq!(cloud.points, PointBuf::F64(points.to_vec()));
    assert_eq!(cloud.no_return, 1);
    assert_eq!(cloud.sensors, [[[10.0, 20.0, 30.0]; 5].as_slice(), &[[0.0; 3]]].concat());
    assert_eq!(cloud.colors.unwrap().rgb[..3], [[255, 0, 0], [0, 255, 0], [0, 0, 255]]);
    let short = PointFormat::Ptx.read::<3>(samples::PTX_HEADER.as_bytes().to_vec()).unwrap_err();
    assert!(short.what.contains("before all points"), "{short}");
}

/// What programs write for padding.
#[test]
fn pcd_has_unused_fields_without_values() {
    let header = "FIELDS x y _ z\nSIZE 4 4 1 4\nTYPE F F U F\nCOUNT 1 1 0 1\nPOINTS 2\n";
    let expected = single(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(read(PointFormat::Pcd, format!("{header}DATA ascii\n1 2 3\n4 5 6\n")), expected);
    let binary = [1f32, 2.0, 3.0, 4.0, 5.0, 6.0].iter().flat_map(|x| x.to_le_bytes());
    let file = format!("{header}DATA binary\n").into_bytes().into_iter().chain(binary).collect::<Vec<u8>>();
    assert_eq!(read(PointFormat::Pcd, file), expected);
}

#[test]
fn decimal_commas_are_read_where_they_can_be_nothing_else() {
    let expected = [[1.5, 2.0, -3.25e-3], [4.0, 5.5, 6.0]];
    for (format, file) in [
        (PointFormat::Text, "1,5 2 -3,25e-3\n4,0 5,5 6\n"),
        (PointFormat::Text, "1,5;2,0;-3,25e-3\n4;5,5;6\n"),
        (PointFormat::Text, "1,5\t2,0\t-3,25e-3\n4\t5,5\t6\n"),
        (PointFormat::Csv, "x;y;z\n1,5;2,0;-3,25e-3\n4;5,5;6\n"),
        (PointFormat::Csv, "1,5\t2,0\t-3,25e-3\n4\t5,5\t6\n"),
        (PointFormat::Csv, "x,y,z\n\"1,5\",2,\"-3,25e-3\"\n4,\"5,5\",6\n"),
    ] {
        assert_eq!(read_f64(format, file), expected, "{file}");
    }
    // Commas between the values.
    for file in ["1,2,3\n", "1, 2, 3\n", "1 , 2 , 3\n", "1,2,3,tree top\n"] {
        assert_eq!(read_f64(PointFormat::Text, file), [[1.0, 2.0, 3.0]], "{file}");
    }
}
