//! `gdel triangulate` with options of refinement.

use crate::{fails_with, folder, gdel, succeeds};
use std::{fs, path::Path};

/// A square with a square hole.
const SHAPE: &str = "8 2 0 0\n0 0 0\n1 9 0\n2 9 9\n3 0 9\n4 3 3\n5 6 3\n6 6 6\n7 3 6\n\
    8 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n4 4 5\n5 5 6\n6 6 7\n7 7 4\n1\n0 4.5 4.5\n";

fn stats(path: &Path, options: &[&str]) -> serde_json::Value {
    let arguments = [&["triangulate", "shape.poly", "--verify", "--stats", "json"], options].concat();
    serde_json::from_str(&succeeds(path, &arguments)).expect("one JSON object")
}

#[test]
fn shapes_are_refined() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("shape.poly"), SHAPE).unwrap();
    assert!(stats(path, &[])["refined"].is_null());
    let found = stats(path, &["--min-angle", "30", "-o", "m.msh", "-o", "m.ele", "-o", "m.poly"]);
    assert_eq!((&found["verified"], &found["added_points"]), (&true.into(), &0.into()), "{found}");
    let refined = &found["refined"];
    assert!(refined["min_angle"].as_f64().unwrap() >= 30.0 && refined["limited"] == false, "{found}");
    let points = 8 + refined["points_on_segments"].as_u64().unwrap() + refined["points_inside"].as_u64().unwrap();
    assert!(fs::read_to_string(path.join("m.node")).unwrap().starts_with(&format!("{points} 2 0 0\n")));
    assert!(
        fs::read_to_string(path.join("m.ele")).unwrap().starts_with(&format!("{} 3 0\n", found["inside_triangles"]))
    );
    let lines = found["constrained_edges"].as_u64().unwrap();
    let triangles = found["inside_triangles"].as_u64().unwrap();
    assert!(fs::read_to_string(path.join("m.msh")).unwrap().contains(&format!("$Elements\n{}\n", lines + triangles)));
    // What was written is refined already.
    fs::write(path.join("shape.poly"), fs::read(path.join("m.poly")).unwrap()).unwrap();
    assert_eq!(stats(path, &[])["constrained_edges"], lines);
}

#[test]
fn sizes_and_limits() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("shape.poly"), SHAPE).unwrap();
    let count = |options: &[&str]| stats(path, options)["inside_triangles"].as_u64().unwrap();
    // 72 square units; an equilateral triangle with sides of a unit has less than half of one.
    assert!(count(&["--max-area", "0.5"]) >= 144);
    assert!(count(&["--max-edge", "1"]) >= 166);
    assert!(count(&["--max-edge", "1"]) < 600);
    let text = succeeds(path, &["triangulate", "shape.poly", "--max-area", "0.01", "--max-points", "10"]);
    assert!(text.contains("; more points are needed: "), "{text}");
    let text = succeeds(path, &["triangulate", "shape.poly", "--min-angle", "25"]);
    assert!(text.contains("points on segments, ") && text.contains("the smallest angle is "), "{text}");
}

#[test]
fn wrong_options() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("shape.poly"), SHAPE).unwrap();
    fs::write(path.join("points.csv"), "0,0\n1,0\n0,1\n").unwrap();
    let wrong = |options: &[&str], what: &str| {
        fails_with(gdel(path, &[&["triangulate", "shape.poly"], options].concat()), what);
    };
    wrong(&["--min-angle", "40"], "the smallest angle must be a number of degrees from 0 to 34");
    wrong(&["--max-area", "0"], "the largest area must be a positive number");
    wrong(&["--max-edge", "nan"], "the size must be a positive number");
    let output = gdel(path, &["triangulate", "points.csv", "--dim", "2", "--min-angle", "30"]);
    assert_eq!(output.status.code(), Some(2));
}
