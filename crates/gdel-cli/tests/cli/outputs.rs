//! What is written, and what is left alone.

use crate::{command, fails, fails_with, files, folder, gdel, succeeds};
use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
};

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.1 0.1 0.1\n";

#[test]
fn the_input_is_never_overwritten() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("scan.obj"), TETRAHEDRON).unwrap();
    fs::hard_link(path.join("scan.obj"), path.join("hard.obj")).unwrap();
    fs::create_dir(path.join("sub")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(path.join("scan.obj"), path.join("soft.obj")).unwrap();
    let absolute = path.join("scan.obj").to_str().unwrap().to_owned();
    let mut names = vec!["scan.obj", "./scan.obj", "sub/../scan.obj", &absolute, "hard.obj"];
    if cfg!(unix) {
        names.push("soft.obj");
    }
    for name in names {
        for force in [&[][..], &["--force"]] {
            let arguments = [&["triangulate", "scan.obj", "-o", "m.vtu", "-o", name], force].concat();
            fails(path, &arguments, "this is the input scan.obj: choose another name for the output");
        }
    }
    assert_eq!(fs::read_to_string(path.join("scan.obj")).unwrap(), TETRAHEDRON);
    assert!(!path.join("m.vtu").exists());
    // TetGen's three files have one name.
    succeeds(path, &["generate", "ball", "9", "-o", "p.node"]);
    fails(path, &["triangulate", "p.node", "-o", "p.ele"], "p.node: this is the input p.node");
}

#[test]
fn other_files_are_replaced_by_force_only() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("scan.obj"), TETRAHEDRON).unwrap();
    let outputs = ["m.ele", "m.vtu", "m.npz", "h.ply", "h.obj", "h.stl", "h.glb", "h.3mf"];
    for name in outputs {
        let name = if name == "m.ele" { "m.neigh" } else { name };
        fs::write(path.join(name), "precious").unwrap();
        fails(path, &["triangulate", "scan.obj", "-o", name], &format!("{name}: this file exists, and is not a "));
        assert_eq!(fs::read_to_string(path.join(name)).unwrap(), "precious");
        for dim in ["2", "3"] {
            succeeds(path, &["triangulate", "scan.obj", "--force", "--dim", "3", "-o", name]);
            // Earlier outputs are replaced without asking.
            succeeds(path, &["triangulate", "scan.obj", "-o", name]);
            let again = gdel(path, &["triangulate", "scan.obj", "--dim", dim, "-o", name]);
            assert!(again.status.success());
        }
    }
    // Double precision has another form in STL.
    fs::write(path.join("third.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 0.3333333333333333\n").unwrap();
    succeeds(path, &["triangulate", "third.xyz", "-o", "h.stl"]);
    succeeds(path, &["triangulate", "third.xyz", "-o", "h.stl"]);
    fails(path, &["generate", "ball", "9", "-o", "scan.obj"], "scan.obj: this file exists");
    assert_eq!(fs::read_to_string(path.join("scan.obj")).unwrap(), TETRAHEDRON);
    succeeds(path, &["generate", "ball", "9", "--force", "-o", "scan.obj"]);
}

/// No output is begun, nor a point read, before all outputs are known to be possible; no message
/// names a temporary file.
#[test]
fn outputs_are_probed_first_and_messages_name_them() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("file"), "").unwrap();
    fs::create_dir(path.join("m.neigh")).unwrap();
    for (output, message) in [
        ("none/m.vtu", "none/m.vtu: cannot be written: No such file or directory (os error 2)\n"),
        ("file/m.vtu", "file/m.vtu: cannot be written: Not a directory (os error 20)\n"),
        ("m.ele", "m.neigh: cannot be written: is a directory\n"),
    ] {
        // The input does not even exist.
        for arguments in [&["triangulate", "none.xyz", "-o", output][..], &["triangulate", "none.xyz", "-fo", output]] {
            let output = gdel(path, arguments);
            let stderr = String::from_utf8(output.stderr).unwrap();
            assert!(stderr.starts_with("gdel: ") && !stderr.contains(".tmp"), "{stderr}");
            if cfg!(unix) {
                assert_eq!(stderr, format!("gdel: {message}"));
            }
        }
    }
    assert_eq!(files(path), ["file", "m.neigh"]);
}

/// Stops the program in the midst of writing, and lets it go on with a signal.
#[cfg(target_os = "linux")]
#[test]
fn signals_leave_no_temporary_files() {
    use std::os::unix::process::ExitStatusExt;
    let folder = folder();
    let path = folder.path();
    succeeds(path, &["generate", "uniform", "5000", "-o", "p.f64"]);
    let outputs: Vec<String> = (0..20).map(|i| format!("m{i}.ele")).collect();
    let mut arguments = vec!["triangulate", "p.f64", "--backend", "cpu", "--force"];
    arguments.extend(outputs.iter().flat_map(|output| ["-o", output]));
    for (name, number) in [("INT", 2), ("TERM", 15)] {
        // Where the program comes to its end without having been met while it wrote, it begins
        // again.
        let status = loop {
            let mut child = command(path, &arguments).stdout(Stdio::null()).spawn().unwrap();
            let is_met = loop {
                signal("STOP", child.id());
                wait_for_state(child.id(), &['T', 'Z']);
                if writes(path) || child.try_wait().unwrap().is_some() {
                    break writes(path);
                }
                signal("CONT", child.id());
            };
            signal(name, child.id());
            signal("CONT", child.id());
            let status = child.wait().unwrap();
            if is_met {
                break status;
            }
            assert!(status.success(), "{status}");
        };
        assert_eq!(status.signal(), Some(number));
        assert!(!files(path).iter().any(|file| file.contains("tmp")), "{name}: {:?}", files(path));
    }
}

/// Whether there is a temporary file with content; those of the check are empty.
#[cfg(target_os = "linux")]
fn writes(folder: &Path) -> bool {
    fs::read_dir(folder).unwrap().any(|entry| {
        let entry = entry.unwrap();
        let is_temporary = entry.file_name().to_string_lossy().ends_with(".tmp");
        is_temporary && entry.metadata().is_ok_and(|metadata| metadata.len() > 0)
    })
}

/// Sends a signal; it does not matter if the process has ended.
#[cfg(target_os = "linux")]
fn signal(signal: &str, process: u32) {
    let script = format!("kill -{signal} {process} 2> /dev/null");
    Command::new("sh").args(["-c", &script]).status().unwrap();
}

/// Waits until the process is in one of these states; one that is gone is.
#[cfg(target_os = "linux")]
fn wait_for_state(process: u32, states: &[char]) {
    let state = || {
        let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
        stat.rsplit_once(") ")?.1.chars().next()
    };
    while state().is_some_and(|state| !states.contains(&state)) {
        std::thread::yield_now();
    }
}

#[test]
fn outputs_that_cannot_be_written() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("p.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
    fs::create_dir(path.join("folder.vtu")).unwrap();
    fails(path, &["triangulate", "p.xyz", "-o", "none/m.vtu"], "none/m.vtu: cannot be written: No such file");
    fails(path, &["triangulate", "p.xyz", "-o", "folder.vtu"], "folder.vtu: cannot be written: is a directory");
    if cfg!(target_os = "linux") {
        // Nobody, not even root, makes files there.
        fails(path, &["triangulate", "p.xyz", "-o", "/proc/m.vtu"], "/proc/m.vtu: cannot be written");
        fails(path, &["generate", "ball", "9", "-o", "/proc/p.xyz"], "/proc/p.xyz: cannot be written");
    }
    assert_eq!(files(path), ["folder.vtu", "p.xyz"]);
}

/// A limit on file sizes stands for the full disk: the system fails writes in the same way.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_old_files_and_no_new_ones() {
    for extension in ["vtu", "npz", "ele", "ply", "obj", "stl", "glb", "3mf"] {
        let folder = folder();
        let path = folder.path();
        succeeds(path, &["generate", "sphere", "5000", "-o", "p.f64"]);
        let name = format!("m.{extension}");
        fs::write(path.join(&name), "the old file").unwrap();
        let script = format!(
            "ulimit -f 50; trap '' XFSZ; exec '{}' triangulate p.f64 --force -o {name} -o n.ele",
            env!("CARGO_BIN_EXE_gdel")
        );
        let output = Command::new("sh").args(["-c", &script]).current_dir(path).output().unwrap();
        let failed = if extension == "ele" { "m.node" } else { &name };
        fails_with(output, &format!("{failed}: cannot be written: File too large"));
        assert_eq!(files(path), [name.as_str(), "p.f64"]);
        assert_eq!(fs::read(path.join(&name)).unwrap(), b"the old file");
    }
}

#[cfg(unix)]
#[test]
fn outputs_have_the_usual_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let path = folder.path();
    succeeds(path, &["generate", "ball", "5", "-o", "p.xyz"]);
    fs::write(path.join("usual"), "").unwrap();
    let mode = |name| fs::metadata(path.join(name)).unwrap().permissions().mode();
    assert_eq!(mode("p.xyz"), mode("usual"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error_and_a_closed_one_is_not() {
    let folder = folder();
    fs::write(folder.path().join("p.xyz"), "0 0 0\n").unwrap();
    let arguments = ["triangulate", "p.xyz"];
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = command(folder.path(), &arguments).stdout(full).stderr(Stdio::piped()).spawn().unwrap();
    fails_with(output.wait_with_output().unwrap(), "standard output: No space left");
    // The files are written all the same.
    for arguments in [
        &["triangulate", "p.xyz", "-o", "closed.vtu"][..],
        &["triangulate", "p.xyz", "-o", "closed.npz", "--repeat", "3", "--stats", "json"],
        &["tree", "p.xyz", "-o", "closed.csv", "--repeat", "3"],
    ] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = command(folder.path(), arguments).stdout(writer).stderr(Stdio::piped()).spawn().unwrap();
        let output = output.wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        assert!(folder.path().join(arguments[3]).exists(), "{arguments:?}");
    }
}
