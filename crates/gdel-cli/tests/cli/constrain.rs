//! `gdel triangulate` with constraints.

use crate::{command, fails_with, folder, gdel, samples, succeeds};
use std::{fs, io::Write, path::Path, process::Stdio};

/// A square with a square hole, a point in the hole, and the first point again.
const POINTS: &str = "0,0\n9,0\n9,9\n0,9\n3,3\n6,3\n6,6\n3,6\n5,5\n0,0\n";
/// Both rings counter-clockwise; the last edge ends at the duplicate.
const RINGS: &str = "# outer\n0 1\n1 2\n2 3\n3 9\n\n# hole\n4 5\n5 6\n6 7\n7 4\n0 9\n";

fn files(path: &Path) {
    fs::write(path.join("points.csv"), POINTS).unwrap();
    fs::write(path.join("rings.txt"), RINGS).unwrap();
}

const RUN: [&str; 7] = ["triangulate", "points.csv", "--dim", "2", "--edges", "rings.txt", "--verify"];

#[test]
fn edges_and_fill_rules() {
    let folder = folder();
    let path = folder.path();
    files(path);
    for (fill, inside) in [(&[][..], 12), (&["--fill", "evenodd"], 8), (&["--fill", "nonzero"], 12)] {
        let arguments = [&RUN[..], fill, &["--stats", "json"]].concat();
        let stats: serde_json::Value = serde_json::from_str(&succeeds(path, &arguments)).expect("one JSON object");
        assert_eq!(stats["verified"], true);
        let counts = ["segments", "zero_length", "constrained_edges", "triangles", "inside_triangles"];
        assert_eq!(counts.map(|name| stats[name].as_u64().unwrap()), [9, 1, 8, 12, inside], "{stats}");
    }
    let text = succeeds(path, &[&RUN[..], &["--fill", "evenodd", "-o", "m.ele"]].concat());
    assert!(text.contains("constraints     8 edges of 9 segments, 1 of them without a length\n"), "{text}");
    assert!(text.contains("inside          8 triangles\n"), "{text}");
    assert!(text.contains("this is the constrained Delaunay triangulation"), "{text}");
    // The triangles outside the hole are written, and their neighbours end there.
    assert!(fs::read_to_string(path.join("m.ele")).unwrap().starts_with("8 3 0\n"));
    let neighbors = fs::read_to_string(path.join("m.neigh")).unwrap();
    assert_eq!(neighbors.matches("-1").count(), 8, "{neighbors}");
    let text = succeeds(path, &["triangulate", "points.csv", "--dim", "2"]);
    assert!(!text.contains("constraints"), "{text}");
}

#[test]
fn crossings_get_points() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("points.csv"), "0,0\n3,0\n3,3\n0,3\n").unwrap();
    fs::write(path.join("edges.txt"), "0 2\n1 3\n").unwrap();
    let run = ["triangulate", "points.csv", "--dim", "2", "--edges", "edges.txt", "--split", "--verify", "-o", "m.ele"];
    let text = succeeds(path, &run);
    assert!(text.contains("constraints     4 edges of 2 segments; points at crossings: 1, exactly there\n"), "{text}");
    let points = fs::read_to_string(path.join("m.node")).unwrap();
    assert!(points.starts_with("5 2 0 0\n") && points.contains("\n4 1.5 1.5\n"), "{points}");
}

#[test]
fn bad_edges() {
    let folder = folder();
    let path = folder.path();
    files(path);
    let fails = |edges: &str, rest: &[&str], what: &str| {
        fs::write(path.join("edges.txt"), edges).unwrap();
        let arguments = [&["triangulate", "points.csv", "--dim", "2", "--edges", "edges.txt"], rest].concat();
        fails_with(gdel(path, &arguments), what);
    };
    fails("0 2\n1 3\n", &[], "edges.txt: constraints cross where there is no point: 0–2 and 1–3");
    fails("0 10\n", &[], "edges.txt: the segment 0–10 has an end that is not one of the 10 points");
    fails("0 1\n1 2\n", &["--fill", "evenodd"], "edges.txt: the boundaries are not closed: at point 0");
    fails("0 1\n1\n", &[], "edges.txt: line 2: `1` instead of two indices");
    fails_with(gdel(path, &["triangulate", "points.csv", "--dim", "2", "--edges", "none.txt"]), "none.txt");
    let usage = |arguments: &[&str]| assert_eq!(gdel(path, arguments).status.code(), Some(2), "{arguments:?}");
    usage(&["triangulate", "points.csv", "--edges", "rings.txt"]);
    usage(&["triangulate", "points.csv", "--dim", "2", "--fill", "evenodd"]);
    usage(&["triangulate", "points.csv", "--dim", "2", "--split"]);
    usage(&["triangulate", "points.csv", "--sphere", "--split"]);
    usage(&["triangulate", "points.csv", "--dim", "2", "--edges", "rings.txt", "--weights", "1"]);
}

/// Returns the statistics of a run on shapes, which is verified, and its notes.
fn shapes(path: &Path, arguments: &[&str]) -> (serde_json::Value, String) {
    let output = gdel(path, &[&["triangulate", "--verify", "--stats", "json"], arguments].concat());
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{notes}");
    let stats: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(stats["verified"], true);
    (stats, notes)
}

#[test]
fn shapes_of_all_formats() {
    let folder = folder();
    let path = folder.path();
    for (format, bytes) in samples::shapes() {
        fs::write(path.join("shapes").with_extension(format.extensions()[0]), bytes).unwrap();
    }
    let left_out = |text: &str| format!("gdel: {text}\n");
    let (stats, notes) = shapes(path, &["shapes.geojson", "-o", "map.obj"]);
    assert_eq!(notes, left_out("shapes.geojson: the z coordinates are dropped"));
    assert_eq!(["points", "dimension", "segments"].map(|name| stats[name].as_u64().unwrap()), [18, 2, 14]);
    let inside = stats["inside_triangles"].as_u64().unwrap();
    assert!(inside < stats["triangles"].as_u64().unwrap());
    let faces = fs::read_to_string(path.join("map.obj")).unwrap().lines().filter(|line| line.starts_with("f ")).count();
    assert_eq!(faces as u64, inside);

    let (stats, notes) = shapes(path, &["shapes.svg", "--split", "-o", "drawing.vtu"]);
    assert_eq!(notes, left_out("shapes.svg: left out: 2 text, 1 use"));
    assert_eq!(stats["added_points"], 0);

    let (stats, notes) = shapes(path, &["shapes.poly", "-o", "box.ele"]);
    assert_eq!(notes, left_out("shapes.poly: left out: 1 regional attributes"));
    assert_eq!(["triangles", "inside_triangles"].map(|name| stats[name].as_u64().unwrap()), [10, 8]);
    assert!(fs::read_to_string(path.join("box.ele")).unwrap().starts_with("8 3 0\n"));
    // What is a hole stays one, whatever the rule.
    assert_eq!(shapes(path, &["shapes.poly", "--fill", "all"]).0["inside_triangles"], 8);
}

#[test]
fn shapes_from_standard_input() {
    let folder = folder();
    let mut command = command(folder.path(), &["triangulate", "-", "--format", "geojson", "--stats", "json"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let square = br#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}"#;
    child.stdin.take().unwrap().write_all(square).unwrap();
    let output = child.wait_with_output().unwrap();
    let stats: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one JSON object");
    assert_eq!(stats["inside_triangles"], 2);
}

#[test]
fn bad_shapes() {
    let folder = folder();
    let path = folder.path();
    let fails = |name: &str, text: &str, rest: &[&str], what: &str| {
        fs::write(path.join(name), text).unwrap();
        fails_with(gdel(path, &[&["triangulate", name], rest].concat()), what);
    };
    fails("a.geojson", "{\n\"type\": \"Map\"}", &[], "a.geojson: line 2: unknown variant `Map`");
    fails("a.svg", "<svg><path d='M'/></svg>", &[], "a.svg: line 1: path data");
    fails("a.poly", "1 2 0 0\n", &[], "a.poly: line 1: 1 points are promised, 0 are there");
    fails("b.poly", "0 2 0 0\n0\n0\n", &[], "b.node: cannot be read");
    let bow = r#"{"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]]}"#;
    fails("bow.json", bow, &[], "bow.json: constraints cross where there is no point: 0–1 and 2–3");
    assert!(succeeds(path, &["triangulate", "bow.json", "--split"]).contains("inside          2 triangles"));
    let usage = |rest: &[&str]| {
        assert_eq!(gdel(path, &[&["triangulate", "bow.json"], rest].concat()).status.code(), Some(2), "{rest:?}");
    };
    usage(&["--dim", "3"]);
    usage(&["--edges", "edges.txt"]);
    usage(&["--rescale"]);
    usage(&["--weights", "1"]);
    usage(&["--sphere"]);
}
