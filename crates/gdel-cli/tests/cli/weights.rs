//! `gdel triangulate` with weights.

use crate::{fails_with, folder, gdel, succeeds};
use std::fs;

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
    // Without the weights it is not what it should be.
    fails_with(gdel(path, &["verify", "square.csv", "m.ele", "--dim", "2"]), "vertices");
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
