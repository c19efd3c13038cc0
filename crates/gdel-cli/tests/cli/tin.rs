//! `gdel tin`: terrain from scans and breaklines.

use crate::{fails, folder, gdel, succeeds};
use std::{fs, path::Path};

/// Writes a scan of 20 × 20 points: a ridge along *x* = 9.5, whose crest has no points; and one above another.
fn write_scan(path: &Path) {
    let mut text = String::new();
    for (x, y) in (0..400).map(|i| (f64::from(i % 20), f64::from(i / 20))) {
        text += &format!("{x} {y} {}\n", 10.0 - (x - 9.5).abs());
    }
    text += "3 3 50\n";
    fs::write(path.join("scan.xyz"), text).unwrap();
}

fn stats(path: &Path, options: &[&str]) -> serde_json::Value {
    let arguments = [&["tin", "scan.xyz", "--stats", "json"], options].concat();
    serde_json::from_str(&succeeds(path, &arguments)).expect("one JSON object")
}

/// Returns the vertices and the triangles of an OBJ file.
fn obj(path: &Path) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let text = fs::read_to_string(path).unwrap();
    let rows = |name: &str| {
        let rows: Vec<Vec<f64>> = text
            .lines()
            .filter_map(|line| line.strip_prefix(name))
            .map(|row| row.split_whitespace().map(|field| field.split('/').next().unwrap().parse().unwrap()).collect())
            .collect();
        rows
    };
    let vertices = rows("v ").iter().map(|row| [row[0], row[1], row[2]]).collect();
    (vertices, rows("f ").iter().map(|row| [0, 1, 2].map(|k| row[k] as usize - 1)).collect())
}

#[test]
fn terrain_of_a_scan() {
    let folder = folder();
    let path = folder.path();
    write_scan(path);
    let found = stats(path, &["--max-error", "0.1", "-o", "t.obj"]);
    let count = |key: &str| found[key].as_u64().unwrap();
    assert_eq!((count("points"), count("duplicates"), count("other_heights")), (401, 1, 1), "{found}");
    assert!(found["max_error"].as_f64().unwrap() <= 0.1 && found["limited"] == false, "{found}");
    assert!(count("vertices") < 40, "{found}");
    let (vertices, triangles) = obj(&path.join("t.obj"));
    assert_eq!((vertices.len() as u64, triangles.len() as u64), (count("vertices"), count("triangles")));
    assert!(vertices.iter().all(|&[x, _, z]| z == 10.0 - (x - 9.5).abs()), "{vertices:?}");
    for file in ["t.glb", "t.ply", "t.stl", "t.3mf", "t.vtu"] {
        let text = succeeds(path, &["tin", "scan.xyz", "--max-error", "0.1", "--repeat", "2", "-o", file]);
        assert!(text.contains("max error") && fs::metadata(path.join(file)).unwrap().len() > 0, "{text}");
    }
    // Fewer vertices, and any number of threads.
    let found = stats(path, &["--max-points", "5", "--threads", "3", "-fo", "t.obj"]);
    assert_eq!((&found["vertices"], &found["limited"]), (&5.into(), &true.into()), "{found}");
}

#[test]
fn breaklines() {
    let folder = folder();
    let path = folder.path();
    write_scan(path);
    // The crest, where the scan has no points; with its height, the surface is exact.
    let line = |z: &str| format!(r#"{{"type":"LineString","coordinates":[[9.5,-1{z}],[9.5,20{z}]]}}"#);
    fs::write(path.join("crest.geojson"), line(",10")).unwrap();
    let exact = ["--max-error", "1e-9", "--breaklines", "crest.geojson"];
    let found = stats(path, &[&exact[..], &["-o", "t.obj"]].concat());
    assert_eq!(
        (&found["vertices"], &found["breakline_edges"], &found["interpolated"]),
        (&6.into(), &1.into(), &0.into())
    );
    assert!(obj(&path.join("t.obj")).0.contains(&[9.5, 20.0, 10.0]));
    // Without, the height is the scan's: beside it that of the nearest point.
    fs::write(path.join("crest.geojson"), line("")).unwrap();
    let found = stats(path, &[&exact[..], &["-fo", "t.obj"]].concat());
    assert_eq!(found["interpolated"], 2);
    assert!(obj(&path.join("t.obj")).0.contains(&[9.5, 20.0, 9.5]));
    fs::write(path.join("inner.poly"), "2 2 0 0\n0 9.25 2\n1 9.5 17\n1 0\n0 0 1\n0\n").unwrap();
    let found = stats(path, &["--max-error", "9", "--breaklines", "inner.poly", "-fo", "t.obj"]);
    assert_eq!((&found["interpolated"], &found["vertices"]), (&2.into(), &6.into()), "{found}");
    assert!(obj(&path.join("t.obj")).0.contains(&[9.25, 2.0, 9.5]));
}

#[test]
fn what_is_inside_polygons() {
    let folder = folder();
    let path = folder.path();
    write_scan(path);
    let ring = "[[2,2,0],[6,2,0],[6,6,0],[2,6,0],[2,2,0]]";
    fs::write(path.join("area.geojson"), format!(r#"{{"type":"Polygon","coordinates":[{ring}]}}"#)).unwrap();
    let options = ["--max-error", "0.1", "--breaklines", "area.geojson", "-fo", "t.obj"];
    let whole = stats(path, &options);
    let inside = stats(path, &[&options[..], &["--fill", "evenodd"]].concat());
    assert_eq!((&whole["outside"], &inside["outside"]), (&0.into(), &(400 - 25).into()), "{inside}");
    let (vertices, triangles) = obj(&path.join("t.obj"));
    assert!(vertices.iter().all(|&[x, y, _]| (2.0..=6.0).contains(&x) && (2.0..=6.0).contains(&y)));
    assert_eq!(inside["triangles"], triangles.len());
}

#[test]
fn breaklines_that_cross() {
    let folder = folder();
    let path = folder.path();
    write_scan(path);
    let lines = r#"{"type":"MultiLineString","coordinates":[[[1.5,1.5,0],[5.5,5.5,4]],[[1.5,5.5,8],[5.5,1.5,8]]]}"#;
    fs::write(path.join("lines.json"), lines).unwrap();
    let options = ["tin", "scan.xyz", "--max-error", "50", "--breaklines", "lines.json", "-o", "t.obj"];
    fails(path, &options, "constraints cross where there is no point: 401–402 and 403–404");
    let found = stats(path, &[&options[2..], &["--split"]].concat());
    assert_eq!((&found["crossings"], &found["breakline_edges"]), (&1.into(), &4.into()), "{found}");
    assert!(obj(&path.join("t.obj")).0.contains(&[3.5, 3.5, 5.0]));
}

#[test]
fn wrong_options() {
    let folder = folder();
    let path = folder.path();
    write_scan(path);
    let code = |options: &[&str]| gdel(path, &[&["tin", "scan.xyz"], options].concat()).status.code();
    assert_eq!(code(&["-o", "t.obj"]), Some(2));
    assert_eq!(code(&["--max-error", "1", "-o", "t.csv"]), Some(2));
    assert_eq!(code(&["--max-error", "1", "-o", "t.obj", "--breaklines", "lines.txt"]), Some(2));
    assert_eq!(code(&["--max-error", "1", "-o", "t.obj", "--fill", "evenodd"]), Some(2));
    fails(path, &["tin", "scan.xyz", "--max-error=-1", "-o", "t.obj"], "the largest error must be a number from 0 on");
    fs::write(path.join("bad.xyz"), "0 0 0\n1 0 inf\n").unwrap();
    fails(path, &["tin", "bad.xyz", "--max-error", "1", "-o", "t.obj"], "bad.xyz");
}
