//! Files for solvers hold the points, constrained edges and simplices.

use crate::samples::{POINTS, mesh};
use gdel::{Constraints, Mesh2, Points, Triangulator};
use gdel_io::{ShapeFormat, files::Output, write_msh, write_poly};

const PLANE: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.1], [1.25e-7, 1.0], [1.0, 1.0], [0.0, 0.0]];

fn constrained() -> Mesh2 {
    let constraints = Constraints::new().edges(&[[0, 3], [4, 1]]);
    Triangulator::new().constrained2d(&PLANE, &constraints).unwrap().mesh
}

/// Returns the rows of a section of an MSH file.
fn section(file: &str, name: &str) -> Vec<Vec<f64>> {
    let content = file.split(&format!("${name}\n")).nth(1).unwrap().split(&format!("$End{name}\n")).next().unwrap();
    let (count, rows) = content.split_once('\n').unwrap();
    let rows: Vec<Vec<f64>> =
        rows.lines().map(|row| row.split(' ').map(|number| number.parse().unwrap()).collect()).collect();
    assert_eq!(count, rows.len().to_string());
    rows
}

#[test]
fn msh_of_a_plane() {
    let mesh = constrained();
    let mut file = Vec::new();
    write_msh(&mut file, (&PLANE).into(), &mesh).unwrap();
    let file = String::from_utf8(file).unwrap();
    assert!(file.starts_with("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"), "{file}");
    assert!(file.contains("$PhysicalNames\n2\n1 1 \"segments\"\n2 1 \"triangles\"\n"), "{file}");
    let nodes: Vec<Vec<f64>> = (1..).zip(PLANE).map(|(i, [x, y])| vec![f64::from(i), x, y, 0.0]).collect();
    assert_eq!(section(&file, "Nodes"), nodes);
    let row = |i: usize, kind: f64, vertices: &[u32]| {
        let head = [i as f64 + 1.0, kind, 2.0, 1.0, 1.0];
        head.into_iter().chain(vertices.iter().map(|&v| f64::from(v + 1))).collect::<Vec<f64>>()
    };
    let segments = [[0, 1], [0, 3]].map(|ends: [u32; 2]| (1.0, ends.to_vec()));
    let all = segments.into_iter().chain(mesh.triangles.iter().map(|t| (2.0, t.to_vec())));
    let elements: Vec<Vec<f64>> = all.enumerate().map(|(i, (kind, vertices))| row(i, kind, &vertices)).collect();
    assert_eq!(section(&file, "Elements"), elements);
}

#[test]
fn msh_of_a_solid() {
    let mut file = Vec::new();
    write_msh(&mut file, (&POINTS).into(), &mesh()).unwrap();
    let file = String::from_utf8(file).unwrap();
    assert!(file.contains("$PhysicalNames\n1\n3 1 \"tetrahedra\"\n"), "{file}");
    assert_eq!(section(&file, "Nodes").len(), POINTS.len());
    let elements = section(&file, "Elements");
    assert!(elements.len() == mesh().tetrahedra.len() && elements.iter().all(|row| row[1] == 4.0 && row.len() == 9));
}

#[test]
fn poly_comes_back() {
    let mut file = Vec::new();
    write_poly(&mut file, (&PLANE).into(), &constrained()).unwrap();
    let shapes = ShapeFormat::Poly.read(&file).unwrap();
    assert_eq!((shapes.points, shapes.edges), (PLANE.to_vec(), vec![[0, 1], [0, 3]]));
}

#[test]
fn outputs_by_extension() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["m.msh", "m.poly"] {
        let output = Output::new(&folder.path().join(name)).unwrap();
        output.write(Points::from(&PLANE), &constrained()).unwrap();
        // Such a file is known as one of these, and may be replaced.
        output.check(&[], false).unwrap();
    }
    let error = Output::new(&folder.path().join("s.poly")).unwrap().write((&POINTS).into(), &mesh()).unwrap_err();
    assert!(error.to_string().contains("only 2D meshes have segments"), "{error}");
}
