//! Every format of meshes and hulls.

use crate::samples::{self, POINTS, mesh};
use gdel::{Mesh2, Mesh3, NONE, Points};
use gdel_io::{
    MeshData2, MeshData3, PointBuf, PointFormat, SurfaceFormat, read_ele, read_neigh, read_npz, read_vtu, write_ele,
    write_neigh, write_node, write_npz, write_vtu, write_weighted_node,
};
use std::io::{Cursor, Read};

fn written(write: impl FnOnce(&mut Vec<u8>) -> std::io::Result<()>) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes).expect("memory");
    bytes
}

#[test]
fn tetgen_files() {
    let mesh = mesh();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let node = text(written(|to| write_node(to, (&POINTS).into())));
    assert_eq!(node.lines().next(), Some("5 3 0 0"));
    assert_eq!(node.lines().nth(5), Some("4 0.10000000149011612 -0.10000000149011612 9.999999747378752e-5"));
    let ele = written(|to| write_ele(to, &mesh));
    assert_eq!(text(ele.clone()).lines().next(), Some("4 4 0"));
    assert_eq!(read_ele::<Mesh3, _, _>(&ele), Ok(mesh.tetrahedra.clone()));
    let neigh = written(|to| write_neigh(to, &mesh));
    assert_eq!(text(neigh.clone()).lines().next(), Some("4 4"));
    assert_eq!(read_neigh::<Mesh3, _, _>(&neigh), Ok(mesh.neighbors));
}

#[test]
fn tetgen_files_that_count_from_one() {
    assert_eq!(
        read_ele::<Mesh3, _, _>(b"# made by TetGen\n 2  4  0\n  1  1 2 3 4\n\n 2  2 3 4 5 # last\n"),
        Ok(vec![[0, 1, 2, 3], [1, 2, 3, 4]])
    );
    assert_eq!(
        read_neigh::<Mesh3, _, _>(b"2 4\n1 2 -1 -1 -1\n2 -1 -1 -1 1\n"),
        Ok(vec![[1, NONE, NONE, NONE], [NONE, NONE, NONE, 0]])
    );
}

/// Weights and hidden points are read back from the formats that have them, and prove the mesh.
#[test]
fn weights_are_read_back() {
    let mesh = samples::weighted_mesh();
    assert_eq!((&mesh.weights[..], &mesh.hidden[..]), (&samples::WEIGHTS[..], &[4][..]));
    let points = Points::from(&POINTS);
    let vtu = written(|to| write_vtu(to, points, &mesh));
    let npz = written(|to| write_npz(to, points, &mesh));
    for data in [read_vtu::<Mesh3, _, _>(&vtu).unwrap(), read_npz::<Mesh3, _, _>(&npz).unwrap()] {
        assert_eq!((&data.weights, &data.hidden), (&Some(mesh.weights.clone()), &Some(mesh.hidden.clone())));
        assert!(gdel::verify3d(points, &data).unwrap().passed());
        let mut other = data.clone();
        other.hidden = Some(Vec::new());
        assert!(!gdel::verify3d(points, &other).unwrap().passed());
        (other.weights, other.hidden) = (None, None);
        assert!(!gdel::verify3d(points, &other).unwrap().passed());
    }
    // Other programs may call anything a weight.
    let array =
        |name: &str| format!("<DataArray type=\"Float32\" Name=\"{name}\" format=\"ascii\">0 1 2 3 4</DataArray>");
    let with = |element: &str, names: [&str; 2]| {
        let data = format!("<{element}>{}</{element}><Points>", names.map(array).concat());
        let mesh = read_vtu::<Mesh3, _, _>(samples::VTU_ASCII.replace("<Points>", &data).as_bytes()).unwrap();
        (mesh.weights, mesh.hidden)
    };
    assert_eq!(with("PointData", ["weight", "marker"]), (None, None));
    assert_eq!(with("CellData", ["weight", "hidden"]), (None, None));
    let found = (Some(vec![0.0, 1.0, 2.0, 3.0, 4.0]), Some(vec![1, 2, 3, 4]));
    assert_eq!(with("PointData", ["weight", "hidden"]), found);
    let node = String::from_utf8(written(|to| write_weighted_node(to, points, &mesh.weights))).unwrap();
    assert_eq!(node.lines().next(), Some("5 3 1 0 # index x y z weight"));
    assert_eq!(node.lines().nth(2), Some("1 1.5 0.0 0.0 1.0"));
    for column in ["weight", "5"] {
        let (cloud, values) = PointFormat::Node.read_with_values::<3>(node.as_bytes(), column).unwrap();
        assert_eq!((cloud.points, values), (PointBuf::F64(samples::points_f64()), mesh.weights.clone()));
    }
}

fn data(simplices: Vec<[u32; 4]>, neighbors: Option<Vec<[u32; 4]>>, points: PointBuf) -> MeshData3 {
    let mut data = MeshData3::default();
    (data.simplices, data.neighbors, data.points) = (simplices, neighbors, Some(points));
    data
}

#[test]
fn vtu_is_read_back() {
    let mesh = mesh();
    let single = data(mesh.tetrahedra.clone(), None, PointBuf::F32(POINTS.to_vec()));
    assert_eq!(read_vtu::<Mesh3, _, _>(&written(|to| write_vtu(to, (&POINTS).into(), &mesh))), Ok(single));
    let points = samples::points_f64();
    let double = data(mesh.tetrahedra.clone(), None, PointBuf::F64(points.clone()));
    assert_eq!(read_vtu::<Mesh3, _, _>(&written(|to| write_vtu(to, (&points).into(), &mesh))), Ok(double));
}

#[test]
fn vtu_of_other_programs() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0f32]];
    let simplices = vec![[0, 1, 2, 3], [1, 2, 3, 4]];
    let expected = data(simplices.clone(), None, PointBuf::F32(points.to_vec()));
    assert_eq!(read_vtu::<Mesh3, _, _>(samples::VTU_ASCII.as_bytes()), Ok(expected.clone()));
    let mut compressed = read_vtu::<Mesh3, _, _>(samples::VTU_ZLIB.as_bytes()).unwrap();
    assert_eq!(compressed.points.take(), Some(PointBuf::F32(vec![[0.0; 3]; 5])));
    assert_eq!(compressed.simplices, simplices);
}

/// The files of a 2D mesh, read back: triangles and neighbours in the sense of `Mesh2`, and the
/// points.
#[test]
fn files_of_2d_meshes_are_read_back() {
    let points = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0], [5.0, 5.0], [1.0, 1.0f32]];
    let mesh = gdel::delaunay2d(&points).unwrap();
    let stored = Some(PointBuf::F32(points.to_vec()));
    let npz: MeshData2 = read_npz::<Mesh2, _, _>(&written(|to| write_npz(to, (&points).into(), &mesh))).unwrap();
    assert_eq!((&npz.simplices, npz.halfedges.as_ref()), (&mesh.triangles, Some(&mesh.halfedges)));
    assert_eq!(npz.points, stored);
    let vtu = read_vtu::<Mesh2, _, _>(&written(|to| write_vtu(to, (&points).into(), &mesh))).unwrap();
    assert_eq!((&vtu.simplices, &vtu.points), (&mesh.triangles, &stored));
    assert_eq!(read_ele::<Mesh2, _, _>(&written(|to| write_ele(to, &mesh))), Ok(mesh.triangles.clone()));
    let neighbors = read_neigh::<Mesh2, _, _>(&written(|to| write_neigh(to, &mesh))).unwrap();
    let mut stated = MeshData2::default();
    (stated.simplices, stated.neighbors) = (mesh.triangles.clone(), Some(neighbors));
    assert!(gdel::verify2d(&points, &stated).unwrap().passed());
    for (t, k) in [(0, 0), (1, 2)] {
        let mut broken = stated.clone();
        broken.neighbors.as_mut().unwrap()[t][k] ^= 1;
        let report = gdel::verify2d(&points, &broken).unwrap();
        assert_eq!(report.failures().map(|(check, ..)| check.name()).collect::<Vec<_>>(), ["neighbors"]);
    }
}

#[test]
fn npz_is_read_back_and_holds_what_numpy_expects() {
    let mesh = mesh();
    let file = written(|to| write_npz(to, (&POINTS).into(), &mesh));
    let points = PointBuf::F32(POINTS.to_vec());
    let expected = data(mesh.tetrahedra.clone(), Some(mesh.neighbors.clone()), points);
    assert_eq!(read_npz::<Mesh3, _, _>(&file), Ok(expected));

    let mut archive = zip::ZipArchive::new(Cursor::new(file)).unwrap();
    assert_eq!(archive.len(), 3);
    let mut member = |name: &str| {
        let mut bytes = Vec::new();
        archive.by_name(name).unwrap().read_to_end(&mut bytes).unwrap();
        assert_eq!(
            bytes.windows(2).position(|w| w == b"}\n" || w == b" \n").map(|at| (at + 2) % 64),
            Some(0),
            "{name}"
        );
        npyz::NpyFile::new(Cursor::new(bytes)).unwrap()
    };
    let points = member("points.npy");
    assert_eq!(points.shape(), [5, 3]);
    assert_eq!(points.into_vec::<f32>().unwrap(), POINTS.as_flattened());
    assert_eq!(member("tetrahedra.npy").into_vec::<u32>().unwrap(), mesh.tetrahedra.as_flattened());
    let signed: Vec<i32> = mesh.neighbors.as_flattened().iter().map(|&t| t as i32).collect();
    assert_eq!(member("neighbors.npy").into_vec::<i32>().unwrap(), signed);
    assert!(signed.contains(&-1), "outside the hull");
}

#[test]
fn equal_meshes_make_equal_files() {
    let file = || written(|to| write_npz(to, (&POINTS).into(), &mesh()));
    assert_eq!(file(), file());
}

/// The hull's vertices, read back from each format that is read, are the points but the inner one.
#[test]
fn hulls_have_the_vertices_of_the_hull_exactly() {
    let mesh = mesh();
    let double: Vec<[f64; 3]> = samples::points_f64().iter().map(|p| p.map(|x| x / 3.0 + 1e7)).collect();
    for (points, name) in [(Points::from(&POINTS), "f32"), (Points::from(&double), "f64")] {
        for format in [SurfaceFormat::Ply, SurfaceFormat::Obj, SurfaceFormat::Stl] {
            let file = written(|to| format.write(to, points, &mesh));
            let reader = PointFormat::from_extension(format.extensions()[0]).unwrap();
            let read = reader.read::<3>(file).unwrap();
            let sorted = |points: &mut dyn Iterator<Item = [f64; 3]>| {
                let mut points: Vec<_> = points.map(|p| p.map(|x| format!("{:?}", x + 0.0))).collect();
                points.sort();
                points
            };
            assert_eq!(
                sorted(&mut Points::from(&read).iter()),
                sorted(&mut points.iter().take(4)),
                "{format:?} {name}"
            );
        }
    }
}

#[test]
fn hull_triangles_of_obj_name_its_own_vertices_counter_clockwise() {
    let file = String::from_utf8(written(|to| SurfaceFormat::Obj.write(to, (&POINTS).into(), &mesh()))).unwrap();
    let faces: Vec<Vec<usize>> = file
        .lines()
        .filter_map(|line| line.strip_prefix("f "))
        .map(|line| line.split(' ').map(|v| v.parse::<usize>().unwrap() - 1).collect())
        .collect();
    assert_eq!(faces.len(), 4);
    let inside = samples::points_f64()[4];
    for face in faces {
        let [a, b, c] = [face[0], face[1], face[2]].map(|v| samples::points_f64()[v]);
        // Counter-clockwise as seen from outside, the normal points away from the inner point.
        assert_eq!(gdel::internals::predicates::orient3d(a, b, c, inside), -1);
    }
}
