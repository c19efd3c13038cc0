//! The command `gdel` as its users meet it.

mod constrain;
// The program itself has no harness, so its own tests run here.
#[cfg(feature = "decimate")]
#[path = "../../src/decimate.rs"]
#[expect(dead_code, reason = "its tests only")]
mod decimate;
mod derived;
mod inputs;
mod outputs;
mod refine;
mod tiles;
mod tin;
mod verify;
mod weights;

#[path = "../../../gdel-io/tests/io/samples.rs"]
mod samples;

use std::{
    fs,
    path::Path,
    process::{Command, Output, Stdio},
};

fn gdel(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().expect("the program runs")
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gdel"));
    // Without these, libraries of graphics drivers complain on standard error.
    for name in ["XDG_RUNTIME_DIR", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    command
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

#[track_caller]
fn succeeds(folder: &Path, arguments: &[&str]) -> String {
    let output = gdel(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {stderr}");
    // No progress bar where stderr is no terminal.
    assert_eq!(stderr, "");
    String::from_utf8(output.stdout).expect("text")
}

/// Checks for exit code 1, and one line on stderr that contains `message`.
#[track_caller]
fn fails(folder: &Path, arguments: &[&str], message: &str) {
    fails_with(gdel(folder, arguments), message);
}

#[track_caller]
fn fails_with(output: Output, message: &str) {
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    assert!(stderr.starts_with("gdel: ") && stderr.contains(message), "{stderr}");
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Nothing but the list is written, whatever drivers have to say.
#[test]
fn adapters_are_listed_in_silence() {
    assert!(!succeeds(folder().path(), &["adapters"]).is_empty());
}

/// The self-test has the same names in both dimensions, and both backends make the same meshes.
#[test]
fn adapters_are_tested() {
    let report = succeeds(folder().path(), &["adapters", "--test", "--points", "1000,500"]);
    let lines: Vec<&str> = report.split("\n\n").next().unwrap().lines().collect();
    let [title, version, device, driver, system, tests @ .., result] = &lines[..] else { panic!("{report}") };
    assert_eq!((*title, *result), ("gdel report 1", "result: right"), "{report}");
    assert_eq!(*version, format!("version: {}", env!("CARGO_PKG_VERSION")));
    for (line, start) in [(device, "device: "), (driver, "driver: "), (system, "system: ")] {
        assert!(line.starts_with(start), "{report}");
    }
    let starts =
        ["self-test 3D: passed in ", "self-test 2D: passed in ", "3D 1000: ", "3D 500: ", "2D 1000: ", "2D 500: "];
    assert_eq!(tests.len(), starts.len(), "{report}");
    for (line, start) in tests.iter().zip(starts) {
        assert!(line.starts_with(start), "{report}");
        let end = if start.starts_with("self-test") { " ms)" } else { " ms, same" };
        assert!(line.ends_with(end), "{report}");
    }
}

const BUNNY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/bunny.ply");

#[test]
fn bunny_to_all_outputs_and_back() {
    let folder = folder();
    let path = folder.path();
    let outputs =
        ["-o", "b.ele", "-o", "b.vtu", "-o", "b.npz", "-o", "h.ply", "-o", "h.obj", "-o", "h.stl", "-o", "h.glb"];
    let summary = succeeds(path, &[&["triangulate", BUNNY, "--verify"], &outputs[..]].concat());
    assert!(
        summary.contains("tetrahedra      246218")
            && summary.contains("verified        this is the Delaunay triangulation"),
        "{summary}"
    );
    assert_eq!(files(path), ["b.ele", "b.neigh", "b.node", "b.npz", "b.vtu", "h.glb", "h.obj", "h.ply", "h.stl"]);
    for mesh in ["b.node", "b.ele", "b.neigh", "b.vtu", "b.npz"] {
        succeeds(path, &["verify", BUNNY, mesh]);
    }
    // All points of a hull are on its hull, so each of the three files has the same one.
    for hull in ["h.ply", "h.obj", "h.stl"] {
        assert_eq!(stats(path, &[hull])[0]["hull_triangles"], 3120, "{hull}");
    }
    // And `.node` holds the points.
    assert_eq!(stats(path, &["b.node"])[0]["tetrahedra"], 246_218);
}

/// The objects that `triangulate --stats json` prints.
#[track_caller]
fn stats(folder: &Path, arguments: &[&str]) -> Vec<serde_json::Value> {
    let output = succeeds(folder, &[&["triangulate", "--stats", "json"], arguments].concat());
    output.lines().map(|line| serde_json::from_str(line).expect("a JSON object a line")).collect()
}

#[test]
fn stats_as_json_for_each_run() {
    let folder = folder();
    fs::write(folder.path().join("p.csv"), "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n0,0,1\n").unwrap();
    let runs = stats(folder.path(), &["p.csv", "--repeat", "3", "--backend", "cpu"]);
    assert_eq!(runs.len(), 3);
    for run in runs {
        let expected = [("points", 5), ("duplicates", 1), ("dimension", 3), ("tetrahedra", 1), ("hull_triangles", 4)];
        for (key, value) in expected {
            assert_eq!(run[key], value, "{run}");
        }
        assert_eq!(run["backend"], "cpu");
        let seconds = run["seconds"].as_object().unwrap();
        let total = seconds["total"].as_f64().unwrap();
        let phases: f64 = seconds.iter().filter(|(name, _)| *name != "total").map(|(_, s)| s.as_f64().unwrap()).sum();
        assert!(seconds.len() > 1 && phases > 0.0 && phases <= total, "{run}");
    }
}

#[test]
fn stats_of_the_gpu_engine_as_json() {
    let folder = folder();
    succeeds(folder.path(), &["generate", "thin-sphere", "900", "-o", "p.npy"]);
    let runs = stats(folder.path(), &["p.npy", "--repeat", "2", "--backend", "gpu"]);
    assert_eq!(runs.len(), 2);
    for run in &runs {
        assert_eq!((&run["backend"], run.get("fallback")), (&"gpu".into(), None), "{run}");
        let rounds = run["gpu"]["rounds"].as_array().unwrap();
        let inserted: u64 = rounds.iter().map(|round| round["inserted"].as_u64().unwrap()).sum();
        assert_eq!(inserted, 900, "{run}");
        for key in ["flips_23", "flip_iterations", "exact_tests", "readbacks", "dispatches", "submits", "bytes"] {
            assert!(run["gpu"][key].as_u64() > Some(0), "{key} in {run}");
        }
        assert!(run["splay"]["built"].is_u64() && run["exact"]["integer"].is_u64(), "{run}");
    }
    let auto = &stats(folder.path(), &["p.npy", "--backend", "auto"])[0];
    assert_eq!(auto["backend"], "cpu");
    assert!(auto["fallback"]["message"].as_str().unwrap().contains("900 points are too few"), "{auto}");
}

#[test]
fn points_without_return_are_reported() {
    let folder = folder();
    let header =
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n";
    fs::write(folder.path().join("p.pcd"), format!("{header}0 0 0\nnan nan nan\n1 0 0\n")).unwrap();
    let run = &stats(folder.path(), &["p.pcd"])[0];
    assert_eq!((&run["points"], &run["no_return"], &run["dimension"]), (&2.into(), &1.into(), &1.into()));
    assert!(succeeds(folder.path(), &["triangulate", "p.pcd"]).contains("1 without a return"));
}

#[test]
fn scans_of_one_file_are_triangulated_together() {
    let folder = folder();
    let scans = [samples::e57_single(&samples::POINTS), samples::e57_spherical()];
    fs::write(folder.path().join("p.E57"), samples::e57(&scans)).unwrap();
    let run = &stats(folder.path(), &["p.E57", "--verify"])[0];
    assert_eq!((&run["points"], &run["no_return"], &run["dimension"]), (&8.into(), &1.into(), &3.into()));
    fs::write(folder.path().join("q.e57"), &samples::e57(&scans)[..3000]).unwrap();
    fails(folder.path(), &["triangulate", "q.e57"], "q.e57: byte 0: not an E57 file that can be read: ");
}

#[test]
fn flat_input_has_a_dimension_and_no_tetrahedra() {
    let folder = folder();
    fs::write(folder.path().join("p.xyz"), "0 0 0\n1 0 0\n0 1 0\n1 1 0\n").unwrap();
    let summary = succeeds(folder.path(), &["triangulate", "p.xyz", "-o", "m.node", "--verify"]);
    assert!(summary.contains("coplanar"), "{summary}");
    assert_eq!(fs::read_to_string(folder.path().join("m.ele")).unwrap(), "0 4 0\n# Generated by gdel\n");
}

#[test]
fn generated_points_depend_on_the_seed_alone() {
    let folder = folder();
    let path = folder.path();
    for kind in ["uniform", "gaussian", "ball", "sphere", "thin-sphere", "grid"] {
        succeeds(path, &["generate", kind, "50", "--seed", "7", "-fo", "a.f64"]);
        succeeds(path, &["generate", kind, "50", "--seed", "7", "-fo", "b.f64"]);
        succeeds(path, &["generate", kind, "50", "--seed", "8", "-fo", "c.f64"]);
        let [a, b, c] = ["a.f64", "b.f64", "c.f64"].map(|name| fs::read(path.join(name)).unwrap());
        assert_eq!(a.len(), 50 * 24);
        assert!(a == b && a != c, "{kind}");
    }
    for name in ["p.ply", "p.obj", "p.xyz", "p.csv", "p.npy", "p.node", "p.f64"] {
        succeeds(path, &["generate", "ball", "40", "-o", name]);
        succeeds(path, &["triangulate", name, "-o", "ball.ele"]);
        // The same points whatever the format.
        succeeds(path, &["triangulate", "p.ply", "-o", "same.ele"]);
        assert_eq!(fs::read(path.join("ball.ele")).unwrap(), fs::read(path.join("same.ele")).unwrap(), "{name}");
    }
}

#[test]
fn wrong_usage_is_2() {
    let folder = folder();
    for arguments in [
        &["triangulate"][..],
        &["triangulate", "p.xyz", "-o", "m.doc"],
        &["triangulate", "p.xyz", "--backend", "abacus"],
        &["triangulate", "p.xyz", "--repeat", "0"],
        &["generate", "torus", "5", "-o", "p.xyz"],
        &["generate", "ball", "-5", "-o", "p.xyz"],
        &["verify"],
        &["triangulate", "-"],
        &["triangulate", "-", "--format", "doc"],
        &["verify", "-", "m.ele"],
        &["verify", "m.ele", "--format", "xyz"],
        &["triangulate", "p.xyz", "--engine", "cpu"],
        &["fly"],
    ] {
        assert_eq!(gdel(folder.path(), arguments).status.code(), Some(2), "{arguments:?}");
    }
}
