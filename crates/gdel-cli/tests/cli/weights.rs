//! Commands with weights.

use crate::{derived::array, fails_with, folder, gdel, succeeds};
use std::{fs, path::Path};

/// A square, its middle, and a point near a corner. Names come from the first line.
const SQUARE: &str = "x,y,w,r\n0,0,0,0\n4,0,0,0\n0,4,0,0\n4,4,9,3\n2,2,1,1\n3,3.5,0.25,0.5\n";

#[test]
fn weights_and_radii() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("square.csv"), SQUARE).unwrap();
    let run = |column: &[&str]| {
        let arguments = [&["triangulate", "square.csv", "--dim", "2", "--verify", "--stats", "json"], column].concat();
        let stats: serde_json::Value = serde_json::from_str(&succeeds(path, &arguments)).expect("one JSON object");
        assert_eq!(stats["verified"], true);
        stats
    };
    let plain = run(&[]);
    assert_eq!((&plain["triangles"], &plain["hidden"]), (&6.into(), &serde_json::Value::Null));
    for column in [["--weights", "w"], ["--weights", "3"], ["--radii", "r"]] {
        let weighted = run(&column);
        assert_eq!((&weighted["triangles"], &weighted["hidden"]), (&4.into(), &1.into()), "{weighted}");
        assert_eq!(weighted["fallback"]["reason"], "weights");
    }
    let text =
        succeeds(path, &["triangulate", "square.csv", "--dim", "2", "--weights", "w", "--verify", "-o", "m.ele"]);
    assert!(text.contains("points          6, 1 hidden"), "{text}");
    assert!(text.contains("this is the regular triangulation"), "{text}");
    succeeds(path, &["verify", "square.csv", "m.ele", "--dim", "2"]);
    // Without the weights, which are in this file, it is not what it should be.
    fs::remove_file(path.join("m.node")).unwrap();
    fails_with(gdel(path, &["verify", "square.csv", "m.ele", "--dim", "2"]), "vertices");
}

/// The hull of points in a plane of space is their polygon, from both sides.
#[test]
fn flat_points_with_weights() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("flat.csv"), "x,y,z,w\n0,0,1,0\n4,0,1,0\n0,4,1,0\n4,4,1,9\n2,2,1,-9\n").unwrap();
    succeeds(path, &["triangulate", "flat.csv", "--weights", "w", "-o", "flat.obj"]);
    assert!(fs::read_to_string(path.join("flat.obj")).unwrap().lines().count() > 5);
    succeeds(path, &["voronoi", "flat.csv", "--weights", "w", "--clip", "hull", "-o", "cells.csv"]);
    let cells = fs::read_to_string(path.join("cells.csv")).unwrap();
    let areas = cells.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse::<f64>().unwrap());
    assert!((areas.sum::<f64>() - 16.0).abs() < 1e-12, "{cells}");
}

/// Balls of a grid that touch have all edges and nothing larger; some that do not have none.
#[test]
fn alpha_complexes_of_balls() {
    let folder = folder();
    let path = folder.path();
    let row = |i: u32| format!("{},{},{},0.5,0.49\n", i % 3, i / 3 % 3, i / 9);
    fs::write(
        path.join("grid.csv"),
        ["x,y,z,r,s\n".to_owned()].into_iter().chain((0..27).map(row)).collect::<String>(),
    )
    .unwrap();
    let run = |arguments: &[&str]| {
        let fixed = ["alpha", "grid.csv", "--singular", "--stats", "json", "-fo", "balls.vtu"];
        serde_json::from_str::<serde_json::Value>(&succeeds(path, &[&fixed, arguments].concat()))
            .expect("one JSON object")
    };
    let counts = |stats: &serde_json::Value| {
        ["solid", "singular_triangles", "singular_edges", "singular_vertices", "components"]
            .map(|name| stats[name].as_u64().unwrap())
    };
    assert_eq!(counts(&run(&["--radii", "r"])), [0, 0, 54, 0, 1]);
    let written = fs::read(path.join("balls.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&written).contains("NumberOfCells=\"54\""));
    assert_eq!(counts(&run(&["--radii", "s"])), [0, 0, 0, 27, 27]);
    // Half of a cube's diagonal fills all.
    assert_eq!(counts(&run(&["--radii", "r", "--alpha", "0.75"]))[1..], [0, 0, 0, 1]);
    assert_eq!(run(&["--weights", "r", "--alpha", "0.5"])["alpha"], 0.5);
}

#[test]
fn bad_weights() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("bad.csv"), "x,y,z,w,r\n0,0,0,1,1\n1,0,0,nan,-1\n0,1,0,2,2\n").unwrap();
    fails_with(gdel(path, &["triangulate", "bad.csv", "--weights", "w"]), "weight 1 is not a finite number");
    fails_with(gdel(path, &["triangulate", "bad.csv", "--radii", "r"]), "radius 1 is not a number from 0 on");
    fails_with(gdel(path, &["triangulate", "bad.csv", "--weights", "mass"]), "mass");
}

/// The area of each cell, and its neighbours.
fn cells(folder: &Path, arguments: &[&str]) -> Vec<(f64, String)> {
    let fixed = ["voronoi", "square.csv", "--dim", "2", "--clip", "0,0,4,4", "-fo", "cells.csv"];
    succeeds(folder, &[&fixed, arguments].concat());
    let text = fs::read_to_string(folder.join("cells.csv")).unwrap();
    let cell = |line: &str| {
        let columns: Vec<&str> = line.split(',').collect();
        (columns[1].parse().unwrap(), columns[4].to_owned())
    };
    text.lines().skip(1).map(cell).collect()
}

#[test]
fn power_diagrams() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("square.csv"), SQUARE).unwrap();
    let (weighted, plain) = (cells(path, &["--weights", "w"]), cells(path, &[]));
    assert_eq!(weighted, cells(path, &["--radii", "r"]));
    assert!(plain.iter().all(|(area, _)| *area > 0.0));
    // The last point is hidden: it has no cell.
    assert_eq!(weighted[5], (0.0, String::new()));
    for cells in [&weighted, &plain] {
        let sum: f64 = cells.iter().map(|(area, _)| area).sum();
        assert!((sum - 16.0).abs() < 1e-12, "{sum}");
    }
    // The cell of the ball in a corner ends at the lines x + y = 4, x = 0.875 and y = 0.875.
    assert!((weighted[3].0 - 8.0 + 0.875 * 0.875).abs() < 1e-12, "{weighted:?}");
    assert!(weighted[3].0 > plain[3].0);
    let text = succeeds(path, &["voronoi", "square.csv", "--dim", "2", "--weights", "w", "-o", "cells.vtu"]);
    assert!(text.contains("points          6, 1 hidden"), "{text}");
    let sphere = gdel(path, &["voronoi", "square.csv", "--sphere", "--weights", "w", "-fo", "cells.csv"]);
    assert_eq!(sphere.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&sphere.stderr).contains("cannot be used with"));
}

/// The files of a weighted mesh have its weights, and prove that it is regular; others have none.
#[test]
fn files_with_weights() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("square.csv"), SQUARE).unwrap();
    let fixed = ["triangulate", "square.csv", "--dim", "2", "-fo"];
    let cells = |input: &str, column: &str| {
        let fixed = ["--dim", "2", "--clip", "0,0,4,4", "-fo", "cells.csv"];
        succeeds(path, &[&["voronoi", input, "--weights", column], &fixed[..]].concat());
        fs::read_to_string(path.join("cells.csv")).unwrap()
    };
    let expected = cells("square.csv", "w");
    for file in ["m.vtu", "m.npz", "m.ele"] {
        succeeds(path, &[&fixed[..], &[file]].concat());
        let points = path.join(if file == "m.ele" { "m.node" } else { file });
        let plain = fs::read(&points).unwrap();
        assert!(!plain.windows(6).any(|window| window == b"weight" || window == b"hidden"));
        succeeds(path, &[&fixed[..], &[file, "--weights", "w"]].concat());
        assert!(succeeds(path, &["verify", file, "--dim", "2"]).contains("hidden               passed"));
        assert_eq!(cells(points.file_name().unwrap().to_str().unwrap(), "weight"), expected);
    }
    assert_eq!(array::<f64>(&path.join("m.npz"), "weight"), [0.0, 0.0, 0.0, 9.0, 1.0, 0.25]);
    assert_eq!(array::<u32>(&path.join("m.npz"), "hidden"), [5]);
    let node = fs::read_to_string(path.join("m.node")).unwrap();
    assert!(node.starts_with("6 2 1 0 # index x y weight\n0 0.0 0.0 0.0\n1 4.0 0.0 0.0\n"), "{node}");
    assert_eq!(cells("m.node", "4"), expected);
    // The given points have the weights of the mesh.
    succeeds(path, &["verify", "square.csv", "m.npz", "--dim", "2"]);
    // With these weights, another mesh is right.
    fs::write(path.join("m.node"), node.replacen("0.0 0.0 0.0", "0.0 0.0 99.0", 1)).unwrap();
    assert_eq!(gdel(path, &["verify", "m.ele", "--dim", "2"]).status.code(), Some(1));
    fails_with(gdel(path, &["triangulate", "m.npz", "--dim", "2", "--weights", "w"]), "no array `w`");
    fails_with(gdel(path, &["triangulate", "m.vtu", "--dim", "2", "--weights", "w"]), "the points have no data `w`");
    fails_with(gdel(path, &["triangulate", "m.npz", "--dim", "2", "--weights", "hidden"]), "1 values of hidden for 6");
}

/// Weights are properties of vertices in PLY.
#[test]
fn weights_in_ply() {
    let folder = folder();
    let path = folder.path();
    let properties = "property float x\nproperty float y\nproperty float z\nproperty double w\nproperty uchar red\n";
    let faces = "element face 1\nproperty list uchar int vertex_indices\n";
    let row = |line: &str| {
        let [x, y, w] = [0, 1, 2].map(|place| line.split(',').nth(place).unwrap());
        format!("{x} {y} 0 {w} 7\n")
    };
    let rows: String = SQUARE.lines().skip(1).map(row).collect();
    let ply = format!("ply\nformat ascii 1.0\nelement vertex 6\n{properties}{faces}end_header\n{rows}3 0 1 2\n");
    fs::write(path.join("square.ply"), ply).unwrap();
    for column in ["w", "4"] {
        let text = succeeds(path, &["triangulate", "square.ply", "--dim", "2", "--weights", column, "--verify"]);
        assert!(text.contains("points          6, 1 hidden"), "{text}");
    }
    for (column, message) in [
        ("mass", "line 3: there is no column `mass`"),
        ("6", "line 3: the vertices have no property 6"),
        ("0", "line 3: there is no column `0`"),
    ] {
        fails_with(gdel(path, &["triangulate", "square.ply", "--dim", "2", "--weights", column]), message);
    }
}

#[test]
fn the_least_power_distance() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("square.csv"), SQUARE).unwrap();
    fs::write(path.join("queries.csv"), "x,y\n3,3.5\n2.5,2.5\n0.25,0.5\n9,9\n").unwrap();
    let nearest = |arguments: &[&str]| {
        let fixed = ["locate", "square.csv", "queries.csv", "--dim", "2", "-fo", "located.csv"];
        succeeds(path, &[&fixed, arguments].concat());
        let text = fs::read_to_string(path.join("located.csv")).unwrap();
        text.lines().skip(1).map(|line| line.rsplit(',').next().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(nearest(&[]), ["5", "4", "0", "3"]);
    assert_eq!(nearest(&["--weights", "w"]), ["3", "3", "0", "3"]);
    assert_eq!(nearest(&["--radii", "r"]), ["3", "3", "0", "3"]);
}

/// The weights that `transport` finds make `voronoi` divide the box by the masses.
#[test]
fn transport() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("p.csv"), "x,y,m\n0,0,1\n4,0,2\n0,4,3\n4,4,4\n1,1,6\n1,1,4\n").unwrap();
    let fixed = ["transport", "p.csv", "--dim", "2", "--masses", "m", "--clip", "0,0,5,4"];
    let text = succeeds(path, &[&fixed[..], &["-o", "t.csv"]].concat());
    assert!(text.contains("duplicates") && text.contains("steps"), "{text}");
    let read = |name: &str| fs::read_to_string(path.join(name)).unwrap();
    assert!(read("t.csv").starts_with("x,y,weight,area\n0.0,0.0,"), "{}", read("t.csv"));
    succeeds(path, &["voronoi", "t.csv", "--dim", "2", "--weights", "weight", "--clip", "0,0,5,4", "-o", "v.csv"]);
    let areas = read("v.csv");
    let areas = areas.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse::<f64>().unwrap());
    // The last point is a duplicate, whose mass the one before has as well.
    for (area, mass) in areas.zip([1.0, 2.0, 3.0, 4.0, 10.0, 0.0]) {
        assert!((area - mass).abs() <= 0.0011 * mass, "{area} {mass}");
    }
    for output in ["t.npz", "t.vtu"] {
        succeeds(path, &[&fixed[..], &["-o", output]].concat());
        assert!(fs::read(path.join(output)).unwrap().len() > 300);
    }
    succeeds(path, &["voronoi", "t.npz", "--dim", "2", "--weights", "weight", "--clip", "0,0,5,4", "-fo", "w.csv"]);
    assert_eq!(read("w.csv"), read("v.csv"));
    let run = |more: &[&str]| gdel(path, &[&fixed[..3], &["2"], more, &["-fo", "t.csv"]].concat());
    fails_with(run(&["--masses", "m", "--clip", "0,0,5,5"]), "the sum of the masses is 20.0");
    assert!(run(&["--masses", "m", "--clip", "0,0,5,5", "--normalize"]).status.success());
    fails_with(run(&["--masses", "x"]), "mass 0 is not a positive number");
    fails_with(run(&["--clip", "none"]), "a box, a convex shape or the hull");
}
