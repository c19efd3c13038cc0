//! Meshes in tiles: points and meshes that are larger than memory.

use super::{command, fails, fails_with, files, folder, gdel, succeeds};
use gdel::Points;
use serde_json::Value;
use std::{
    fs::{self, File},
    path::Path,
    process::Command,
};

/// Splits a few thousand points into several tiles.
const SMALL: &str = "--memory=600KB";

fn stats(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Returns the contents of all files in a folder.
fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    files(folder).into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

/// Writes points that a distribution has, as `points.npy`.
fn generate(folder: &Path, distribution: &str, count: &str, dim: &str) {
    succeeds(folder, &["generate", distribution, count, "--dim", dim, "--force", "-o", "points.npy"]);
}

#[test]
fn tiles_have_the_simplices_of_one_mesh() {
    for (distribution, dim, name) in [
        ("uniform", "3", "tetrahedra"),
        ("grid", "3", "tetrahedra"),
        ("sphere", "3", "tetrahedra"),
        ("uniform", "2", "triangles"),
    ] {
        let folder = folder();
        let folder = folder.path();
        generate(folder, distribution, "6000", dim);
        let whole = stats(&succeeds(folder, &["triangulate", "points.npy", "--dim", dim, "--stats", "json"]));
        for format in ["npz", "vtu"] {
            let run = ["triangulate", "--tiles", format, SMALL, "--dim", dim, "--tile-format", format];
            let tiled = succeeds(folder, &[&run[..], &["points.npy", "--verify", "--stats", "json"]].concat());
            let tiled = stats(&tiled);
            assert!(tiled["tiles"].as_u64() >= Some(4), "{tiled}");
            assert_eq!(tiled["verified"], true);
            assert_eq!([&tiled["points"], &tiled[name]], [&whole["points"], &whole[name]], "{distribution}");
            let names = files(&folder.join(format));
            let expected = format!("mesh.json tile-00000.{format}");
            let first: Vec<&str> =
                names.iter().map(String::as_str).filter(|name| *name != "mesh.pvtu").take(2).collect();
            assert_eq!(first.join(" "), expected);
            assert!(!names.contains(&"unfinished".into()));
            let report = succeeds(folder, &["verify", format, "--dim", dim]);
            assert!(report.contains("delaunay             passed"), "{report}");
        }
        assert!(fs::read_to_string(folder.join("vtu/mesh.pvtu")).unwrap().contains("tile-00003.vtu"));
    }
}

#[test]
fn points_of_several_files_follow_each_other() {
    let folder = folder();
    let folder = folder.path();
    let formats = ["npy", "f64", "f32", "xyz", "ply"];
    let mut all: Vec<[f64; 3]> = Vec::new();
    for (seed, format) in formats.iter().enumerate() {
        let name = format!("{seed}.{format}");
        succeeds(folder, &["generate", "uniform", "900", "--seed", &seed.to_string(), "-o", &name]);
        let cloud = gdel_io::files::read_points(&folder.join(&name)).unwrap();
        all.extend(Points::from(&cloud).iter());
    }
    // Points of the first file again: duplicates across files.
    fs::copy(folder.join("0.npy"), folder.join("5.npy")).unwrap();
    all.extend_from_within(..900);
    let names = ["0.npy", "1.f64", "2.f32", "3.xyz", "4.ply", "5.npy"];
    let text = succeeds(folder, &[&["triangulate", "--tiles", "mesh", SMALL, "--verify"], &names[..]].concat());
    assert!(text.starts_with("points          5400 (900 duplicates)\n"), "{text}");
    let mut found = vec![None; all.len()];
    for name in files(&folder.join("mesh")).iter().filter(|name| name.ends_with("npz")) {
        let file = File::open(folder.join("mesh").join(name)).unwrap();
        let (piece, _) = gdel_io::read_tile::<gdel::Mesh3, 3, 4>(file).unwrap();
        piece.indices.iter().zip(&piece.points).for_each(|(&i, &p)| found[i as usize] = Some(p));
    }
    assert!(found.iter().zip(&all).all(|(found, p)| *found == Some(*p)));
}

#[test]
fn flat_points_have_no_simplices() {
    let folder = folder();
    let folder = folder.path();
    let plane: String = (0..200).map(|i| format!("{} {} 7\n", i % 20, i / 20)).collect();
    fs::write(folder.join("plane.xyz"), plane).unwrap();
    fs::write(folder.join("none.xyz"), "").unwrap();
    let text = succeeds(folder, &["triangulate", "plane.xyz", "--tiles", "plane", "--memory", "20000", "--verify"]);
    assert!(text.contains("dimension       2, so there are no tetrahedra"), "{text}");
    let text = succeeds(folder, &["triangulate", "none.xyz", "--tiles", "none", "--verify"]);
    assert!(text.starts_with("points          0\n"), "{text}");
}

/// A run that ends anywhere, as by a full disk, is finished by the next one: with the same files as if nothing had
/// happened.
#[cfg(unix)]
#[test]
fn a_run_that_was_ended_goes_on() {
    let folder = folder();
    let folder = folder.path();
    generate(folder, "uniform", "4000", "3");
    let arguments = |tiles| ["triangulate", "points.npy", SMALL, "--tiles", tiles];
    succeeds(folder, &arguments("whole"));
    let expected = contents(&folder.join("whole"));
    // No file may grow beyond so many blocks of 512 bytes.
    let limited = |blocks: u32| {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
        let program = env!("CARGO_BIN_EXE_gdel");
        let mut command = Command::new("sh");
        command.current_dir(folder).args(["-c", &script, program]).args(arguments("ended"));
        command.output().unwrap()
    };
    for blocks in [1, 20, 60, 120, 200] {
        fails_with(limited(blocks), "ended/unfinished");
        assert!(!folder.join("ended/mesh.json").exists());
    }
    let text = succeeds(folder, &arguments("ended"));
    assert!(text.contains("after an earlier run"), "{text}");
    assert!(contents(&folder.join("ended")) == expected);

    // Whatever file is lacking since a run was killed before it.
    let mut ended = 0;
    loop {
        fs::remove_dir_all(folder.join("ended")).unwrap();
        let mut run = command(folder, &arguments("ended")).spawn().unwrap();
        // After so many of its files were there at some time, the run is killed.
        let mut seen = std::collections::HashSet::new();
        let is_done = loop {
            if let Ok(entries) = fs::read_dir(folder.join("ended/unfinished")) {
                seen.extend(entries.filter_map(|entry| Some(entry.ok()?.file_name())));
            }
            if seen.len() > ended {
                let _ = run.kill();
                break false;
            }
            if run.try_wait().unwrap().is_some() {
                break true;
            }
            std::thread::yield_now();
        };
        run.wait().unwrap();
        succeeds(folder, &arguments("ended"));
        assert!(contents(&folder.join("ended")) == expected, "killed after {ended} files");
        if is_done || ended > 60 {
            break;
        }
        ended += 7;
    }
}

#[test]
fn damaged_files_are_errors() {
    let folder = folder();
    let folder = folder.path();
    generate(folder, "uniform", "3000", "3");
    succeeds(folder, &["triangulate", "points.npy", SMALL, "--tiles", "mesh"]);
    let tile = folder.join("mesh/tile-00001.npz");
    let bytes = fs::read(&tile).unwrap();
    fs::write(&tile, &bytes[..bytes.len() / 2]).unwrap();
    fails(folder, &["verify", "mesh"], "tile-00001.npz");
    fs::remove_file(&tile).unwrap();
    fails(folder, &["verify", "mesh"], "tile-00001.npz");
    fs::write(&tile, &bytes).unwrap();
    succeeds(folder, &["verify", "mesh"]);
    // Another tile in its place.
    fs::copy(folder.join("mesh/tile-00000.npz"), &tile).unwrap();
    let output = gdel(folder, &["verify", "mesh"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stdout).contains("FAILED"), "{output:?}");
    fails(folder, &["verify", "mesh", "--dim", "2"], "dimension 3");
    fs::create_dir(folder.join("empty")).unwrap();
    fails(folder, &["verify", "empty"], "not a mesh in tiles");
}

#[test]
fn other_folders_are_left_alone() {
    let folder = folder();
    let folder = folder.path();
    generate(folder, "uniform", "500", "3");
    fs::create_dir(folder.join("mine")).unwrap();
    fs::write(folder.join("mine/letter.txt"), "dear").unwrap();
    let run = ["triangulate", "points.npy", "--tiles", "mine"];
    fails(folder, &run, "add `--force`");
    assert_eq!(files(&folder.join("mine")), ["letter.txt"]);
    succeeds(folder, &[&run[..], &["--force"]].concat());
    assert_eq!(files(&folder.join("mine")), ["letter.txt", "mesh.json", "tile-00000.npz"]);
    // A finished mesh is replaced by one of other points, with fewer tiles.
    generate(folder, "uniform", "3000", "3");
    succeeds(folder, &[&run[..], &[SMALL]].concat());
    generate(folder, "grid", "900", "3");
    succeeds(folder, &run);
    assert_eq!(files(&folder.join("mine")), ["letter.txt", "mesh.json", "tile-00000.npz"]);
    // Another run has the folder.
    fs::create_dir(folder.join("mine/unfinished")).unwrap();
    let lock = File::create(folder.join("mine/unfinished/lock")).unwrap();
    lock.lock().unwrap();
    fails(folder, &run, "another run is writing it");
}

/// `auto` takes no software for a GPU, since the CPU backend is faster.
#[test]
fn gpus_triangulate_tiles() {
    let folder = folder();
    let folder = folder.path();
    for (dim, name) in [("3", "tetrahedra"), ("2", "triangles")] {
        generate(folder, "uniform", "6000", dim);
        let run = |backend| {
            let tiles = format!("{backend}-{dim}");
            let run = ["triangulate", "points.npy", SMALL, "--dim", dim, "--backend", backend, "--tiles", &tiles];
            stats(&succeeds(folder, &[&run[..], &["--verify", "--stats", "json"]].concat()))
        };
        let [cpu, gpu] = ["cpu", "gpu"].map(run);
        assert_eq!([&gpu["gpus"], &gpu["fallbacks"], &cpu["gpus"]], [1, 0, 0]);
        assert_eq!(gpu["verified"], true);
        assert_eq!([&gpu[name], &gpu["sent"]], [&cpu[name], &cpu["sent"]]);
    }
}

#[test]
fn bad_input_is_named() {
    let folder = folder();
    let folder = folder.path();
    fs::write(folder.join("good.xyz"), "0 0 0\n1 0 0\n0 1 0\n").unwrap();
    let mut bad: Vec<u8> = [0.0, 0.0, 1.0, 5.0, f64::NAN, 0.0].iter().flat_map(|x: &f64| x.to_le_bytes()).collect();
    fs::write(folder.join("bad.f64"), &bad).unwrap();
    let run = |name| ["triangulate", "--tiles", "mesh", "good.xyz", name];
    fails(folder, &run("bad.f64"), "bad.f64: point 1: the y coordinate is NaN");
    bad.truncate(30);
    fs::write(folder.join("bad.f64"), &bad).unwrap();
    fails(folder, &run("bad.f64"), "the file ends within a point");
    fails(folder, &run("missing.npy"), "missing.npy: cannot be read");
    for arguments in [
        &["triangulate", "good.xyz", "good.xyz"][..],
        &["triangulate", "good.xyz", "--memory", "1GB"],
        &["triangulate", "good.xyz", "--tiles", "mesh", "--memory", "lots"],
        &["triangulate", "good.xyz", "--tiles", "mesh", "-o", "mesh.vtu"],
    ] {
        assert_eq!(gdel(folder, arguments).status.code(), Some(2), "{arguments:?}");
    }
    succeeds(folder, &["triangulate", "--tiles", "mesh", "good.xyz"]);
    assert_eq!(gdel(folder, &["verify", "good.xyz", "mesh"]).status.code(), Some(2));
}
