//! What is read, and what the user learns about it.

use crate::{command, fails, fails_with, files, folder, gdel, stats, succeeds};
use std::{
    fs,
    io::Write,
    path::Path,
    process::{Command, Stdio},
};

/// Runs the program with these bytes on its standard input.
fn with_input(folder: &Path, arguments: &[&str], input: &[u8]) -> std::process::Output {
    let mut command = command(folder, arguments);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(input).unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn standard_input_with_a_format() {
    let folder = folder();
    let path = folder.path();
    let points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let output = with_input(path, &["triangulate", "-", "--format", "xyz", "-o", "m.vtu"], points.as_bytes());
    assert!(String::from_utf8(output.stdout).unwrap().contains("tetrahedra      1\n"));
    let output = with_input(path, &["verify", "-", "m.vtu", "--format", "xyz"], points.as_bytes());
    assert!(output.status.success());
    let output = with_input(path, &["triangulate", "-", "--format", "ply"], points.as_bytes());
    fails_with(output, "standard input: line 1: not PLY");
    let output = with_input(path, &["triangulate", "-"], b"");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("give its format with `--format`"));
    // The format of a file, whatever its name.
    fs::write(path.join("points.dat"), points).unwrap();
    succeeds(path, &["triangulate", "points.dat", "--format", "xyz"]);
}

#[test]
fn points_in_2d() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("p.xyz"), "0 0\n4 0\n0 3\n5 5\n").unwrap();
    fs::write(path.join("p.csv"), "X,Y\n0,0\n4,0\n0,3\n5,5\n").unwrap();
    succeeds(path, &["generate", "uniform", "200", "--dim", "2", "-o", "p.npy"]);
    for (name, triangles) in [("p.xyz", 2), ("p.csv", 2)] {
        assert_eq!(stats(path, &["--dim", "2", name])[0]["triangles"], triangles, "{name}");
        fails(path, &["triangulate", name], "x, y and z");
    }
    let npy = fs::read(path.join("p.npy")).unwrap();
    assert!(String::from_utf8_lossy(&npy).contains("'shape': (200, 2)"));
    assert_eq!(stats(path, &["--dim", "2", "--verify", "p.npy"])[0]["verified"], true);
    fails(path, &["triangulate", "p.npy"], "2D points: the array has shape [200, 2]");
}

#[test]
fn dropped_coordinates_and_ignored_columns_are_reported() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("p.xyz"), "0 0 0 1 0 0\n0 1 0 0 0 1\n").unwrap();
    let summary = succeeds(path, &["triangulate", "p.xyz"]);
    assert!(summary.starts_with("points          2; 3 columns after the coordinates are ignored\n"), "{summary}");
    assert_eq!(stats(path, &["p.xyz"])[0]["ignored_columns"], 3);
    fs::write(path.join("q.xyz"), "0 0 1\n1 0 0\n0 1 0\n").unwrap();
    let output = gdel(path, &["triangulate", "q.xyz", "--dim", "2"]);
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "gdel: q.xyz: the z coordinates are dropped\n");
}

/// No control character of a name reaches the terminal, neither from us nor from the parser of
/// arguments.
#[cfg(unix)]
#[test]
fn control_characters_in_file_names_are_escaped() {
    let folder = folder();
    let path = folder.path();
    let name = "a\u{1b}[31m\u{7}\u{202e}.xyz";
    fs::write(path.join(name), "1 2 x\n").unwrap();
    fails(path, &["triangulate", name], r"a\u{1b}[31m\u{7}\u{202e}.xyz: line 1: `x` is not a number");
    for arguments in [
        &["triangulate", "none\u{1b}[2J.xyz"][..],
        &["triangulate", "a\u{7}.doc"],
        &["triangulate", "p.xyz", "-o", "m\u{1b}c.doc"],
        &["triangulate", "p.xyz", "m\u{1b}c.doc"],
        &["verify", name, "m.ele"],
        &["generate", "ball", "3", "-o", "none\u{1b}/p.xyz"],
    ] {
        let output = gdel(path, arguments);
        assert!(!output.status.success());
        let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        assert!(!text.contains(|c: char| (c.is_control() && c != '\n') || c == '\u{202e}'), "{text:?}");
    }
}

#[test]
fn input_that_cannot_be_read() {
    let folder = folder();
    let path = folder.path();
    fs::create_dir(path.join("folder.ply")).unwrap();
    fs::write(path.join("p.doc"), "1 2 3").unwrap();
    fs::write(path.join("p"), "1 2 3").unwrap();
    fs::write(path.join("empty.xyz"), "").unwrap();
    fs::write(path.join("empty.ply"), "").unwrap();
    fs::write(path.join("bad.xyz"), "1 2 3\n4 5 six\n").unwrap();
    fails(path, &["triangulate", "none.ply"], "none.ply: cannot be read: No such file");
    fails(path, &["triangulate", "folder.ply"], "folder.ply: cannot be read: is a directory");
    fails(path, &["triangulate", "."], ".: cannot be read: is a directory");
    fails(path, &["triangulate", "p.doc"], "p.doc: unknown extension, point clouds end in .ply");
    fails(path, &["triangulate", "p"], "p: unknown extension");
    fails(path, &["triangulate", "empty.ply"], "empty.ply: byte 0: the file is empty");
    assert!(succeeds(path, &["triangulate", "empty.xyz"]).contains("there are no points"));
    fails(path, &["triangulate", "bad.xyz"], "bad.xyz: line 2: `six` is not a number");
    fails(path, &["verify", "bad.xyz", "m.ele"], "bad.xyz: line 2");
    fails(path, &["generate", "ball", "3", "-o", "p.las"], "p.las: unknown extension");
    assert_eq!(files(path).len(), 6);
}

#[cfg(unix)]
#[test]
fn input_without_permission() {
    use std::os::unix::{fs::PermissionsExt, process::CommandExt};
    let folder = folder();
    let path = folder.path();
    let set_mode = |file: &Path, mode| fs::set_permissions(file, fs::Permissions::from_mode(mode)).unwrap();
    fs::write(path.join("p.xyz"), "1 2 3\n").unwrap();
    set_mode(&path.join("p.xyz"), 0o0);
    let mut command = command(path, &["triangulate", "p.xyz"]);
    if fs::read(path.join("p.xyz")).is_ok() {
        // We are root, who may read everything. Nobody may not, not even the program where it is.
        // A process of its own copies it: one that another test starts meanwhile would inherit the open file from
        // this one, and what is open for writing cannot be run.
        let copied = Command::new("cp").arg(env!("CARGO_BIN_EXE_gdel")).arg(path.join("gdel")).status();
        assert!(copied.expect("cp runs").success());
        set_mode(path, 0o755);
        command = Command::new(path.join("gdel"));
        command.current_dir(path).args(["triangulate", "p.xyz"]).stdin(Stdio::null()).uid(65534);
    }
    fails_with(command.output().expect("the program runs"), "p.xyz: cannot be read: Permission denied");
}
