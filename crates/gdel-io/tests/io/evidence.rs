//! The normals of points and the positions of sensors, in every format that has some.

use crate::samples::{Scan, e57, e57_scaled, e57_single, e57_spherical};
use ::e57::{Extension, Record, RecordDataType, RecordName, RecordValue};
use gdel_io::{PointCloud, PointFormat};
use std::io::Cursor;

fn read(format: PointFormat, bytes: impl Into<Vec<u8>>) -> PointCloud {
    let cloud: PointCloud = format.read(bytes.into()).expect("a valid file");
    assert!(cloud.normals.as_ref().is_none_or(|normals| normals.len() == cloud.points.len()));
    assert!(cloud.sensors.len() < 2 || cloud.sensors.len() == cloud.points.len());
    cloud
}

fn normals(format: PointFormat, bytes: impl Into<Vec<u8>>) -> Option<Vec<[f32; 3]>> {
    read(format, bytes).normals
}

/// Two normals, of which the second is unknown.
fn one() -> Option<Vec<[f32; 3]>> {
    Some(vec![[0.0, -0.6, 0.8], [0.0; 3]])
}

#[test]
fn ply_has_normals_of_any_length() {
    let file = |rows: [&str; 2]| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
             property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\n\
             property uchar blue\nend_header\n0 0 0 {} 1 2 3\n1 2 3 {} 4 5 6\n",
            rows[0], rows[1]
        )
    };
    for second in ["0 0 0", "nan nan nan", "inf 0 0"] {
        let cloud = read(PointFormat::Ply, file(["0 -3 4", second]));
        assert_eq!(cloud.normals, one(), "{second}");
        assert!(cloud.colors.is_some() && cloud.sensors.is_empty());
    }
    assert_eq!(normals(PointFormat::Ply, file(["0 0 0", "0 0 0"])), None);
}

#[test]
fn text_has_normals_by_name_or_by_their_length() {
    assert_eq!(normals(PointFormat::Csv, "x,y,z,nx,ny,nz\n0,0,0,0,-3,4\n1,2,3,,,\n"), one());
    assert_eq!(normals(PointFormat::Text, "X Y Z Normal_X Normal_Y Normal_Z\n0 0 0 0 -3 4\n1 2 3 0 0 0\n"), one());
    assert_eq!(normals(PointFormat::Text, "0 0 0 0 -0.6 0.8\n1 2 3 0 0 0\n"), one());
    // Six numbers of which some are of another length are no normals.
    assert_eq!(normals(PointFormat::Text, "0 0 0 0 -0.6 0.8\n1 2 3 0 2 0\n"), None);
    assert_eq!(normals(PointFormat::Text, "0 0 0 17 0 1\n1 2 3 0 0 1\n"), None);
    assert_eq!(normals(PointFormat::Text, "0 0 0 0 -0.6 0.8 5\n1 2 3 0 0 0 6\n"), one());
}

#[test]
fn obj_has_normals_where_each_vertex_has_its_own() {
    let points = "v 0 0 0\nv 1 2 3\n";
    let vectors = "vn 0 -3 4\nvn 0 0 0\n";
    assert_eq!(normals(PointFormat::Obj, format!("{points}{vectors}")), one());
    assert_eq!(normals(PointFormat::Obj, format!("{points}{vectors}f 1//1 2//2 1//1\n")), one());
    assert_eq!(
        normals(PointFormat::Obj, format!("{points}{vectors}f 1/7/1 2/8/2 1/7/1\nf 1 2 1\nf 1/2 2/1 1/1\n")),
        one()
    );
    for other in ["f 1//2 2//1 1//1\n", "vn 0 0 1\n"] {
        assert_eq!(normals(PointFormat::Obj, format!("{points}{vectors}{other}")), None, "{other}");
    }
    assert_eq!(normals(PointFormat::Obj, points), None);
}

#[test]
fn pcd_has_normals_and_a_viewpoint() {
    let file = |width: usize, height: usize, viewpoint: &str, normal: &str| {
        let n = width * height;
        let rows: String = (0..n).map(|i| format!("{i} 2 3 {normal}\n")).collect();
        format!(
            "VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\n\
             COUNT 1 1 1 1 1 1\nWIDTH {width}\nHEIGHT {height}\n{viewpoint}POINTS {n}\nDATA ascii\n{rows}"
        )
    };
    let origin = "VIEWPOINT 0 0 0 1 0 0 0\n";
    let cloud = read(PointFormat::Pcd, file(2, 1, "VIEWPOINT 1.5 -2 3 1 0 0 0\n", "0 -3 4"));
    assert_eq!((cloud.normals, cloud.sensors), (Some(vec![[0.0, -0.6, 0.8]; 2]), vec![[1.5, -2.0, 3.0]]));
    // Clouds of many scans have the origin, too.
    let sensors = |width, height, viewpoint| read(PointFormat::Pcd, file(width, height, viewpoint, "nan 0 0")).sensors;
    assert_eq!(sensors(6, 1, origin), [[0.0; 3]; 0]);
    assert_eq!(sensors(3, 2, origin), [[0.0; 3]]);
    assert_eq!(sensors(3, 2, ""), [[0.0; 3]; 0]);
    for broken in ["VIEWPOINT\n", "VIEWPOINT 1 2\n", "VIEWPOINT 1 2 x 4\n", "VIEWPOINT 1 inf 2 1 0 0 0\n"] {
        assert_eq!(sensors(3, 2, broken), [[0.0; 3]; 0], "{broken}");
    }
    assert_eq!(normals(PointFormat::Pcd, file(2, 1, origin, "nan 0 0")), None);
}

/// A file of one scan with normals, in the extension of the format that has them.
fn e57_with_normals(pose: Option<([f64; 4], [f64; 3])>) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = ::e57::E57Writer::new(&mut file, "file").expect("memory");
    writer
        .register_extension(Extension::new("nor", "http://www.libe57.org/E57_NOR_surface_normals.txt"))
        .expect("an extension");
    let mut columns = vec![Record::CARTESIAN_X_F32, Record::CARTESIAN_Y_F32, Record::CARTESIAN_Z_F32];
    columns.extend(["normalX", "normalY", "normalZ"].map(|name| Record {
        name: RecordName::Unknown { namespace: "nor".into(), name: name.into() },
        data_type: RecordDataType::F32,
    }));
    let mut scan = writer.add_pointcloud("scan", columns).expect("columns");
    scan.set_transform(pose.map(|([x, y, z, w], [u, v, t])| ::e57::Transform {
        rotation: ::e57::Quaternion { w, x, y, z },
        translation: ::e57::Translation { x: u, y: v, z: t },
    }));
    for row in [[0.0, 0.0, 0.0, 0.0, -3.0, 4.0], [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]] {
        scan.add_point(row.map(RecordValue::Single).to_vec()).expect("values of the columns");
    }
    scan.finalize().expect("memory");
    writer.finalize().expect("memory");
    drop(writer);
    file.into_inner()
}

#[test]
fn e57_has_normals_that_turn_with_their_scan() {
    assert_eq!(normals(PointFormat::E57, e57_with_normals(None)), one());
    // x to y, y to z, z to x.
    let cloud = read(PointFormat::E57, e57_with_normals(Some(([0.5; 4], [7.0, 8.0, 9.0]))));
    assert_eq!((cloud.normals, cloud.sensors), (Some(vec![[0.8, 0.0, -0.6], [0.0; 3]]), vec![[7.0, 8.0, 9.0]]));
}

#[test]
fn e57_has_a_scanner_where_there_are_poses() {
    let sensors = |scans: &[Scan]| read(PointFormat::E57, e57(scans)).sensors;
    let identity = Some(([0.0, 0.0, 0.0, 1.0], [0.0; 3]));
    let scan = |pose| Scan { pose, ..e57_single(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]) };
    assert_eq!(sensors(&[scan(None)]), [[0.0; 3]; 0]);
    // Programs give clouds of many scans a pose, too.
    assert_eq!(sensors(&[scan(identity)]), [[0.0; 3]; 0]);
    let moved = Some(([0.0, 0.0, 0.0, 1.0], [1.0, 0.0, -2.0]));
    assert_eq!(sensors(&[scan(moved)]), [[1.0, 0.0, -2.0]]);
    // The first scan has the coordinates of the file.
    let both = [[0.0; 3], [0.0; 3], [1.0, 0.0, -2.0], [1.0, 0.0, -2.0]];
    assert_eq!(sensors(&[scan(identity), scan(moved)]), both);
    assert_eq!(sensors(&[scan(None), scan(moved)]), [[0.0; 3]; 0]);
    assert_eq!(sensors(&[e57_spherical()]), [[0.0; 3]]);
    // Points without return have no sensor.
    assert_eq!(sensors(&[e57_scaled()]), [[1.0, 2.0, 3.0]]);
    assert_eq!(sensors(&[e57_scaled(), e57_spherical()]).len(), 203);
    assert_eq!(sensors(&[]), [[0.0; 3]; 0]);
}

#[test]
fn flat_points_have_normals_and_sensors_of_two_coordinates() {
    let cloud: PointCloud<2> =
        PointFormat::E57.read(e57_with_normals(Some(([0.5; 4], [7.0, 8.0, 9.0])))).expect("a file");
    assert_eq!((cloud.normals, cloud.sensors), (Some(vec![[0.8, 0.0], [0.0; 2]]), vec![[7.0, 8.0]]));
    let cloud: PointCloud<2> = PointFormat::Text.read(b"0 0 0 0 -0.6 0.8\n1 2 3 0 0 0\n".to_vec()).expect("a file");
    assert_eq!(cloud.normals, Some(vec![[0.0, -0.6], [0.0; 2]]));
}
