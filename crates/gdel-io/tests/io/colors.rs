//! The colours that come with points, in every format that has some.

use crate::samples::{POINTS, Scan, columns, e57, e57_single, las_points, las_with};
use ::e57::{Record, RecordDataType, RecordName, RecordValue};
use gdel_io::{ColorSource, PointCloud, PointFormat};

/// Returns the colours of a valid file.
fn colors(format: PointFormat, bytes: impl Into<Vec<u8>>) -> Option<(ColorSource, Vec<[u8; 3]>)> {
    let cloud: PointCloud = format.read(bytes.into()).expect("a valid file");
    let colors = cloud.colors?;
    assert_eq!(colors.rgb.len(), cloud.points.len());
    Some((colors.source, colors.rgb))
}

const RGB: [[u8; 3]; 2] = [[255, 0, 51], [0, 102, 255]];

fn rgb() -> Option<(ColorSource, Vec<[u8; 3]>)> {
    Some((ColorSource::Rgb, RGB.to_vec()))
}

fn ply(properties: &[&str], rows: [&str; 2]) -> String {
    let properties: String = properties.iter().map(|property| format!("property {property}\n")).collect();
    format!(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n{properties}\
         end_header\n0 0 0 {}\n1 2 3 {}\n",
        rows[0], rows[1]
    )
}

#[test]
fn ply_has_colors_of_all_types() {
    for (kind, names, rows) in [
        ("uchar", ["red", "green", "blue"], ["255 0 51", "0 102 255"]),
        ("uint8", ["diffuse_red", "diffuse_green", "diffuse_blue"], ["255 0 51", "0 102 255"]),
        ("ushort", ["red", "green", "blue"], ["65535 0 13107", "0 26214 65535"]),
        ("ushort", ["red", "green", "blue"], ["255 0 51", "0 102 255"]),
        ("float", ["r", "g", "b"], ["1 0 0.2", "0 0.4 1"]),
        ("double", ["red", "green", "blue"], ["255 0 51", "0 102 255"]),
    ] {
        let properties = names.map(|name| format!("{kind} {name}"));
        let [r, g, b] = properties.each_ref().map(String::as_str);
        assert_eq!(colors(PointFormat::Ply, ply(&[r, g, b], rows)), rgb(), "{kind} {names:?}");
    }
}

#[test]
fn what_else_ply_says_stands_for_colors() {
    let intensity = ply(&["float scalar_Intensity"], ["-7", "9.5"]);
    let grey = Some((ColorSource::Intensity, vec![[0; 3], [255; 3]]));
    assert_eq!(colors(PointFormat::Ply, intensity), grey);
    let normals = ply(&["float nx", "float ny", "float nz"], ["0 0 2", "-1 0 0"]);
    let directions = Some((ColorSource::Normals, vec![[128, 128, 255], [0, 128, 128]]));
    assert_eq!(colors(PointFormat::Ply, normals), directions);
    let both = ply(&["float intensity", "uchar red", "uchar green", "uchar blue"], ["1 255 0 51", "2 0 102 255"]);
    assert_eq!(colors(PointFormat::Ply, both), rgb());
    let black = ply(&["float intensity", "uchar red", "uchar green", "uchar blue"], ["1 0 0 0", "2 0 0 0"]);
    assert_eq!(colors(PointFormat::Ply, black), grey);
    assert_eq!(colors(PointFormat::Ply, ply(&["uchar red", "uchar green"], ["1 2", "3 4"])), None);
    assert_eq!(colors(PointFormat::Ply, ply(&["list uchar uchar red"], ["1 2", "1 4"])), None);
}

#[test]
fn broken_colors_break_no_file() {
    let nan = ply(&["float red", "float green", "float blue"], ["nan 0 1", "1 inf -3"]);
    let expected = Some((ColorSource::Rgb, vec![[0, 0, 1], [1, 255, 0]]));
    assert_eq!(colors(PointFormat::Ply, nan), expected);
}

#[test]
fn obj_has_colors_if_all_vertices_have_some() {
    assert_eq!(colors(PointFormat::Obj, "v 0 0 0 1 0 0.2\nv 1 2 3 0 0.4 1\n"), rgb());
    assert_eq!(colors(PointFormat::Obj, "v 0 0 0 1 0 0.2\nv 1 2 3\n"), None);
    assert_eq!(colors(PointFormat::Obj, "v 0 0 0 1 0 0.2 1\nv 1 2 3 0 0.4 1 1\n"), None);
}

#[test]
fn text_has_colors_after_the_coordinates() {
    for text in [
        "0 0 0 255 0 51\n1 2 3 0 102 255\n",
        "0 0 0 255 0 51 0.5\n1 2 3 0 102 255 0.7\n",
        "0 0 0 -900 255 0 51\n1 2 3 1800 0 102 255\n",
        "2\n0 0 0 17 255 0 51\n1 2 3 18 0 102 255\n",
        "0,0,0,255,0,51\n1,2,3,0,102,255\n",
    ] {
        assert_eq!(colors(PointFormat::Text, text), rgb(), "{text}");
    }
    let grey = Some((ColorSource::Intensity, vec![[0; 3], [255; 3]]));
    assert_eq!(colors(PointFormat::Text, "0 0 0 -3\n1 2 3 0.25\n"), grey);
    let directions = Some((ColorSource::Normals, vec![[128, 128, 255], [0, 128, 128]]));
    assert_eq!(colors(PointFormat::Text, "0 0 0 0 0 1\n1 2 3 -1 0 0.0001\n"), directions);
}

#[test]
fn other_columns_of_text_are_no_colors() {
    for text in [
        "0 0 0\n1 2 3\n",
        "0 0 0 1 2\n1 2 3 4 5\n",
        "0 0 0 255 0 51\n1 2 3 0 102 256\n",
        "0 0 0 255 0 51\n1 2 3 0 102 0.5\n",
        "0 0 0 255 0 51\n1 2 3 0 102 blue\n",
        "0 0 0 a b c\n1 2 3 d e f\n",
        "0 0 0 0 0 1\n1 2 3 0 1 1\n",
    ] {
        assert_eq!(colors(PointFormat::Text, text), None, "{text}");
    }
}

#[test]
fn columns_of_colors_may_have_names() {
    assert_eq!(colors(PointFormat::Csv, "B;x;G;y;z;R\n51;0;0;0;0;255\n255;1;102;2;3;0\n"), rgb());
    assert_eq!(colors(PointFormat::Csv, "x,y,z,red,green,blue\n0,0,0,1,0,0.2\n1,2,3,0,0.4,1\n"), rgb());
    let missing = "x,y,z,r,g,b\n0,0,0,255,0,51\n1,2,3,?,,\n";
    assert_eq!(colors(PointFormat::Csv, missing), Some((ColorSource::Rgb, vec![RGB[0], [0; 3]])));
    let grey = Some((ColorSource::Intensity, vec![[0; 3], [255; 3]]));
    assert_eq!(colors(PointFormat::Csv, "x,y,z,Intensity,time\n0,0,0,5,1\n1,2,3,6,1\n"), grey);
}

#[test]
fn flat_points_have_the_colors_of_their_rows() {
    let cloud: PointCloud<2> =
        PointFormat::Text.read(b"0 0 0 255 0 51\n1 2 3 0 102 255\n".to_vec()).expect("two points");
    assert_eq!(cloud.colors.expect("colours").rgb, RGB);
    let file = ply(&["uchar red", "uchar green", "uchar blue"], ["255 0 51", "0 102 255"]);
    let cloud: PointCloud<2> = PointFormat::Ply.read(file.into_bytes()).expect("two points");
    assert_eq!(cloud.colors.expect("colours").rgb, RGB);
}

/// Returns a PCD file of two points and one without return between them.
fn pcd(encoding: &str, kind: &str) -> Vec<u8> {
    let header = format!(
        "VERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F {kind}\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\n\
         DATA {encoding}\n"
    );
    // Bytes that are no number if they are taken for one, because the program counts opacity as well.
    let packed = [u32::from_be_bytes([255, 255, 0, 51]), 0xff80_8080, u32::from_be_bytes([255, 0, 102, 255])];
    let points = [[0.0, 0.0, 0.0], [f32::NAN; 3], [1.0, 2.0, 3.0]];
    let mut file = header.into_bytes();
    match encoding {
        "binary" => {
            for (point, color) in points.iter().zip(packed) {
                point.iter().for_each(|x| file.extend(x.to_le_bytes()));
                file.extend(color.to_le_bytes());
            }
        }
        "binary_compressed" => {
            let mut data: Vec<u8> = (0..3).flat_map(|axis| points.map(|p| p[axis].to_le_bytes())).flatten().collect();
            data.extend(packed.iter().flat_map(|color| color.to_le_bytes()));
            // Literal runs alone.
            let runs: Vec<u8> = data.chunks(32).flat_map(|run| [&[run.len() as u8 - 1], run].concat()).collect();
            file.extend((runs.len() as u32).to_le_bytes());
            file.extend((data.len() as u32).to_le_bytes());
            file.extend(runs);
        }
        _ => {
            for (point, color) in points.iter().zip(packed) {
                // Without opacity, as the library writes it.
                let color = color & 0xff_ffff;
                let color = if kind == "F" { format!("{:e}", f32::from_bits(color)) } else { color.to_string() };
                file.extend(format!("{} {} {} {color}\n", point[0], point[1], point[2]).into_bytes());
            }
        }
    }
    file
}

#[test]
fn pcd_has_colors_in_the_bits_of_a_number() {
    for encoding in ["ascii", "binary", "binary_compressed"] {
        for kind in ["F", "U", "I"] {
            assert_eq!(colors(PointFormat::Pcd, pcd(encoding, kind)), rgb(), "{encoding} {kind}");
        }
    }
}

#[test]
fn pcd_has_intensities_and_normals() {
    let header = |fields: &str, n: usize| {
        let [size, kind, count] = [" 4", " F", " 1"].map(|word| word.repeat(n));
        format!("FIELDS {fields}\nSIZE{size}\nTYPE{kind}\nCOUNT{count}\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n")
    };
    let file = header("x y z intensity", 4) + "0 0 0 3\n1 2 3 nan\n";
    assert_eq!(colors(PointFormat::Pcd, file), Some((ColorSource::Intensity, vec![[255; 3], [0; 3]])));
    let file = header("x y z normal_x normal_y normal_z", 6) + "0 0 0 0 0 1\n1 2 3 -1 0 0\n";
    assert_eq!(colors(PointFormat::Pcd, file), Some((ColorSource::Normals, vec![[128, 128, 255], [0, 128, 128]])));
    // A row without them was read before there were colours.
    let file = header("x y z intensity", 4) + "0 0 0 3\n1 2 3\n";
    assert_eq!(colors(PointFormat::Pcd, file), Some((ColorSource::Intensity, vec![[255; 3], [0; 3]])));
}

#[test]
fn las_and_laz_have_colors_of_16_and_of_8_bits() {
    let count = las_points().len();
    let expected: Vec<[u8; 3]> = (0..count).map(|i| [i as u8, 255 - i as u8, 7]).collect();
    let words = |i: u16| (i, [i & 255, 255 - (i & 255), 7].map(|x| 257 * x));
    let bytes = |i: u16| (i, [i & 255, 255 - (i & 255), 7]);
    for format in [2, 3, 7, 8] {
        for is_compressed in [false, true] {
            for file in [las_with(format, is_compressed, 2, words), las_with(format, is_compressed, 0, bytes)] {
                let found = colors(PointFormat::Las, file);
                assert_eq!(found, Some((ColorSource::Rgb, expected.clone())), "{format} {is_compressed}");
            }
        }
    }
}

#[test]
fn las_and_laz_without_colors_have_intensities() {
    for format in [0, 1, 2, 3, 6, 7] {
        for is_compressed in [false, true] {
            let file = las_with(format, is_compressed, 0, |i| (100 * i, [0; 3]));
            let (source, rgb) = colors(PointFormat::Las, file).expect("intensities");
            assert_eq!(source, ColorSource::Intensity);
            assert_eq!((rgb[0], rgb[299]), ([0; 3], [255; 3]), "{format} {is_compressed}");
            assert!(rgb.is_sorted());
            assert_eq!(colors(PointFormat::Las, las_with(format, is_compressed, 0, |_| (9, [0; 3]))), None);
        }
    }
}

/// A scan with more columns, of one type, whose values in each row are given.
fn scan(names: &[RecordName], data_type: &RecordDataType, rows: &[&[RecordValue]]) -> Scan {
    let mut scan = e57_single(&POINTS[..rows.len()]);
    let kinds = names.iter().map(|name| Record { name: name.clone(), data_type: data_type.clone() });
    scan.columns.extend(kinds);
    for (row, values) in scan.rows.iter_mut().zip(rows) {
        row.extend(values.iter().cloned());
    }
    scan
}

#[test]
fn e57_has_colors_within_the_limits_of_their_columns() {
    use RecordName::{ColorBlue, ColorGreen, ColorRed};
    let names = [ColorRed, ColorGreen, ColorBlue];
    let whole = |values: [i64; 3]| values.map(RecordValue::Integer);
    let bytes = RecordDataType::Integer { min: 0, max: 255 };
    let file = e57(&[scan(&names, &bytes, &[&whole([255, 0, 51]), &whole([0, 102, 255])])]);
    assert_eq!(colors(PointFormat::E57, file), rgb());
    let shifted = RecordDataType::Integer { min: 1000, max: 1510 };
    let file = e57(&[scan(&names, &shifted, &[&whole([1510, 1000, 1102]), &whole([1000, 1204, 1510])])]);
    assert_eq!(colors(PointFormat::E57, file), rgb());
    let fractions = RecordDataType::Single { min: Some(0.0), max: Some(1.0) };
    let single = |values: [f32; 3]| values.map(RecordValue::Single);
    let file = e57(&[scan(&names, &fractions, &[&single([1.0, 0.0, 0.2]), &single([0.0, 0.4, 1.0])])]);
    assert_eq!(colors(PointFormat::E57, file), rgb());
    // Another scan without any.
    let file = e57(&[scan(&names, &bytes, &[&whole([255, 0, 51]), &whole([0, 102, 255])]), e57_single(&POINTS[..1])]);
    assert_eq!(colors(PointFormat::E57, file), Some((ColorSource::Rgb, [&RGB[..], &[[0; 3]]].concat())));
}

#[test]
fn e57_says_which_colors_mean_nothing_and_points_without_return_have_none() {
    use RecordName::{CartesianInvalidState, ColorBlue, ColorGreen, ColorRed, IsColorInvalid};
    let mut scan = e57_single(&POINTS[..4]);
    scan.columns.extend(columns([ColorRed, ColorGreen, ColorBlue], &RecordDataType::Integer { min: 0, max: 255 }));
    scan.columns.extend(columns([IsColorInvalid], &RecordDataType::Integer { min: 0, max: 1 }));
    scan.columns.extend(columns([CartesianInvalidState], &RecordDataType::Integer { min: 0, max: 2 }));
    let rows = [[255, 0, 51, 0, 0], [9, 9, 9, 0, 2], [9, 9, 9, 1, 0], [0, 102, 255, 0, 0]];
    for (row, values) in scan.rows.iter_mut().zip(rows) {
        row.extend(values.map(RecordValue::Integer));
    }
    let expected = vec![RGB[0], [0; 3], RGB[1]];
    assert_eq!(colors(PointFormat::E57, e57(&[scan])), Some((ColorSource::Rgb, expected)));
}

#[test]
fn e57_has_intensities() {
    let limits = RecordDataType::Double { min: Some(-2048.0), max: Some(2047.0) };
    let mut scan = e57_single(&POINTS[..2]);
    scan.columns.extend(columns([RecordName::Intensity], &limits));
    for (row, value) in scan.rows.iter_mut().zip([-2048.0, 100.0]) {
        row.push(RecordValue::Double(value));
    }
    let grey = Some((ColorSource::Intensity, vec![[0; 3], [255; 3]]));
    assert_eq!(colors(PointFormat::E57, e57(&[scan])), grey);
}
