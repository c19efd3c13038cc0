//! Small valid files of every format: written by hand, or by other crates than those that read
//! them.
#![allow(dead_code)]

use e57::{E57Writer, Quaternion, Record, RecordDataType, RecordName, RecordValue, Translation};
use gdel::{Mesh2, Mesh3};
use gdel_io::{MeshFormat, PointFormat, ShapeFormat, write_ele, write_neigh, write_npz, write_vtu};
use las::{Builder, Point, Transform, Vector};
use std::io::Cursor;

/// Four corners of a tetrahedron and a point inside, with numbers that single precision holds.
pub const POINTS: [[f32; 3]; 5] =
    [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, -2.25, 0.0], [0.0, 0.0, 1e-3], [0.1, -0.1, 1e-4]];

/// [`POINTS`] in double precision.
pub fn points_f64() -> Vec<[f64; 3]> {
    POINTS.iter().map(|p| p.map(f64::from)).collect()
}

/// A mesh of [`POINTS`].
pub fn mesh() -> Mesh3 {
    gdel::delaunay3d(&POINTS).expect("five points")
}

/// All samples of point clouds, each with a name.
/// The header of a scan of two columns and three rows, turned by 90° around z, and moved.
pub const PTX_HEADER: &str = "2\n3\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n";

/// Two scans; in the first, the scanner saw nothing in one direction.
pub fn ptx() -> String {
    let first =
        "1 0 0 0.5 255 0 0\n0 0 0 0.5 0 0 0\n0 1 0 0.25 0 255 0\n0 0 1 1 0 0 255\n1 1 0 0 9 9 9\n2 0 0 0 9 9 9\n";
    let second = PTX_HEADER.replace("2\n3\n10 20 30\n", "1\n1\n0 0 0\n").replace("10 20 30 1\n", "0 0 0 1\n");
    format!("{PTX_HEADER}{first}{second}3 4 5 0.125 1 2 3\n")
}

pub fn point_clouds() -> Vec<(PointFormat, &'static str, Vec<u8>)> {
    use PointFormat::*;
    let mut samples = vec![
        (Ply, "ascii", ply("ascii", "float")),
        (Ply, "little endian", ply("binary_little_endian", "double")),
        (Ply, "big endian", ply("binary_big_endian", "float")),
        (Obj, "", b"# cube\nmtllib a.mtl\nv 0 0 0\nv 1 0 0 1.0\nvt 0 0\nv\t0 1 -1e-3\nf 1/1 2/1 3/1\n".to_vec()),
        (Stl, "ascii", ascii_stl().into()),
        (Stl, "binary", binary_stl(b"solid but binary")),
        (Text, "xyz", b"# x y z\r\n1 2 3 255 0 0\r\n\r\n-4.5e-3\t5 6 1 2 3\r\n".to_vec()),
        (Text, "pts", b"2\n1 2 3 0.5 1 2 3\n4 5 6 0.5 1 2 3\n1\n7 8 9 0.5 1 2 3".to_vec()),
        (Csv, "named", b"id,y,z,x\n\"a,b\",2,3,1\n2, 5 ,6,4\n".to_vec()),
        (Csv, "bare", b"1;2;3\n4;5;6\n".to_vec()),
        (Ptx, "", ptx().into()),
        (Pcd, "ascii", pcd_ascii().into()),
        (Pcd, "binary", pcd("binary", &POINTS)),
        (Pcd, "compressed", pcd("binary_compressed", &POINTS)),
        (Npy, "", npy(&POINTS)),
        (Off, "", OFF.into()),
        (Node, "", b"# Node\n3 3 1 1\n1 0 0 0.5 7 1\n2 1 0 0 8 0 # two\n3 0 1e-3 0 9 0\n# Generated\n".to_vec()),
        (RawF32, "", POINTS.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect()),
        (RawF64, "", points_f64().as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect()),
    ];
    for format in [0, 3, 6, 7] {
        samples.push((Las, "las", las(format, false, 0)));
        samples.push((Las, "laz", las(format, true, 2)));
    }
    samples.push((E57, "single", e57(&[e57_single(&POINTS)])));
    samples.push((E57, "scans", e57(&[e57_scaled(), e57_spherical()])));
    samples
}

/// Weights that hide the last of [`POINTS`].
pub const WEIGHTS: [f64; 5] = [1.0, 1.0, 1.0, 1.0, -9.0];

/// The mesh of [`POINTS`] with [`WEIGHTS`].
pub fn weighted_mesh() -> Mesh3 {
    gdel::Triangulator::new().regular3d(&POINTS, &WEIGHTS).expect("five points")
}

/// All samples of meshes.
pub fn meshes() -> Vec<(MeshFormat, &'static str, Vec<u8>)> {
    let weighted = weighted_mesh();
    let [mut weighted_vtu, mut weighted_npz] = [const { Vec::new() }; 2];
    write_vtu(&mut weighted_vtu, (&POINTS).into(), &weighted).expect("memory");
    write_npz(&mut weighted_npz, (&POINTS).into(), &weighted).expect("memory");
    let mesh = mesh();
    let [mut ele, mut vtu, mut npz] = [const { Vec::new() }; 3];
    write_ele(&mut ele, &mesh).expect("memory");
    write_vtu(&mut vtu, (&POINTS).into(), &mesh).expect("memory");
    write_npz(&mut npz, (&POINTS).into(), &mesh).expect("memory");
    vec![
        (MeshFormat::TetGen, "", ele),
        (MeshFormat::Vtu, "appended", vtu),
        (MeshFormat::Vtu, "ascii", VTU_ASCII.into()),
        (MeshFormat::Vtu, "zlib", VTU_ZLIB.into()),
        (MeshFormat::Npz, "", npz),
        (MeshFormat::Vtu, "weighted", weighted_vtu),
        (MeshFormat::Npz, "weighted", weighted_npz),
    ]
}

/// Samples of 2D meshes.
pub fn meshes2() -> Vec<(MeshFormat, &'static str, Vec<u8>)> {
    let (points, mesh) = mesh2();
    let [mut ele, mut vtu, mut npz] = [const { Vec::new() }; 3];
    write_ele(&mut ele, &mesh).expect("memory");
    write_vtu(&mut vtu, (&points).into(), &mesh).expect("memory");
    write_npz(&mut npz, (&points).into(), &mesh).expect("memory");
    vec![(MeshFormat::TetGen, "", ele), (MeshFormat::Vtu, "", vtu), (MeshFormat::Npz, "", npz)]
}

fn mesh2() -> (Vec<[f64; 2]>, Mesh2) {
    let points = vec![[0.0, 0.0], [4.0, 0.0], [0.0, 3.0], [5.0, 5.0], [1.0, 1.0]];
    let mesh = gdel::delaunay2d(&points).expect("five points");
    (points, mesh)
}

/// Shapes in all formats: a square with a hole, a line, and what else a format has.
pub fn shapes() -> Vec<(ShapeFormat, Vec<u8>)> {
    vec![(ShapeFormat::GeoJson, GEOJSON.into()), (ShapeFormat::Svg, SVG.into()), (ShapeFormat::Poly, POLY.into())]
}

/// GeoJSON with all of its kinds of geometries.
pub const GEOJSON: &str = r#"{"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"name": "a"}, "id": 1, "geometry": {"type": "Polygon", "coordinates": [
    [[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5], [0, 0, 5]], [[3, 3], [3, 6], [6, 6], [3, 3]]]}},
  {"type": "Feature", "properties": null, "geometry": null},
  {"type": "Feature", "properties": null, "geometry": {"type": "GeometryCollection", "geometries": [
    {"type": "Point", "coordinates": [1, 1]},
    {"type": "MultiPoint", "coordinates": [[0.5, 2], [1e-3, -2.5e2]]},
    {"type": "LineString", "coordinates": [[1, 1], [2, 1], [2, 2], [1, 1]]},
    {"type": "MultiLineString", "coordinates": [[], [[20, 0], [20, 1]]]},
    {"type": "MultiPolygon", "coordinates": [[[[30, 0], [31, 0], [30, 1], [30, 0]]], []]}]}}]}
"#;

/// SVG with all shapes, transforms, and things that are left out.
pub const SVG: &str = r##"<?xml version="1.0"?>
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 40">
  <defs><path id="p" d="M0 0h1v1z"/></defs>
  <path d="M0 0h9v9h-9z m3 3v3h3z"/>
  <g transform="translate(10 20) scale(2)"><rect x="1" y="1" width="2" height="3"/><line x2="1" y2="1"/></g>
  <g style="display: none"><rect width="1" height="1"/></g>
  <rect x="20" y="1" width="8" height="6" rx="2"/>
  <circle cx="20" cy="20" r="3"/><ellipse cx="30" cy="20" rx="2px" ry="1mm" transform="rotate(30 30 20)"/>
  <polygon points="1,30 2,30 2,31"/><polyline points="5 30 6 30 6 31"/>
  <path d="M10 30C12 28 14 32 16 30S18 32 20 30Q22 28 24 30T28 30A3 2 10 0 1 32 31"/>
  <use href="#p"/><text>text</text><text>more</text>
</svg>
"##;

/// A box with a hole and a region.
pub const POLY: &str = "# box
8 2 0 1
1 0 0 7
2 9 0 7
3 9 9 7
4 0 9 7
5 3 3 0
6 6 3 0
7 6 6 0
8 3 6 0

    8 1
1 1 2 1
2 2 3 1
3 3 4 1
4 4 1 1
5 5 6 2
6 6 7 2
7 7 8 2
8 8 5 2
1 # hole
1 4.5 4.5
1
1 1 1 7 0.1
";

/// The `.neigh` files of a 3D and of a 2D mesh.
pub fn neighbors() -> [Vec<u8>; 2] {
    let [mut of_3d, mut of_2d] = [const { Vec::new() }; 2];
    write_neigh(&mut of_3d, &mesh()).expect("memory");
    write_neigh(&mut of_2d, &mesh2().1).expect("memory");
    [of_3d, of_2d]
}

/// PLY with an element before the vertices, a list among their properties, and faces after them.
pub fn ply(format: &str, number: &str) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat {format} 1.0\ncomment made by hand\nobj_info none\nelement camera 2\nproperty list uchar short path\n\
         property double zoom\nelement vertex 5\nproperty uchar red\nproperty {number} x\nproperty {number} y\n\
         property list int float weights\nproperty {number} z\nproperty short layer\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    if format == "ascii" {
        file.extend(b"2 7 8 1.5\n0 -2e3\n");
        for [x, y, z] in POINTS {
            file.extend(format!("255 {x} {y} 2 0.5 0.25 {z} -3\n").bytes());
        }
        // No line end after the last line.
        file.extend(b"3 0 1 2");
        return file;
    }
    let is_big = format == "binary_big_endian";
    let mut put = |bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        if is_big {
            bytes.reverse();
        }
        file.extend(bytes);
    };
    put(&[2]);
    put(&7i16.to_le_bytes());
    put(&8i16.to_le_bytes());
    put(&1.5f64.to_le_bytes());
    put(&[0]);
    put(&(-2e3f64).to_le_bytes());
    for [x, y, z] in POINTS {
        let coordinate = |x: f32| match number {
            "float" => x.to_le_bytes().to_vec(),
            _ => f64::from(x).to_le_bytes().to_vec(),
        };
        put(&[255]);
        put(&coordinate(x));
        put(&coordinate(y));
        put(&2i32.to_le_bytes());
        put(&0.5f32.to_le_bytes());
        put(&0.25f32.to_le_bytes());
        put(&coordinate(z));
        put(&(-3i16).to_le_bytes());
    }
    put(&[3]);
    (0..3i32).for_each(|v| put(&v.to_le_bytes()));
    file
}

/// The tetrahedron of the first four points, in two solids, the first without a name.
pub fn ascii_stl() -> String {
    let facet = |t: [usize; 3]| {
        let vertices: String =
            t.iter().map(|&v| format!("vertex {:?} {:?} {:?}\n", POINTS[v][0], POINTS[v][1], POINTS[v][2])).collect();
        format!("facet normal 0 0 0\n outer loop\n{vertices} endloop\nendfacet\n")
    };
    let [a, b, c, d] = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(facet);
    format!("solid\n{a}{b}endsolid\nSOLID two words\n{c}{d}ENDSOLID\n")
}

/// Two triangles of the first four points.
pub fn binary_stl(header: &[u8]) -> Vec<u8> {
    let mut file = header.to_vec();
    file.resize(80, b' ');
    file.extend(2u32.to_le_bytes());
    for triangle in [[0, 1, 2], [0, 3, 1]] {
        file.extend([0; 12]);
        file.extend(triangle.iter().flat_map(|&v: &usize| POINTS[v]).flat_map(f32::to_le_bytes));
        file.extend([0; 2]);
    }
    file
}

/// PCD by the crate `pcd-rs`, with fields around the coordinates.
pub fn pcd(encoding: &str, points: &[[f32; 3]]) -> Vec<u8> {
    use pcd_rs::{DataKind, DynRecord, Field, Schema, ValueKind, ViewPoint, WriterInit};
    let mut file = Cursor::new(Vec::new());
    let init = WriterInit {
        width: points.len() as u64,
        height: 1,
        viewpoint: ViewPoint::default(),
        data_kind: if encoding == "binary" { DataKind::Binary } else { DataKind::BinaryCompressed },
        schema: Some(Schema::from_iter([
            ("intensity", ValueKind::U16, 1),
            ("x", ValueKind::F32, 1),
            ("y", ValueKind::F32, 1),
            ("normal", ValueKind::F64, 2),
            ("z", ValueKind::F32, 1),
        ])),
        version: None,
    };
    let mut writer: pcd_rs::Writer<DynRecord, _> = init.build_from_writer(&mut file).expect("memory");
    for &[x, y, z] in points {
        let fields = [
            Field::U16(vec![7]),
            Field::F32(vec![x]),
            Field::F32(vec![y]),
            Field::F64(vec![0.5, 2.0]),
            Field::F32(vec![z]),
        ];
        writer.push(&DynRecord(fields.into())).expect("memory");
    }
    writer.finish().expect("memory");
    file.into_inner()
}

/// Three points and a NaN.
pub fn pcd_ascii() -> &'static str {
    "# .PCD v.7\nVERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 2\n\
     VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA ascii\n0.1 0.2 0.3 1\nnan nan nan 0\n4 5 6 2\n7 8 9 3\n"
}

/// A NumPy array by the crate `npyz`.
pub fn npy(points: &[[f32; 3]]) -> Vec<u8> {
    use npyz::WriterBuilder;
    let mut file = Vec::new();
    let mut writer = npyz::WriteOptions::new()
        .default_dtype()
        .shape(&[points.len() as u64, 3])
        .writer(&mut file)
        .begin_nd()
        .expect("memory");
    writer.extend(points.as_flattened().iter().copied()).expect("memory");
    writer.finish().expect("memory");
    file
}

/// The coordinates of [`las`].
pub fn las_points() -> Vec<[f64; 3]> {
    (0..300)
        .map(|i| [500_000.0 + f64::from(i % 17) * 0.25, 4_500_000.0 + f64::from(i * i % 31) * 0.5, f64::from(i)])
        .collect()
}

/// LAS or LAZ with [`las_points`], which the scale of 1/8 holds exactly.
pub fn las(format: u8, is_compressed: bool, extra_bytes: u16) -> Vec<u8> {
    las_with(format, is_compressed, extra_bytes, |_| (0, [0; 3]))
}

/// The same, with an intensity and a colour for each point.
pub fn las_with(format: u8, is_compressed: bool, extra_bytes: u16, look: impl Fn(u16) -> (u16, [u16; 3])) -> Vec<u8> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = las::point::Format::new(format).expect("a format");
    builder.point_format.is_compressed = is_compressed;
    builder.point_format.extra_bytes = extra_bytes;
    let axis = |offset| Transform { scale: 0.125, offset };
    builder.transforms = Vector { x: axis(500_000.0), y: axis(4_500_000.0), z: axis(0.0) };
    let has = builder.point_format;
    let mut writer =
        las::Writer::new(Cursor::new(Vec::new()), builder.into_header().expect("a header")).expect("memory");
    for (i, [x, y, z]) in (0..).zip(las_points()) {
        let (intensity, [red, green, blue]) = look(i);
        let point = Point {
            intensity,
            x,
            y,
            z,
            gps_time: has.has_gps_time.then_some(x),
            color: has.has_color.then_some(las::Color { red, green, blue }),
            nir: has.has_nir.then_some(1),
            extra_bytes: vec![9; extra_bytes.into()],
            ..Default::default()
        };
        writer.write_point(point).expect("memory");
    }
    writer.into_inner().expect("memory").into_inner()
}

/// A scan of an E57 file.
pub struct Scan {
    pub columns: Vec<Record>,
    pub rows: Vec<Vec<RecordValue>>,
    /// The rotation as x, y, z, w, and the translation.
    pub pose: Option<([f64; 4], [f64; 3])>,
}

/// Returns a file of scans, by the crate `e57`.
pub fn e57(scans: &[Scan]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut file, "file").expect("memory");
    for Scan { columns, rows, pose } in scans {
        let mut scan = writer.add_pointcloud("scan", columns.clone()).expect("columns");
        scan.set_transform(pose.map(|([x, y, z, w], [u, v, t])| e57::Transform {
            rotation: Quaternion { w, x, y, z },
            translation: Translation { x: u, y: v, z: t },
        }));
        rows.iter().for_each(|row| scan.add_point(row.clone()).expect("values of the columns"));
        scan.finalize().expect("memory");
    }
    writer.finalize().expect("memory");
    drop(writer);
    file.into_inner()
}

/// Returns columns of an E57 file, all of one type.
pub fn columns<const N: usize>(names: [RecordName; N], data_type: &RecordDataType) -> Vec<Record> {
    names.into_iter().map(|name| Record { name, data_type: data_type.clone() }).collect()
}

/// Returns a scan in single precision.
pub fn e57_single(points: &[[f32; 3]]) -> Scan {
    Scan {
        columns: vec![Record::CARTESIAN_X_F32, Record::CARTESIAN_Y_F32, Record::CARTESIAN_Z_F32],
        rows: points.iter().map(|p| p.map(RecordValue::Single).to_vec()).collect(),
        pose: None,
    }
}

/// Returns a scan of (*i* / 8, -*i*, 2 *i*), where every third point has no return, in whole numbers
/// of 11 and 2 bits. Its pose turns *x* to *y*, *y* to *z* and *z* to *x*, and moves by (1, 2, 3).
pub fn e57_scaled() -> Scan {
    use RecordName::*;
    let axis = |scale| RecordDataType::ScaledInteger { min: -1000, max: 1000, scale, offset: 0.0 };
    let axes = [(CartesianX, 0.125), (CartesianY, -1.0), (CartesianZ, 2.0)];
    let mut columns: Vec<Record> =
        axes.into_iter().map(|(name, scale)| Record { name, data_type: axis(scale) }).collect();
    columns.push(Record::CARTESIAN_INVALID_STATE);
    columns.extend([Record::COLOR_RED_U8, Record::COLOR_GREEN_U8, Record::COLOR_BLUE_U8]);
    let row = |i: i64| {
        let state = if i % 3 == 2 { 1 + i % 2 } else { 0 };
        let color = [i % 256, 255 - i % 256, 7].map(RecordValue::Integer);
        let mut row = vec![RecordValue::ScaledInteger(i); 3];
        row.push(RecordValue::Integer(state));
        row.extend(color);
        row
    };
    // A quaternion that is not quite of length 1, as files have it.
    Scan { columns, rows: (0..300).map(row).collect(), pose: Some(([2.0; 4], [1.0, 2.0, 3.0])) }
}

/// Returns a scan of four points by range, azimuth and elevation, one of which has no return.
pub fn e57_spherical() -> Scan {
    use RecordName::*;
    use std::f64::consts::FRAC_PI_2;
    let mut columns = columns([SphericalRange, SphericalAzimuth, SphericalElevation], &RecordDataType::F64);
    columns.push(Record::SPHERICAL_INVALID_STATE);
    let rows = [([2.0, 0.0, 0.0], 0), ([3.0, FRAC_PI_2, 0.0], 0), ([9.0, 1.0, 1.0], 2), ([4.0, 1.0, -FRAC_PI_2], 0)];
    let row = |(point, state): ([f64; 3], i64)| {
        point.map(RecordValue::Double).into_iter().chain([RecordValue::Integer(state)]).collect()
    };
    Scan { columns, rows: rows.map(row).to_vec(), pose: None }
}

/// Writes the checksums of E57's pages anew: what damages a file would else never get past them.
pub fn write_checksums(file: &mut [u8]) {
    for page in file.as_chunks_mut::<1024>().0 {
        let (data, checksum) = page.split_at_mut(1020);
        let crc = !data.iter().fold(!0u32, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0x82f6_3b78 } else { crc >> 1 })
        });
        checksum.copy_from_slice(&crc.to_be_bytes());
    }
}

/// A tetrahedron with colors, comments and all.
pub const OFF: &str = "# Geomview\nCOFF\n4 2 0\n0 0 0 255 0 0 255\n1 0 0 0 0 0 0 # comment\n\n0 1 0 1 1 1 1\n0 0 1e-3 0 0 0 0\n3 0 1 2\n3 0 1 3 0.5 0.5 0.5\n";

/// As other programs write it: ASCII, arrays in no particular order, point and cell data.
pub const VTU_ASCII: &str = r#"<?xml version="1.0"?>
<!-- by hand -->
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">
<UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2">
<PointData><DataArray type="Float32" Name="t" format="ascii">0 0 0 0.5 0</DataArray></PointData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points>
<Cells>
<DataArray type="UInt8" Name="types" format="ascii">10 10</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">4 8</DataArray>
<DataArray type="Int32" Name="connectivity" format="ascii">
0 1 2 3
1 2 3 4
</DataArray>
</Cells>
</Piece></UnstructuredGrid>
</VTKFile>
"#;

/// As meshio writes it: base64 of zlib.
pub const VTU_ZLIB: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian" header_type="UInt32" compressor="vtkZLibDataCompressor">
<UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2">
<Points><DataArray type="Float32" Name="Points" NumberOfComponents="3" format="binary">AQAAADwAAAAAAAAADAAAAA==eJxjYCAfAAAAPAAB</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="binary">AQAAAEAAAAAAAAAAFgAAAA==eJxjYIAARijNBKWZCYizQGkAAfAAEQ==</DataArray>
<DataArray type="Int64" Name="offsets" format="binary">AQAAABAAAAAAAAAADgAAAA==eJxjYYAADigNAACQAA0=</DataArray>
<DataArray type="UInt8" Name="types" format="binary">AQAAAAIAAAAAAAAACgAAAA==eJzj4gIAACAAFQ==</DataArray>
</Cells>
</Piece></UnstructuredGrid>
</VTKFile>
"#;
