//! Broken files: each a clear error that says where, and nothing allocated on a header's word.

use crate::samples::{self, POINTS};
use gdel::{Mesh3, NONE};
use gdel_io::{FormatError, MeshData3, PointCloud, PointFormat, Position};

fn read_ele(bytes: &[u8]) -> Result<Vec<[u32; 4]>, FormatError> {
    gdel_io::read_ele::<Mesh3, _, _>(bytes)
}

fn read_neigh(bytes: &[u8]) -> Result<Vec<[u32; 4]>, FormatError> {
    gdel_io::read_neigh::<Mesh3, _, _>(bytes)
}

fn read_npz(bytes: &[u8]) -> Result<MeshData3, FormatError> {
    gdel_io::read_npz::<Mesh3, _, _>(bytes)
}

fn read_vtu(bytes: &[u8]) -> Result<MeshData3, FormatError> {
    gdel_io::read_vtu::<Mesh3, _, _>(bytes)
}

fn read(format: PointFormat, bytes: impl Into<Vec<u8>>) -> Result<PointCloud, FormatError> {
    format.read(bytes.into())
}

#[track_caller]
fn fails(format: PointFormat, bytes: impl Into<Vec<u8>>, at: Position, what: &str) {
    check(read(format, bytes).map(|cloud| cloud.points.len()), at, what);
}

#[track_caller]
fn check<T: std::fmt::Debug>(result: Result<T, FormatError>, at: Position, what: &str) {
    let error = result.expect_err("an error");
    assert_eq!(error.at, at, "{error}");
    assert!(error.what.contains(what), "{error}");
    assert!(!error.to_string().contains('\n'), "{error}");
}

/// A file without points is an empty cloud: of zero bytes where the format has no header, else as
/// the header says.
#[test]
fn files_without_points_of_every_format() {
    use PointFormat::*;
    for &format in PointFormat::ALL {
        let without_points = match format {
            Ply => Some(PLY.replace("vertex 2", "vertex 0") + "end_header\n"),
            Obj | Text | Csv | RawF32 | RawF64 => Some(String::new()),
            Stl => Some("solid a\nendsolid a\n".into()),
            Off => Some("OFF\n0 0 0\n".into()),
            Pcd => Some("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 0\nDATA ascii\n".into()),
            Node => Some("0 3 0 0\n".into()),
            Ptx => Some(samples::PTX_HEADER.replace("2\n3\n", "0\n3\n")),
            Npy => Some(String::from_utf8_lossy(&samples::npy(&[])[10..]).into_owned()),
            Las | E57 => None,
        };
        if format != Npy
            && let Some(file) = without_points
        {
            assert_eq!(read(format, file).map(|cloud| cloud.points.len()), Ok(0), "{format:?}");
        }
        if !matches!(format, Obj | Text | Csv | RawF32 | RawF64) {
            fails(format, "", Position::Byte(0), "empty");
        }
    }
    assert_eq!(read(Npy, samples::npy(&[])).map(|cloud| cloud.points.len()), Ok(0));
    let scans = [vec![], vec![samples::e57_single(&[])]];
    for scans in scans {
        assert_eq!(read(E57, samples::e57(&scans)).map(|cloud| cloud.points.len()), Ok(0));
    }
    assert_eq!(read(Csv, "x,y,z\n").map(|cloud| cloud.points.len()), Ok(0));
    assert_eq!(read(Text, "# nothing\n").map(|cloud| cloud.points.len()), Ok(0));
    assert_eq!(read(Obj, "# nothing\n").map(|cloud| cloud.points.len()), Ok(0));
    fails(Obj, "hello\n", Position::Line(1), "no vertices");
    check(read_ele(b""), Position::Line(1), "empty");
    check(read_npz(b""), Position::Byte(0), "");
    check(read_vtu(b""), Position::Byte(0), "`types`");
}

/// A file that lacks its end is an error wherever it is cut, unless what is left is a whole file.
#[test]
fn truncated_files_of_every_format() {
    for (format, name, bytes) in samples::point_clouds() {
        for length in (0..bytes.len()).step_by(1 + bytes.len() / 500) {
            let left = &bytes[..length];
            if !is_whole(format, name, left, bytes.len()) {
                let result = read(format, left);
                assert!(result.is_err(), "{format:?} {name} cut to {length} of {} bytes", bytes.len());
            }
        }
    }
}

fn is_whole(format: PointFormat, name: &str, left: &[u8], length: usize) -> bool {
    match (format, name) {
        // Any number of lines will do, and the columns after z do not matter.
        (PointFormat::Obj | PointFormat::Csv | PointFormat::Text, _) => true,
        (PointFormat::Pcd, "ascii") => left.len() + 4 > length,
        (PointFormat::Stl, "ascii") => left.trim_ascii_end().to_ascii_lowercase().ends_with(b"endsolid"),
        (PointFormat::RawF32, _) => left.len().is_multiple_of(12),
        (PointFormat::RawF64, _) => left.len().is_multiple_of(24),
        // Less its last color, or the comment at the end.
        (PointFormat::Off, _) => left.len() + 13 >= length,
        // Less the colour of the last point, of either scan.
        (PointFormat::Ptx, _) => {
            let first = samples::ptx().find("1\n1\n0 0 0").unwrap();
            left.len() + 11 >= length || (first - 7..=first).contains(&left.len())
        }
        (PointFormat::Node, _) => left.len() + 18 >= length,
        // The last points come before a table of chunks that can be done without.
        (PointFormat::Las, "laz") => left.len() + 32 > length,
        _ => false,
    }
}

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n";

#[test]
fn ply_that_promises_more_than_it_holds() {
    let many = PLY.replace("vertex 2", "vertex 999999999999");
    fails(PointFormat::Ply, format!("{many}end_header\n1 2 3\n4 5 6\n"), Position::Line(9), "ends before");
    let binary = many.replace("ascii", "binary_little_endian") + "end_header\n";
    let mut file = binary.clone().into_bytes();
    file.extend([0; 30]);
    fails(PointFormat::Ply, file, Position::Byte(binary.len() + 30), "ends before");
}

#[test]
fn ply_that_ends_in_its_faces() {
    let file = samples::ply("binary_little_endian", "float");
    fails(PointFormat::Ply, &file[..file.len() - 1], Position::Byte(file.len() - 1), "face");
}

#[test]
fn ply_with_a_bad_number() {
    fails(PointFormat::Ply, format!("{PLY}end_header\n1 2 3\n4 five 6\n"), Position::Line(9), "`five` is not a number");
}

#[test]
fn ply_with_a_bad_header() {
    fails(PointFormat::Ply, "obj\n", Position::Line(1), "ply");
    fails(PointFormat::Ply, PLY.replace("vertex 2", "vertex two"), Position::Line(3), "count");
    fails(PointFormat::Ply, PLY.replace("float z", "quad z"), Position::Line(6), "quad");
    fails(PointFormat::Ply, PLY, Position::Line(6), "ends before");
    fails(PointFormat::Ply, PLY.replace("vertex", "face") + "end_header\n", Position::Line(1), "`vertex`");
    fails(PointFormat::Ply, PLY.replace("float z", "float w") + "end_header\n", Position::Line(3), "`z`");
    fails(PointFormat::Ply, PLY.replace("float z", "list int float z") + "end_header\n", Position::Line(3), "list");
}

#[test]
fn ply_with_endless_rows_of_nothing() {
    let file = PLY.replace("element", "element nothing 9999999999999\nelement") + "end_header\n1 2 3\n4 5 6\n";
    fails(PointFormat::Ply, file, Position::Line(3), "no properties");
}

#[test]
fn text_with_a_bad_number() {
    fails(PointFormat::Text, "1 2 3\n\n4 5,5 x\n", Position::Line(3), "");
    fails(PointFormat::Text, "1 2 3\n4 five 6\n", Position::Line(2), "`five` is not a number");
    fails(PointFormat::Csv, "x,y,z\n1,2,3\n4,,6\n", Position::Line(3), "`` is not a number");
    fails(PointFormat::Obj, "v 1 2 3\nv 4 5 1e\n", Position::Line(2), "`1e` is not a number");
    fails(PointFormat::Stl, samples::ascii_stl().replacen("1.5", "1.5.", 1), Position::Line(5), "`1.5.`");
}

#[test]
fn text_with_too_few_columns() {
    fails(PointFormat::Text, "1 2 3\n4 5\n", Position::Line(2), "x, y and z");
    fails(PointFormat::Csv, "x,y,z\n1,2,3\n4,5\n", Position::Line(3), "x, y and z");
    fails(PointFormat::Obj, "v 1 2\n", Position::Line(1), "x, y and z");
    fails(PointFormat::Csv, "easting,northing,height\n1,2,3\n", Position::Line(1), "`easting`");
}

#[test]
fn long_junk_is_quoted_short() {
    let junk = "\u{1b}[2J".repeat(1000);
    let error = read(PointFormat::Text, junk).unwrap_err();
    assert!(error.to_string().len() < 300 && !error.to_string().contains('\u{1b}'), "{error}");
}

#[test]
fn pts_with_fewer_points_than_its_count() {
    fails(PointFormat::Text, "3\n1 2 3\n4 5 6\n", Position::Line(1), "3 points");
}

#[test]
fn not_a_number_and_infinity_in_every_format() {
    fails(PointFormat::Text, "1 2 3\n4 nan 6\n", Position::Line(2), "not a finite number");
    fails(PointFormat::Csv, "1,2,3\n4,5,-inf\n", Position::Line(2), "not a finite number");
    fails(PointFormat::Obj, "v 1 2 1e999\n", Position::Line(1), "not a finite number");
    fails(PointFormat::Ply, format!("{PLY}end_header\n1 2 3\n4 nan 6\n"), Position::Point(1), "y coordinate is NaN");
    let mut points = POINTS;
    points[3][2] = f32::NEG_INFINITY;
    fails(PointFormat::Npy, samples::npy(&points), Position::Point(3), "z coordinate is -inf");
    fails(PointFormat::Pcd, samples::pcd("binary", &points), Position::Point(3), "z coordinate is -inf");
    let raw: Vec<u8> = points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    fails(PointFormat::RawF32, raw, Position::Point(3), "z coordinate is -inf");
}

#[test]
fn raw_numbers_that_are_no_whole_points() {
    fails(PointFormat::RawF32, [0; 26], Position::Byte(24), "12 bytes");
    fails(PointFormat::RawF64, [0; 23], Position::Byte(0), "24 bytes");
}

#[test]
fn binary_stl_that_promises_more_than_it_holds() {
    let mut file = samples::binary_stl(b"");
    file[80..84].fill(0xff);
    fails(PointFormat::Stl, file, Position::Byte(184), "4294967295 triangles");
}

#[test]
fn ascii_stl_that_is_broken() {
    fails(PointFormat::Stl, "solid a\nfacet normal 0 0 1\n", Position::Line(2), "within the solid of line 1");
    fails(PointFormat::Stl, "solid a\nwhatever\n", Position::Line(2), "`whatever`");
    fails(PointFormat::Stl, "solid a\nouter loop\nvertex 1 2 3\nendloop\n", Position::Line(4), "three vertices");
}

#[test]
fn pcd_with_a_bad_header() {
    let header = samples::pcd_ascii();
    fails(PointFormat::Pcd, &header[..60], Position::Byte(60), "DATA");
    fails(PointFormat::Pcd, header.replace("x y z", "x y w"), Position::Line(11), "`z`");
    fails(PointFormat::Pcd, header.replace("4 4 4 4", "4 4 7 4"), Position::Line(11), "SIZE 7");
    fails(PointFormat::Pcd, header.replace("4 4 4 4", "4 4"), Position::Line(11), "different numbers");
    fails(PointFormat::Pcd, header.replace("COUNT 1", "COUNT 99999999999"), Position::Line(11), "COUNT");
    fails(PointFormat::Pcd, header.replace("POINTS 4", "POINTS -4"), Position::Line(10), "`-4`");
    fails(PointFormat::Pcd, header.replace("DATA ascii", "DATA zip"), Position::Line(11), "`zip`");
    fails(PointFormat::Pcd, header.replace("7 8 9 3", "7 8"), Position::Line(15), "only 2 values");
    fails(PointFormat::Pcd, header.replace("7 8 9 3\n", ""), Position::Line(14), "3 of the 4 points");
}

/// The header of a PCD file that claims `points` points and compressed data of these sizes, with no
/// data at all.
fn pcd_claim(points: u64, compressed: u32, size: u32) -> Vec<u8> {
    let header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
    let mut file = format!("{header}POINTS {points}\nDATA binary_compressed\n").into_bytes();
    file.extend(compressed.to_le_bytes());
    file.extend(size.to_le_bytes());
    file
}

#[test]
fn pcd_that_claims_gigabytes() {
    let cases = [
        (pcd_claim(1, u32::MAX, 12), 0, "within its compressed data"),
        (pcd_claim(300_000_000, 0, 3_600_000_000), 4, "cannot expand"),
        (pcd_claim(u64::MAX, 0, 12), 4, "do not match"),
        (pcd_claim(2, 0, 12), 4, "do not match"),
    ];
    for (file, bytes_before_end, what) in cases {
        let at = Position::Byte(file.len() - bytes_before_end);
        fails(PointFormat::Pcd, file, at, what);
    }
}

#[test]
fn pcd_whose_compressed_data_is_broken() {
    let whole = samples::pcd("binary_compressed", &POINTS);
    let data = whole.windows(5).position(|w| w == b"essed").unwrap() + 6 + 8;
    // A match that reaches back behind the start of the output.
    let mut broken = whole;
    broken[data] = 0xff;
    fails(PointFormat::Pcd, broken, Position::Byte(data), "broken");
}

/// Where the fields of a LAS header are.
mod las_header {
    pub const OFFSET_TO_POINTS: usize = 96;
    pub const RECORD_LENGTH: usize = 105;
    pub const EVLR_START: usize = 235;
    pub const EVLR_COUNT: usize = 243;
    pub const POINTS: usize = 247;
    /// The number of points in four bytes, of LAS up to 1.3.
    pub const LEGACY_POINTS: usize = 107;
}

#[test]
fn las_that_promises_more_than_it_holds() {
    for is_compressed in [false, true] {
        let mut file = samples::las(6, is_compressed, 0);
        file[las_header::LEGACY_POINTS..][..4].fill(0);
        file[las_header::POINTS..][..8].copy_from_slice(&(1u64 << 60).to_le_bytes());
        fails(PointFormat::Las, file, Position::Byte(0), "too many");
    }
    let mut file = samples::las(6, false, 0);
    file[las_header::LEGACY_POINTS..][..4].copy_from_slice(&1_000_000u32.to_le_bytes());
    let length = file.len();
    fails(PointFormat::Las, file, Position::Byte(length), "1000000 points");
}

#[test]
fn las_with_an_extended_record_of_exabytes() {
    let mut file = samples::las(6, false, 0);
    let end = file.len() as u64;
    file[las_header::EVLR_START..][..8].copy_from_slice(&end.to_le_bytes());
    file[las_header::EVLR_COUNT..][..4].copy_from_slice(&1u32.to_le_bytes());
    file.extend([0; 20]);
    file.extend(u64::MAX.to_le_bytes());
    file.extend([0; 32]);
    assert_eq!(read(PointFormat::Las, file).map(|cloud| cloud.points.len()), Ok(samples::las_points().len()));
}

#[test]
fn laz_with_a_table_of_billions_of_chunks() {
    let mut file = samples::las(0, true, 0);
    let start = u32::from_le_bytes(file[las_header::OFFSET_TO_POINTS..][..4].try_into().unwrap()) as usize;
    let table = u64::from_le_bytes(file[start..][..8].try_into().unwrap()) as usize;
    file[table + 4..][..4].fill(0xff);
    fails(PointFormat::Las, file, Position::Byte(table), "4294967295 chunks");
}

#[test]
fn laz_with_a_layer_of_gigabytes() {
    let mut file = samples::las(6, true, 0);
    let start = u32::from_le_bytes(file[las_header::OFFSET_TO_POINTS..][..4].try_into().unwrap()) as usize;
    let record = u16::from_le_bytes(file[las_header::RECORD_LENGTH..][..2].try_into().unwrap()) as usize;
    file[start + 8 + record + 4..][..4].fill(0xff);
    fails(PointFormat::Las, file, Position::Byte(start + 8), "ends within the chunk");
}

#[test]
fn npy_that_promises_more_than_it_holds() {
    let claim = |shape: &str| {
        let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}}}\n");
        let mut claim = b"\x93NUMPY\x01\x00".to_vec();
        claim.extend((header.len() as u16).to_le_bytes());
        claim.extend(header.bytes());
        claim.extend([0; 60]);
        claim
    };
    assert!(read(PointFormat::Npy, claim("(5,3)")).is_ok());
    for shape in ["(6, 3)", "(99999999999, 3)", "(18446744073709551615, 3)", "(3, 18446744073709551615)"] {
        let length = claim(shape).len();
        fails(PointFormat::Npy, claim(shape), Position::Byte(length), "ends before");
    }
    for shape in ["(3, 5)", "(15,)", "()", "(5, 3, 1)", "(0, 99999999999)"] {
        fails(PointFormat::Npy, claim(shape), Position::Byte(0), "shape (n, 3)");
    }
    fails(PointFormat::Npy, claim("5"), Position::Byte(10), "tuple");
    fails(PointFormat::Npy, claim("(((((((((((((((((((((((((((((((("), Position::Byte(10), "tuple");
    let mut long = b"\x93NUMPY\x02\x00".to_vec();
    long.extend(u32::MAX.to_le_bytes());
    fails(PointFormat::Npy, long, Position::Byte(12), "header of 4294967295 bytes");
}

#[test]
fn npy_of_other_types() {
    let file = String::from_utf8_lossy(&samples::npy(&POINTS)[10..]).into_owned();
    for other in ["'|O'", "'<c8'", "'<f16'", "'|b1'", "[('x', '<f4')]"] {
        let header = file.replace("'<f4'", other);
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend([0; 120]);
        assert!(read(PointFormat::Npy, bytes).unwrap_err().what.contains("type"), "{other}");
    }
}

#[test]
fn broken_tetgen_files() {
    check(read_ele(b"2 4 0\n0 0 1 2 3\n"), Position::Line(2), "promises 2 rows");
    check(read_ele(b"99999999999 4 0\n"), Position::Line(1), "promises");
    check(read_ele(b"1 4 0\n0 0 1 2\n"), Position::Line(2), "missing");
    check(read_ele(b"1 4 0\n0 0 1 2 x\n"), Position::Line(2), "`x`");
    check(read_ele(b"1 4 0\n0 0 1 2 -3\n"), Position::Line(2), "-3 is out of range");
    check(read_ele(b"1 4 0\n0 0 1 2 4294967296\n"), Position::Line(2), "out of range");
    check(read_ele(b"1 4 0\n7 0 1 2 3\n"), Position::Line(2), "numbered 7");
    check(read_ele(b"2 4 0\n0 0 1 2 3\n2 0 1 2 3\n"), Position::Line(3), "numbered 2");
    check(read_ele(b"1 3 0\n0 0 1 2\n"), Position::Line(1), "4 entries");
    check(read_neigh(b"1 4\n0 -1 -1 -1 2147483648\n"), Position::Line(2), "out of range");
}

#[test]
fn broken_vtu_files() {
    let file = samples::VTU_ASCII;
    let fails = |from: &str, to: &str, what: &str| {
        assert!(file.contains(from));
        let error = read_vtu(file.replace(from, to).as_bytes()).expect_err("an error");
        assert!(error.what.contains(what), "{error}");
    };
    fails("10 10", "10 12", "cell 1 is not a tetrahedron");
    fails("10 10", "10 10 10", "3 tetrahedra");
    fails("1 2 3 4\n", "1 2 3\n", "7 vertices");
    fails("1 2 3 4\n", "1 2 3 x\n", "not all of its values are integers");
    fails("1 2 3 4\n", "1 2 3 -4\n", "-4 is not the index of a point");
    fails("\"connectivity\"", "\"other\"", "`connectivity`");
    fails("format=\"ascii\">10", "format=\"appended\" offset=\"99\">10", "appended");
    fails("format=\"ascii\">10", "format=\"binary\">10", "broken");
    fails("format=\"ascii\">10", "format=\"new\">10", "`new`");
    fails("<Points>", "<Points", "");
    let zlib = samples::VTU_ZLIB.replace("vtkZLib", "vtkLZ4");
    assert!(read_vtu(zlib.as_bytes()).unwrap_err().what.contains("not supported"));
}

#[test]
fn npz_without_tetrahedra() {
    let mut empty = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
    empty.start_file("points.npy", zip::write::SimpleFileOptions::default()).unwrap();
    let file = empty.finish().unwrap().into_inner();
    check(read_npz(&file), Position::Byte(0), "no array `tetrahedra`");
}

#[test]
fn several_points_on_a_line() {
    fails(
        PointFormat::Text,
        "0 0 0 1 0 0 0 1 0 0 0 1\n",
        Position::Line(1),
        "all 12 numbers of the file are on one line",
    );
    fails(PointFormat::Text, "0 0 0 1 0 0\n0 1 0\n", Position::Line(2), "3 numbers, but line 1 has 6");
    fails(PointFormat::Text, "0 0 0\n0 1 0 0 0 1\n", Position::Line(2), "6 numbers, but line 1 has 3");
    fails(PointFormat::Text, "4\n0 0 0 1 0 0\n0 1 0 0 0 1\n", Position::Line(1), "4 points in all, one per line");
    fails(PointFormat::Csv, "0,0,0,1,0,0\n", Position::Line(1), "one point per line");
    fails(PointFormat::Obj, "v 0 0 0 1 0 0 0 1 0\n", Position::Line(1), "one vertex per line");
    fails(PointFormat::Obj, "v 0 0 0 v 1 0 0\n", Position::Line(1), "`v` is not a number");
    fails(PointFormat::Off, "OFF\n2 0 0\n0 0 0 1 0 0\n", Position::Line(3), "1 of 2 vertices");
    let in_2d = PointFormat::Text.read::<2>(b"0 0 1 0 0 1".to_vec()).unwrap_err();
    assert!(in_2d.what.contains("all 6 numbers"), "{in_2d}");
    // Colors, weights and labels are no points.
    for file in ["v 1 2 3 1\n", "v 1 2 3 0.5 0.5 0.5\n", "v 1 2 3 0.5 0.5 0.5 1\n", "v 1 2 3 # first\n"] {
        assert_eq!(read(PointFormat::Obj, file).map(|cloud| cloud.points.len()), Ok(1), "{file}");
    }
    assert_eq!(read(PointFormat::Text, "1 2 3 tree\n4 5 6\n").map(|cloud| cloud.points.len()), Ok(2));
    assert_eq!(read(PointFormat::Text, "1\n1 2 3 9 9 9\n").map(|cloud| cloud.points.len()), Ok(1));
}

#[test]
fn pcd_whose_counts_disagree() {
    let header = samples::pcd_ascii();
    fails(PointFormat::Pcd, header.replace("COUNT 1 1 1 1", "COUNT 0 1 1 1"), Position::Line(11), "`x` must be 1");
    fails(PointFormat::Pcd, header.replace("COUNT 1 1 1 1", "COUNT 1 3 1 1"), Position::Line(11), "`y` must be 1");
    fails(PointFormat::Pcd, header.replace("COUNT 1 1 1 1", "COUNT 1 1 1 0"), Position::Line(11), "COUNT `0`");
    let what = "WIDTH 3 and HEIGHT 2 do not make POINTS 4";
    fails(PointFormat::Pcd, header.replace("WIDTH 2", "WIDTH 3"), Position::Line(11), what);
    fails(PointFormat::Pcd, header.replace("WIDTH 2", "WIDTH 99999999999999999999"), Position::Line(7), "not a count");
    let few = header.replace("POINTS 4", "POINTS 2").replace("WIDTH 2", "WIDTH 1");
    fails(PointFormat::Pcd, few, Position::Line(14), "goes on after the 2 points");
    let mut binary = samples::pcd("binary", &POINTS);
    let length = binary.len();
    binary.extend([7; 30]);
    fails(PointFormat::Pcd, binary, Position::Byte(length), "goes on after the 5 points");
}

#[test]
fn files_that_go_on_after_their_points() {
    fails(PointFormat::Ply, format!("{PLY}end_header\n1 2 3\n4 5 6\n7 8 9\n"), Position::Line(10), "`7` goes on");
    let mut stl = samples::binary_stl(b"");
    stl[80..84].copy_from_slice(&1u32.to_le_bytes());
    fails(PointFormat::Stl, stl, Position::Byte(134), "goes on after the 1 triangles");
    let array = samples::npy(&POINTS);
    fails(PointFormat::Npy, [array.clone(), array.clone()].concat(), Position::Byte(array.len()), "one array per file");
    fails(PointFormat::Off, "OFF\n1 0 0\n1 2 3\n4 5 6\n", Position::Line(4), "goes on");
}

#[test]
fn ply_with_every_other_fault() {
    let fails = |file: String, line, what: &str| fails(PointFormat::Ply, file, Position::Line(line), what);
    fails(PLY.replace("ascii 1.0", "ascii 2.0") + "end_header\n", 2, "`format NAME 1.0` expected");
    fails(PLY.replace("ascii", "text") + "end_header\n", 2, "the format `text` is not known");
    fails(PLY.replace("format ascii 1.0\n", "") + "end_header\n1 2 3\n4 5 6\n", 6, "without a line `format`");
    fails(
        PLY.replace("property float x", "propertie float x") + "end_header\n",
        4,
        "`propertie float x` is not a line",
    );
    fails(PLY.replace("property float x", "property x") + "end_header\n", 4, "`property TYPE NAME`");
    fails(PLY.replace("element vertex 2\n", "") + "end_header\n", 3, "before the first element");
    fails(PLY.replace("float y", "float x") + "end_header\n1 2 3\n4 5 6\n", 3, "more than one property `x`");
    fails(PLY.to_owned() + "element vertex 1\nproperty float x\nend_header\n", 7, "a second element `vertex`");
    fails(format!("{PLY}property list float int a\nend_header\n"), 7, "whole numbers");
    fails(format!("{PLY}property list int int a\nend_header\n1 2 3 -1\n"), 9, "a list of -1 entries");
    fails(format!("{PLY}end_header\n1 2 3\n4 5"), 9, "the file ends before all 2 of its elements `vertex`: only 1");
}

#[test]
fn text_in_utf_16() {
    let text: Vec<u8> = "\u{feff}1 2 3\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    fails(PointFormat::Text, text.clone(), Position::Byte(0), "save it as UTF-8");
    fails(PointFormat::Csv, text, Position::Byte(0), "save it as UTF-8");
    fails(PointFormat::Text, "hello\n", Position::Line(1), "`hello` is not a number");
}

#[test]
fn csv_with_other_names() {
    let error = read(PointFormat::Csv, "easting,northing,height\n1,2,3\n").unwrap_err();
    let what = "line 1: this line names no columns x, y and z, in upper or lower case, but `easting`, `northing`, `height`: rename";
    assert!(error.to_string().starts_with(what), "{error}");
    assert!(PointFormat::Csv.read::<2>(b"u,v\n1,2\n".to_vec()).unwrap_err().what.contains("names no columns x and y"));
}

#[test]
fn npy_of_objects_says_what_to_do() {
    let file = String::from_utf8_lossy(&samples::npy(&POINTS)[10..]).into_owned();
    let error = |descr: &str| {
        let header = file.replace("'<f4'", descr);
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        read(PointFormat::Npy, bytes).unwrap_err().what
    };
    assert_eq!(
        error("'|O'"),
        "an array of Python objects (type `'|O'`), not of numbers: save it with `.astype(float)`"
    );
    assert_eq!(error("'<c16'"), "an array of complex numbers (type `'<c16'`)");
    assert!(error("[('x', '<f4'), ('y', '<f4')]").starts_with("an array with named fields (type `[('x', '<f4')"));
    assert!(error("'<f16'").ends_with("(`'<f16'`): save it with `.astype(float)`"));
}

#[test]
fn npy_with_integers_that_double_precision_cannot_hold() {
    let header = "{'descr': '<i8', 'fortran_order': False, 'shape': (1, 3), }\n";
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.bytes());
    file.extend([1i64, (1 << 53) + 1, i64::MAX].map(i64::to_le_bytes).concat());
    fails(PointFormat::Npy, file, Position::Point(0), "9007199254740993 has more digits");
}

#[test]
fn truncated_laz_says_so() {
    let file = samples::las(6, true, 0);
    for length in [100, 200, 400, file.len() / 2, file.len() - 60] {
        let error = read(PointFormat::Las, &file[..length]).unwrap_err();
        let text = error.to_string();
        assert!(!text.contains("Error") && !text.contains("failed to fill"), "cut to {length}: {text}");
        assert!(text.contains("ends") || text.contains("end of the data"), "cut to {length}: {text}");
    }
    let file = samples::las(0, true, 0);
    let start = u32::from_le_bytes(file[las_header::OFFSET_TO_POINTS..][..4].try_into().unwrap()) as usize;
    let error = read(PointFormat::Las, &file[..start.midpoint(file.len())]).unwrap_err();
    assert!(error.what.contains("truncated"), "{error}");
}

#[test]
fn control_characters_in_files_do_not_reach_messages() {
    let vtu = samples::VTU_ASCII.replace("</Points>", "</Po\u{1b}[2J\u{7}ints>");
    let error = read_vtu(vtu.as_bytes()).unwrap_err().to_string();
    assert!(!error.contains(char::is_control), "{error}");
}

#[test]
fn neighbours_below_minus_one() {
    check(read_neigh(b"1 4\n0 -1 -2 -1 -1\n"), Position::Line(2), "-2 is out of range");
    check(read_neigh(b"1 4\n0 -1 -1 -1 -9223372036854775808\n"), Position::Line(2), "out of range");
    check(read_neigh(b"1 4\n1 -1 0 -1 -1\n"), Position::Line(2), "0 is out of range");
    assert_eq!(read_neigh(b"1 4\n1 -1 1 -1 -1\n"), Ok(vec![[NONE, 0, NONE, NONE]]));
}

#[test]
fn broken_off_and_node_files() {
    fails(PointFormat::Off, "hello\n", Position::Line(1), "not OFF");
    fails(PointFormat::Off, "4OFF\n1 0 0\n1 2 3 4\n", Position::Line(1), "only OFF with x, y and z");
    fails(PointFormat::Off, "OFF BINARY\n", Position::Line(1), "binary OFF is not read");
    fails(PointFormat::Off, "OFF\nmany 0 0\n", Position::Line(2), "`many` is not a count of vertices");
    fails(PointFormat::Off, "OFF\n99999999999 0 0\n1 2 3\n", Position::Line(3), "1 of 99999999999 vertices");
    fails(PointFormat::Off, "OFF\n1 1 0\n1 2 3\n3 0 0 1\n", Position::Line(4), "each below 1");
    fails(PointFormat::Node, "1 3 0 0\n0 1 2\n", Position::Line(2), "a coordinate is missing");
    fails(PointFormat::Node, "1 3 0 0\n0 1 2 nan\n", Position::Line(2), "not a finite number");
    fails(PointFormat::Node, "2 3 0 0\n0 1 2 3\n", Position::Line(2), "promises 2 rows");
    fails(PointFormat::Node, "1 2 0 0\n0 1 2\n", Position::Line(1), "2D points");
}
