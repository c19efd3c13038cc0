//! `gdel triangulate` with constraints.

use crate::{fails_with, folder, gdel, succeeds};
use std::{fs, path::Path};

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
    usage(&["triangulate", "points.csv", "--dim", "2", "--edges", "rings.txt", "--weights", "1"]);
}
