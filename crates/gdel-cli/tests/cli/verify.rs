//! The command `gdel verify`, and what is proven of the files of a mesh.

use crate::{command, fails, fails_with, folder, stats, succeeds};
use std::{fs, path::Path, process::Stdio};

/// Changes one number of a text file: of the line with this number the word with this one.
fn corrupt(file: &Path, line: usize, word: usize, new: &str) {
    let text = fs::read_to_string(file).unwrap();
    let mut lines: Vec<String> = text.lines().map(Into::into).collect();
    let mut words: Vec<&str> = lines[line].split(' ').collect();
    assert_ne!(words[word], new);
    words[word] = new;
    lines[line] = words.join(" ");
    fs::write(file, lines.join("\n")).unwrap();
}

#[test]
fn verify_reads_the_neighbours_of_either_dimension() {
    for dim in ["2", "3"] {
        let folder = folder();
        let path = folder.path();
        succeeds(path, &["generate", "uniform", "40", "--dim", dim, "-o", "p.csv"]);
        succeeds(path, &["triangulate", "p.csv", "--dim", dim, "-o", "m.ele"]);
        let report = succeeds(path, &["verify", "p.csv", "m.ele", "--dim", dim]);
        assert!(report.contains("neighbors            passed"), "{report}");
        let neigh = path.join("m.neigh");
        let good = fs::read_to_string(&neigh).unwrap();
        // Every number of every row.
        let rows: Vec<Vec<i32>> = good
            .lines()
            .skip(1)
            .take_while(|row| !row.starts_with('#'))
            .map(|row| row.split(' ').map(|n| n.parse().unwrap()).collect())
            .collect();
        for (i, row) in rows.iter().enumerate().step_by(7) {
            for (k, &n) in row.iter().enumerate().skip(1) {
                corrupt(&neigh, i + 1, k, &(n + 1).to_string());
                fails(
                    path,
                    &["verify", "p.csv", "m.ele", "--dim", dim],
                    "m.ele: not the Delaunay triangulation: neighbors",
                );
                fs::write(&neigh, &good).unwrap();
            }
        }
        let outside = rows.iter().position(|row| row[1..].contains(&-1)).unwrap();
        let k = 1 + rows[outside][1..].iter().position(|&n| n == -1).unwrap();
        corrupt(&neigh, outside + 1, k, "-2");
        fails(path, &["verify", "p.csv", "m.ele", "--dim", dim], "-2 is out of range");
    }
}

#[test]
fn verify_compares_the_points_in_the_mesh_file() {
    for dim in ["2", "3"] {
        let folder = folder();
        let path = folder.path();
        succeeds(path, &["generate", "uniform", "40", "--dim", dim, "-o", "p.csv"]);
        let outputs = ["-o", "m.vtu", "-o", "m.npz", "-o", "m.ele"];
        succeeds(path, &[&["triangulate", "p.csv", "--dim", dim][..], &outputs].concat());
        let points = fs::read_to_string(path.join("p.csv")).unwrap();
        for mesh in ["m.vtu", "m.npz", "m.node"] {
            succeeds(path, &["verify", "p.csv", mesh, "--dim", dim]);
            // The mesh's own points will do.
            succeeds(path, &["verify", mesh, "--dim", dim]);
            let bytes = fs::read(path.join(mesh)).unwrap();
            // A coordinate in the middle of the points moves to a neighbouring number.
            let x: f64 = points.lines().nth(20).unwrap().split(',').next().unwrap().parse().unwrap();
            let mut moved = bytes.clone();
            if mesh == "m.node" {
                let text = String::from_utf8(bytes).unwrap();
                moved = text.replacen(&format!(" {x:?} "), &format!(" {:?} ", x.next_up()), 1).into();
            } else {
                let at = bytes.windows(8).position(|eight| eight == x.to_le_bytes()).expect("the coordinate");
                moved[at..at + 8].copy_from_slice(&x.next_up().to_le_bytes());
            }
            if mesh != "m.npz" {
                fs::write(path.join(mesh), moved).unwrap();
                let message = format!("{mesh}: not a mesh of the points in p.csv: its point 19 is");
                fails(path, &["verify", "p.csv", mesh, "--dim", dim], &message);
            } else {
                // The checksum of the archive finds it out before.
                fs::write(path.join(mesh), moved).unwrap();
                fails(path, &["verify", "p.csv", mesh, "--dim", dim], "m.npz: byte 0: array `points`: ");
            }
        }
        // Another cloud of as many points, and one of fewer.
        succeeds(path, &["generate", "uniform", "40", "--seed", "1", "--dim", dim, "-o", "q.csv"]);
        succeeds(path, &["generate", "uniform", "39", "--dim", dim, "-o", "r.csv"]);
        succeeds(path, &["triangulate", "p.csv", "--dim", dim, "-fo", "m.npz"]);
        fails(path, &["verify", "q.csv", "m.npz", "--dim", dim], "not a mesh of the points in q.csv: its point 0 is");
        fails(path, &["verify", "r.csv", "m.npz", "--dim", dim], "it has 40 points, not 39");
    }
}

#[test]
fn verify_needs_points_from_somewhere() {
    let folder = folder();
    let path = folder.path();
    succeeds(path, &["generate", "uniform", "9", "-o", "p.csv"]);
    succeeds(path, &["triangulate", "p.csv", "-o", "m.ele"]);
    fs::remove_file(path.join("m.node")).unwrap();
    fails(path, &["verify", "m.ele"], "m.ele: this file holds no points: name the file that does first");
    succeeds(path, &["verify", "p.csv", "m.ele"]);
}

#[test]
fn statistics_say_whether_the_mesh_was_verified() {
    let folder = folder();
    let path = folder.path();
    succeeds(path, &["generate", "uniform", "50", "-o", "p.csv"]);
    let runs = stats(path, &["p.csv", "--verify", "--repeat", "2"]);
    assert_eq!((runs[0].get("verified"), &runs[1]["verified"]), (None, &true.into()));
    assert_eq!(stats(path, &["p.csv"])[0].get("verified"), None);
    succeeds(path, &["generate", "uniform", "50", "--dim", "2", "-o", "q.csv"]);
    assert_eq!(stats(path, &["q.csv", "--dim", "2", "--verify"])[0]["verified"], true);
}

#[test]
fn verify_says_what_is_wrong_and_where() {
    let folder = folder();
    let path = folder.path();
    succeeds(path, &["generate", "uniform", "30", "-o", "p.xyz"]);
    succeeds(path, &["triangulate", "p.xyz", "-o", "m.ele"]);
    let ele = fs::read_to_string(path.join("m.ele")).unwrap();
    let flipped: Vec<String> = ele
        .lines()
        .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
            ["3", a, b, c, d] => format!("3 {b} {a} {c} {d}"),
            _ => line.into(),
        })
        .collect();
    fs::write(path.join("m.ele"), flipped.join("\n")).unwrap();
    fs::remove_file(path.join("m.neigh")).unwrap();
    fails(path, &["verify", "p.xyz", "m.ele"], "m.ele: not the Delaunay triangulation: orientation: tetrahedron 3");
    // Also where nobody reads the report.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let closed = command(path, &["verify", "p.xyz", "m.ele"]).stdout(writer).stderr(Stdio::piped()).spawn().unwrap();
    fails_with(closed.wait_with_output().unwrap(), "orientation: tetrahedron 3");
    fs::write(path.join("m.ele"), "1 4 0\n0 0 1 2 99\n").unwrap();
    fails(path, &["verify", "p.xyz", "m.ele"], "tetrahedron 0");
}
