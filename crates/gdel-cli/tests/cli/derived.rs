//! What is derived from a triangulation: `locate`, `interpolate`, `contour`, `voronoi`, `alpha`, `surface`, `tree`.

use crate::{BUNNY, command, fails, fails_with, files, folder, gdel, succeeds};
use std::{
    fs,
    io::{Cursor, Read, Write},
    path::Path,
    process::Stdio,
};

/// A cube with its middle, and values 100 x + 10 y + z.
const CUBE: &str = "x,y,z,value\n0,0,0,0\n1,0,0,100\n0,1,0,10\n1,1,0,110\n0,0,1,1\n1,0,1,101\n0,1,1,11\n1,1,1,111\n\
                    0.5,0.5,0.5,55.5\n";
/// A square with its middle, and values 10 x + y.
const SQUARE: &str = "x,y,value\n0,0,0\n2,0,20\n0,2,2\n2,2,22\n1,1,11\n";

/// The rows of a CSV file, the names first.
fn rows(path: &Path) -> Vec<Vec<String>> {
    fs::read_to_string(path).unwrap().lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The numbers of a column of a CSV file.
#[track_caller]
fn column(path: &Path, name: &str) -> Vec<f64> {
    let rows = rows(path);
    let place = rows[0].iter().position(|other| other == name).unwrap_or_else(|| panic!("{name} in {:?}", rows[0]));
    rows[1..].iter().map(|row| row[place].parse().unwrap()).collect()
}

/// An array of a NumPy archive.
#[track_caller]
pub(crate) fn array<T: npyz::Deserialize>(path: &Path, name: &str) -> Vec<T> {
    let mut archive = zip::ZipArchive::new(fs::File::open(path).unwrap()).unwrap();
    let mut bytes = Vec::new();
    archive.by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut bytes).unwrap();
    npyz::NpyFile::new(Cursor::new(bytes)).unwrap().into_vec().unwrap()
}

/// The object that `--stats json` prints.
#[track_caller]
fn stats(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&succeeds(folder, &[arguments, &["--stats", "json"]].concat())).expect("one JSON object")
}

/// A folder with points, values and queries.
fn samples() -> tempfile::TempDir {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("cube.csv"), CUBE).unwrap();
    fs::write(path.join("square.csv"), SQUARE).unwrap();
    fs::write(path.join("q.xyz"), "0.5 0.25 0.125\n0.9 0.95 0.9\n3 0.5 0.5\n").unwrap();
    fs::write(path.join("q2.xyz"), "1 0.5\n1.75 1.5\n-1 1\n").unwrap();
    folder
}

#[test]
fn contour() {
    let folder = samples();
    let path = folder.path();
    let lines = ["contour", "square.csv", "--dim", "2", "--values", "value", "--levels", "5.5,-3,16.5"];
    let run = stats(path, &[&lines[..], &["-o", "lines.geojson"]].concat());
    assert_eq!((run["levels"].as_u64(), run["segments"].as_u64().map(|n| n > 2)), (Some(3), Some(true)));
    let read = || fs::read_to_string(path.join("lines.geojson")).unwrap();
    let collection: serde_json::Value = serde_json::from_str(&read()).unwrap();
    let features = collection["features"].as_array().unwrap();
    assert_eq!(features.len(), 3);
    assert_eq!(features[0]["properties"]["level"], 5.5);
    for feature in features {
        let level = feature["properties"]["level"].as_f64().unwrap();
        for line in feature["geometry"]["coordinates"].as_array().unwrap() {
            for corner in line.as_array().unwrap() {
                let [x, y] = [0, 1].map(|axis| corner[axis].as_f64().unwrap());
                assert!((10.0 * x + y - level).abs() < 1e-12);
            }
        }
    }
    // Its own file is replaced without asking; closed lines return to where they began.
    succeeds(path, &[&lines[..], &["--closed", "-o", "lines.geojson"]].concat());
    let collection: serde_json::Value = serde_json::from_str(&read()).unwrap();
    let below_all = &collection["features"][1]["geometry"]["coordinates"][0];
    assert_eq!((below_all.as_array().unwrap().len(), &below_all[0]), (5, &below_all[4]));

    let surface = ["contour", "cube.csv", "--values", "value", "--levels", "55.5"];
    for file in ["s.ply", "s.stl", "s.vtu", "s.csv"] {
        succeeds(path, &[&surface[..], &["-o", file]].concat());
    }
    let [x, y, z] = ["x", "y", "z"].map(|axis| column(&path.join("s.csv"), axis));
    assert!(x.len() >= 6 && x.len() % 3 == 0);
    for i in 0..x.len() {
        assert!((100.0 * x[i] + 10.0 * y[i] + z[i] - 55.5).abs() < 1e-12);
    }
    let level = ["contour", "cube.csv", "--values", "value", "--levels", "nan", "-o", "s.ply"];
    for wrong in [&level[..], &[&surface[..], &["-o", "s.geojson"]].concat(), &[&lines[..], &["-o", "s.ply"]].concat()]
    {
        assert_eq!(gdel(path, wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn locate() {
    let folder = samples();
    let path = folder.path();
    let run = stats(path, &["locate", "cube.csv", "q.xyz", "-o", "l.csv"]);
    for (key, value) in [("points", 9), ("dimension", 3), ("queries", 3), ("outside", 1), ("hull_triangles", 12)] {
        assert_eq!(run[key], value, "{run}");
    }
    let rows = rows(&path.join("l.csv"));
    assert_eq!(rows[0], ["simplex", "v0", "v1", "v2", "v3", "nearest"]);
    assert_eq!(column(&path.join("l.csv"), "nearest"), [8.0, 7.0, 1.0]);
    // The simplices are those that `triangulate` writes.
    succeeds(path, &["triangulate", "cube.csv", "-o", "m.ele"]);
    let ele = fs::read_to_string(path.join("m.ele")).unwrap();
    for row in &rows[1..3] {
        let line = ele.lines().nth(1 + row[0].parse::<usize>().unwrap()).unwrap();
        assert_eq!(line.split_whitespace().skip(1).collect::<Vec<_>>(), row[1..5]);
    }
    // Outside: a facet of the hull on the side x = 1, which sees the query.
    assert_eq!((&*rows[3][0], &*rows[3][4]), ("-1", "-1"));
    assert!(rows[3][1..4].iter().all(|v| v.parse::<u32>().unwrap() % 2 == 1), "{:?}", rows[3]);

    succeeds(path, &["locate", "square.csv", "q2.xyz", "--dim", "2", "-o", "l2.npz"]);
    assert_eq!(array::<i64>(&path.join("l2.npz"), "nearest"), [4, 3, 0]);
    assert_eq!(array::<i64>(&path.join("l2.npz"), "simplex")[2], -1);
    let [v0, v1, v2] = ["v0", "v1", "v2"].map(|name| array::<i64>(&path.join("l2.npz"), name)[2]);
    assert_eq!(([v0.min(v1), v0.max(v1)], v2), ([0, 2], -1));
}

#[test]
fn interpolate() {
    let folder = samples();
    let path = folder.path();
    for method in ["linear", "laplace", "sibson"] {
        let arguments = ["interpolate", "cube.csv", "q.xyz", "--values", "value", "--method", method, "-fo", "i.csv"];
        let run = stats(path, &arguments);
        assert_eq!((&run["queries"], &run["outside"]), (&3.into(), &1.into()));
        let values = column(&path.join("i.csv"), "value");
        // A linear function is reproduced.
        assert!((values[0] - 52.625).abs() < 1e-12 && (values[1] - 100.4).abs() < 1e-12, "{method}: {values:?}");
        assert!(values[2].is_nan());
        assert_eq!(rows(&path.join("i.csv"))[0], ["x", "y", "z", "value"]);
        assert_eq!(column(&path.join("i.csv"), "y"), [0.25, 0.95, 0.5]);
        // The column by its number.
        let by_number = ["interpolate", "square.csv", "q2.xyz", "--dim", "2", "--values", "3", "--method", method];
        succeeds(path, &[&by_number[..], &["-fo", "i.npz"]].concat());
        let values = array::<f64>(&path.join("i.npz"), "value");
        assert!((values[0] - 10.5).abs() < 1e-12 && (values[1] - 19.0).abs() < 1e-12, "{method}: {values:?}");
        assert!(values[2].is_nan());
    }
    let bare: String = CUBE.lines().skip(1).map(|line| line.replace(',', " ") + "\n").collect();
    fs::write(path.join("bare.xyz"), bare).unwrap();
    succeeds(path, &["interpolate", "bare.xyz", "q.xyz", "--values", "4", "-fo", "i.csv"]);
    assert_eq!(column(&path.join("i.csv"), "value")[0], 52.625);
}

#[test]
fn voronoi() {
    let folder = samples();
    let path = folder.path();
    for (clip, volumes) in [("box", Some([0.0625, 0.5])), ("hull", Some([0.0625, 0.5])), ("none", None)] {
        let run = stats(path, &["voronoi", "cube.csv", "--clip", clip, "-fo", "v.csv"]);
        assert_eq!(run["cells"], 9);
        let found = column(&path.join("v.csv"), "volume");
        match volumes {
            Some([corner, middle]) => {
                assert!((run["volume"].as_f64().unwrap() - 1.0).abs() < 1e-12, "{run}");
                assert!(found[..8].iter().all(|volume| (volume - corner).abs() < 1e-12), "{found:?}");
                assert!((found[8] - middle).abs() < 1e-12, "{found:?}");
            }
            None => {
                // JSON has no infinity.
                assert!(run["volume"].is_null() && found[..8].iter().all(|volume| volume.is_infinite()), "{run}");
                // An octahedron, whose corners reach out of the cube.
                assert_eq!(found[8], 0.5625);
            }
        }
        let middle = rows(&path.join("v.csv")).pop().unwrap();
        assert_eq!((&*middle[0], &*middle[5], middle.len()), ("8", "0 1 2 3 4 5 6 7", 6), "{clip}");
        let volume = if clip == "none" { 0.5625 } else { 0.5 };
        for (number, expected) in middle[1..5].iter().zip([volume, 0.5, 0.5, 0.5]) {
            assert!((number.parse::<f64>().unwrap() - expected).abs() < 1e-12, "{clip}: {middle:?}");
        }
    }
    // The box is the default.
    succeeds(path, &["voronoi", "square.csv", "--dim", "2", "-o", "v.npz"]);
    assert_eq!(array::<f64>(&path.join("v.npz"), "volumes"), [0.5, 0.5, 0.5, 0.5, 2.0]);
    let cells = array::<i64>(&path.join("v.npz"), "cells");
    let facets = array::<u64>(&path.join("v.npz"), "facets_offsets");
    let neighbors = array::<i64>(&path.join("v.npz"), "facet_neighbors");
    assert_eq!((cells.len(), cells[5] as usize, facets.len()), (6, neighbors.len(), neighbors.len() + 1));
    let mut of_middle = neighbors[cells[4] as usize..cells[5] as usize].to_vec();
    of_middle.sort_unstable();
    assert_eq!(of_middle, [0, 1, 2, 3]);
    for (points, dim, cells, name) in [("cube.csv", "3", 9, "volume"), ("square.csv", "2", 5, "area")] {
        for (clip, cells) in [("box", cells), ("none", 1)] {
            succeeds(path, &["voronoi", points, "--dim", dim, "--clip", clip, "-o", "v.vtu"]);
            let vtu = fs::read(path.join("v.vtu")).unwrap();
            let text = String::from_utf8_lossy(&vtu);
            assert!(text.contains(&format!("NumberOfCells=\"{cells}\"")), "{points} {clip}");
            assert!(text.contains(&format!("Name=\"{name}\"")) && text.contains("Name=\"point\""));
            assert_eq!(text.contains("Name=\"faceoffsets\""), dim == "3");
        }
    }
}

#[test]
fn alpha_of_the_bunny() {
    let folder = folder();
    let path = folder.path();
    let run = stats(path, &["alpha", BUNNY, "-o", "a.obj"]);
    assert_eq!(run["components"], 1);
    let solid = run["solid"].as_u64().unwrap();
    let radius = run["alpha"].as_f64().unwrap();
    // A closed surface: every edge in both directions equally often.
    let obj = fs::read_to_string(path.join("a.obj")).unwrap();
    let mut edges = std::collections::HashMap::<[u32; 2], i32>::new();
    let mut triangles = 0;
    for face in obj.lines().filter_map(|line| line.strip_prefix("f ")) {
        let corners: Vec<u32> = face.split(' ').map(|v| v.split('/').next().unwrap().parse().unwrap()).collect();
        triangles += 1;
        for k in 0..3 {
            let [a, b] = [corners[k], corners[(k + 1) % 3]];
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|&sum| sum == 0));
    assert_eq!(run["surface"], triangles);
    // The same radius by its value, and the smallest: a little less has another solid.
    let same = stats(path, &["alpha", BUNNY, "--alpha", &radius.to_string(), "-o", "s.vtu"]);
    assert_eq!((&same["solid"], &same["surface"]), (&run["solid"], &run["surface"]));
    let less = stats(path, &["alpha", BUNNY, "--alpha", &(radius * (1.0 - 1e-9)).to_string(), "-o", "s.vtu"]);
    assert!(less["solid"].as_u64().unwrap() < solid);
}

#[test]
fn surface_of_the_bunny() {
    let folder = folder();
    let path = folder.path();
    let run = stats(path, &["surface", BUNNY, "--smooth", "0", "--keep-isolated", "-o", "s.obj"]);
    for (key, value) in [("components", 1), ("genus", 0), ("vertices", 35_933), ("surface_triangles", 71_862)] {
        assert_eq!(run[key], value, "{run}");
    }
    assert_eq!((&run["closed"], &run["on_surface"]), (&true.into(), &35_933.into()), "{run}");
    let sum: u64 = ["on_surface", "inside", "outside"].iter().map(|key| run[key].as_u64().unwrap()).sum();
    assert_eq!(run["points"], sum);
    assert!((run["volume"].as_f64().unwrap() / 0.000755 - 1.0).abs() < 0.001, "{run}");
    // The files are the same for any number of threads.
    let surface = |threads: &str, name: &str| {
        let arguments = ["surface", BUNNY, "--backend", "cpu", "-fo", name];
        let run = command(path, &arguments).env("RAYON_NUM_THREADS", threads).output().unwrap();
        assert!(run.status.success());
        fs::read(path.join(name)).unwrap()
    };
    for name in ["s.stl", "s.ply", "s.glb", "s.3mf"] {
        assert!(surface("1", name) == surface("3", name), "{name}");
    }
}

#[test]
fn surfaces_of_scans_from_one_side() {
    let folder = folder();
    let path = folder.path();
    let hills: String = (0..2500)
        .map(|i| [f64::from(i % 50) + 0.3 * (0.7 * f64::from(i)).sin(), f64::from(i / 50)])
        .map(|[x, y]| format!("{x} {y} {}\n", 3.0 * (x / 6.0).sin() * (y / 7.0).cos()))
        .collect();
    fs::write(path.join("hills.xyz"), hills).unwrap();
    // The side is a guess, and the user is told how to say it.
    let run = gdel(path, &["surface", "hills.xyz", "-o", "s.stl"]);
    let (stdout, stderr) = (String::from_utf8(run.stdout).unwrap(), String::from_utf8(run.stderr).unwrap());
    assert!(run.status.success() && stdout.contains("side by         guess"), "{stdout}");
    assert!(stderr.starts_with("gdel: hills.xyz: ") && stderr.contains("`--below`"), "{stderr}");
    assert_eq!(stderr.lines().count(), 1);
    for (arguments, side, is_closed) in [
        (&["--below"][..], "below", true),
        (&["--airborne", "--open", "auto"], "below", false),
        (&["--sensor", "-5,20,300", "--open", "auto"], "sensors", false),
    ] {
        let run = stats(path, &[&["surface", "hills.xyz", "-fo", "s.stl"], arguments].concat());
        assert_eq!((&run["side_by"], &run["closed"]), (&side.into(), &is_closed.into()), "{run}");
        assert_eq!(run["boundaries"] == 0, is_closed, "{run}");
    }
    for position in ["1", "1,2,x", "1,2,inf", "1,2,3,4"] {
        let run = gdel(path, &["surface", "hills.xyz", "--sensor", position, "-fo", "s.stl"]);
        assert_eq!(run.status.code(), Some(2), "{position}");
    }
    let run = gdel(path, &["surface", "hills.xyz", "--sensor", "1,2", "-fo", "s.stl"]);
    assert_eq!(run.status.code(), Some(2));
}

#[test]
fn surfaces_are_refined_and_decimated() {
    let folder = folder();
    let path = folder.path();
    succeeds(path, &["generate", "sphere", "2000", "-o", "s.csv"]);
    let run = stats(path, &["surface", "s.csv", "--refine", "-o", "fine.ply"]);
    assert_eq!((&run["surface_triangles"], &run["closed"], &run["genus"]), (&15_984.into(), &true.into(), &0.into()));
    let exact = 4.0 / 3.0 * std::f64::consts::PI;
    assert!((run["volume"].as_f64().unwrap() / exact - 1.0).abs() < 0.002, "{run}");
    for options in [&["--refine"][..], &[]] {
        let arguments = [&["surface", BUNNY, "--triangles", "5000", "-fo", "few.obj"], options].concat();
        let run = stats(path, &arguments);
        assert!((4500..=5500).contains(&run["decimated"].as_u64().unwrap()), "{run}");
        assert!(run["intersecting"].as_u64().unwrap() < 20, "{run}");
        let file = fs::read_to_string(path.join("few.obj")).unwrap();
        let mut edges: Vec<[u32; 2]> = Vec::new();
        for line in file.lines().filter_map(|line| line.strip_prefix("f ")) {
            let corners: Vec<u32> = line.split(' ').map(|word| word.parse().unwrap()).collect();
            edges.extend((0..3).map(|k| [corners[k], corners[(k + 1) % 3]]));
        }
        let mut reversed: Vec<_> = edges.iter().map(|&[a, b]| [b, a]).collect();
        edges.sort_unstable();
        reversed.sort_unstable();
        assert!(edges == reversed && edges.windows(2).all(|pair| pair[0] < pair[1]));
    }
    for wrong in [&["--triangles", "0"][..], &["--triangles", "9", "--dim", "2"]] {
        let run = gdel(path, &[&["surface", "s.csv", "-fo", "s.ply"], wrong].concat());
        assert_eq!(run.status.code(), Some(2), "{wrong:?}");
    }
    assert_eq!(gdel(path, &["surface", "s.csv", "--triangles", "9", "-o", "s.vtu"]).status.code(), Some(2));
}

#[test]
fn surface_in_all_formats_and_dimensions() {
    let folder = samples();
    let path = folder.path();
    succeeds(path, &["generate", "sphere", "300", "-o", "3.csv"]);
    let circle: String =
        (0..40).map(|i| 0.157 * f64::from(7 * i % 40)).map(|t| format!("{},{}\n", t.cos(), t.sin())).collect();
    fs::write(path.join("2.csv"), circle).unwrap();
    for (points, dim, (count, expected), (size, least)) in [
        ("3.csv", "3", ("surface_triangles", 596), ("volume", 4.0)),
        ("2.csv", "2", ("curve_edges", 40), ("area", 3.1)),
    ] {
        for name in ["s.ply", "s.obj", "s.stl", "s.glb", "s.3mf", "s.vtu"] {
            let run = stats(path, &["surface", points, "--dim", dim, "-fo", name]);
            assert_eq!((&run[count], &run["closed"]), (&expected.into(), &true.into()), "{run}");
            assert!(run[size].as_f64().unwrap() > least, "{run}");
            assert!(fs::metadata(path.join(name)).unwrap().len() > 100, "{name}");
        }
    }
    // Without a solid, the surface is empty.
    fs::write(path.join("flat.xyz"), "0 0 0\n1 0 0\n0 1 0\n").unwrap();
    let run = stats(path, &["surface", "flat.xyz", "-o", "e.stl"]);
    assert_eq!((&run["surface_triangles"], &run["closed"]), (&0.into(), &true.into()), "{run}");
    fails(path, &["surface", "cube.csv", "--min-part", "2", "-fo", "e.stl"], "min_part must be a number from 0 to 1");
    assert_eq!(gdel(path, &["surface", "cube.csv", "-o", "s.las"]).status.code(), Some(2));
}

#[test]
fn alpha_chooses_the_radii_that_the_page_chooses() {
    let folder = folder();
    let path = folder.path();
    let pinned = include_str!("../../../../tests/data/alphas.txt");
    let mut found = String::new();
    for line in pinned.lines() {
        if let [dim, kind, count, seed, _] = line.split(' ').collect::<Vec<_>>()[..] {
            succeeds(path, &["generate", kind, count, "--dim", dim, "--seed", seed, "-fo", "p.f64"]);
            // As it is printed: `serde_json` may round numbers that it reads otherwise.
            let run = succeeds(path, &["alpha", "p.f64", "--dim", dim, "-fo", "a.vtu", "--stats", "json"]);
            let alpha = run.split("\"alpha\":").nth(1).and_then(|rest| rest.split(',').next()).unwrap();
            found += &format!("{dim} {kind} {count} {seed} {alpha}\n");
        } else {
            found += &format!("{line}\n");
        }
    }
    assert_eq!(found, pinned, "found:\n{found}");
}

/// Returns the number of cells of a grid.
fn cells(vtu: &Path) -> usize {
    let bytes = fs::read(vtu).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let count = text.split("NumberOfCells=\"").nth(1).and_then(|rest| rest.split('"').next());
    count.and_then(|count| count.parse().ok()).expect("a count of cells")
}

#[test]
fn alpha_in_all_formats_and_dimensions() {
    let folder = samples();
    let path = folder.path();
    for dim in ["2", "3"] {
        let points = if dim == "2" { "square.csv" } else { "cube.csv" };
        for name in ["a.ply", "a.obj", "a.stl", "a.glb", "a.3mf", "a.vtu"] {
            let run = stats(path, &["alpha", points, "--dim", dim, "-o", name]);
            let expected = if dim == "2" { (1.0, 4, 4) } else { (0.75, 12, 12) };
            let counts = (run["alpha"].as_f64().unwrap(), run["solid"].as_u64(), run["surface"].as_u64());
            assert_eq!((counts.1, counts.2), (Some(expected.1), Some(expected.2)), "{run}");
            assert!((counts.0 - expected.0).abs() < 1e-12, "{run}");
            assert!(fs::metadata(path.join(name)).unwrap().len() > 100, "{name}");
        }
    }
    // Two triangles with a common edge, an edge, and a vertex; a facet is added by a point above it.
    fs::write(path.join("parts.xyz"), "0 0\n1 0\n0 1\n1 1\n5 0\n6 0\n9 5\n").unwrap();
    let run = stats(path, &["alpha", "parts.xyz", "--dim", "2", "--alpha", "1", "--singular", "-fo", "a.vtu"]);
    assert_eq!((&run["solid"], &run["singular_edges"]), (&2.into(), &1.into()), "{run}");
    assert_eq!((&run["singular_vertices"], &run["singular_triangles"]), (&1.into(), &serde_json::Value::Null));
    assert_eq!(cells(&path.join("a.vtu")), 4);
    fs::write(path.join("parts.xyz"), "0 0 0\n1 0 0\n0 1 0\n0 0 1\n5 0 0\n6 0 0\n5 1 0\n9 9 0\n9 9 1\n0 9 9\n")
        .unwrap();
    let run = stats(path, &["alpha", "parts.xyz", "--alpha", "1", "--singular", "-fo", "a.vtu"]);
    assert_eq!((&run["solid"], &run["singular_triangles"]), (&1.into(), &1.into()), "{run}");
    assert_eq!((&run["singular_edges"], &run["singular_vertices"]), (&1.into(), &1.into()));
    assert_eq!(cells(&path.join("a.vtu")), 4);
    // Two pairs of triangles far from each other.
    fs::write(path.join("two.xyz"), "0 0\n1 0\n0 1\n1 1\n9 0\n10 0\n9 1\n10 1\n").unwrap();
    let arguments = ["alpha", "two.xyz", "--dim", "2", "-o", "a.ply"];
    let [one, two] = ["1", "2"].map(|n| stats(path, &[&arguments[..], &["--components", n]].concat()));
    assert_eq!((&one["components"], &two["components"]), (&1.into(), &2.into()));
    assert!(two["alpha"].as_f64() < one["alpha"].as_f64());
    // No more than the points.
    assert_eq!(stats(path, &[&arguments[..], &["--alpha", "0"]].concat())["solid"], 0);
    assert_eq!(stats(path, &[&arguments[..], &["--alpha", "inf"]].concat())["components"], 1);
}

#[test]
fn tree() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("p.xyz"), "0 0 0\n1 0 0\n0 2 0\n0 0 4\n").unwrap();
    let run = stats(path, &["tree", "p.xyz", "-o", "t.csv"]);
    assert_eq!((&run["edges"], &run["total_length"]), (&3.into(), &7.0.into()));
    assert_eq!(fs::read_to_string(path.join("t.csv")).unwrap(), "v0,v1,length\n0,1,1.0\n0,2,2.0\n0,3,4.0\n");
    succeeds(path, &["tree", "p.xyz", "--dim", "3", "-o", "t.npz"]);
    assert_eq!(array::<f64>(&path.join("t.npz"), "length"), [1.0, 2.0, 4.0]);
    assert_eq!(array::<i64>(&path.join("t.npz"), "v1"), [1, 2, 3]);
    succeeds(path, &["tree", "p.xyz", "-o", "t.vtu"]);
    assert!(String::from_utf8_lossy(&fs::read(path.join("t.vtu")).unwrap()).contains("NumberOfCells=\"3\""));
    // In 2D two of the points coincide.
    let flat = gdel(path, &["tree", "p.xyz", "--dim", "2", "--stats", "json", "-fo", "t.csv"]);
    assert_eq!(String::from_utf8_lossy(&flat.stderr), "gdel: p.xyz: the z coordinates are dropped\n");
    assert_eq!(fs::read_to_string(path.join("t.csv")).unwrap(), "v0,v1,length\n0,3,0.0\n0,1,1.0\n0,2,2.0\n");
}

const COMMANDS: [&[&str]; 5] = [
    &["locate", "p.csv", "q.xyz", "-o", "o.npz"],
    &["interpolate", "p.csv", "q.xyz", "--values", "value", "-o", "o.npz"],
    &["voronoi", "p.csv", "-o", "o.npz"],
    &["alpha", "p.csv", "-o", "o.vtu"],
    &["tree", "p.csv", "-o", "o.npz"],
];

#[test]
fn summaries_statistics_and_repetitions() {
    let folder = samples();
    let path = folder.path();
    fs::write(path.join("p.csv"), CUBE).unwrap();
    for arguments in COMMANDS {
        let name = arguments[0];
        let summary = succeeds(path, arguments);
        assert!(summary.starts_with("points          9\ntetrahedra      12\n"), "{summary}");
        let times = summary.lines().last().unwrap();
        assert!(times.starts_with("seconds         total ") && times.contains(&format!(", {name} ")), "{summary}");
        let lines = succeeds(path, &[arguments, &["--stats", "json", "--repeat", "3", "--backend", "cpu"]].concat());
        assert_eq!(lines.lines().count(), 3);
        for line in lines.lines() {
            let run: serde_json::Value = serde_json::from_str(line).unwrap();
            assert_eq!((&run["backend"], run.get("fallback")), (&"cpu".into(), None));
            let seconds = |key: &str| run["seconds"][key].as_f64().unwrap();
            assert!((seconds("total") - seconds("triangulate") - seconds(name)).abs() < 1e-9, "{run}");
        }
    }
}

#[test]
fn flat_points_have_answers_in_their_own_dimension() {
    let folder = samples();
    let path = folder.path();
    // Four coplanar points, three on a line, equal ones, none.
    let flat = [
        ("0,0,0,1\n1,0,0,2\n0,1,0,3\n1,1,0,4\n", 3, 4, 1.0, "coplanar"),
        ("0,0,0,1\n1,1,1,2\n2,2,2,3\n", 2, 3, 8.0, "collinear"),
        ("0,0,0,1\n0,0,0,2\n", 1, 0, 0.0, "equal"),
        ("", 0, 0, 0.0, "no points"),
    ];
    for (points, edges, cells, volume, note) in flat {
        fs::write(path.join("p.csv"), format!("x,y,z,value\n{points}")).unwrap();
        for arguments in COMMANDS {
            let run = stats(path, arguments);
            assert_eq!(run["tetrahedra"], 0, "{run}");
            let expected = [("edges", edges), ("cells", cells)];
            assert!(expected.iter().all(|&(key, count)| run.get(key).is_none_or(|found| found == count)), "{run}");
            assert!(run.get("volume").is_none_or(|sum| (sum.as_f64().unwrap() - volume).abs() < 1e-12), "{run}");
            let summary = succeeds(path, &[arguments, &["--force"]].concat());
            assert!(
                summary.contains(&format!("{note}, so there are no tetrahedra")) || summary.contains("are no points"),
                "{summary}"
            );
        }
        succeeds(path, &["voronoi", "p.csv", "-fo", "v.vtu"]);
        succeeds(path, &["interpolate", "p.csv", "p.csv", "--values", "value", "-fo", "i.csv"]);
        let found: Vec<String> = rows(&path.join("i.csv"))[1..].iter().map(|row| row[3].clone()).collect();
        let given: Vec<f64> = points.lines().map(|line| line[6..].parse().unwrap()).collect();
        // Equal points have the value of the first.
        let given = if note == "equal" { vec![1.0; given.len()] } else { given };
        assert_eq!(found.iter().map(|value| value.parse::<f64>().unwrap()).collect::<Vec<_>>(), given);
    }
    fs::write(path.join("p.csv"), "x,y,z,value\n0,0,0,1\n1,0,0,2\n0,1,0,3\n1,1,0,4\n").unwrap();
    fs::write(path.join("beside.xyz"), "0.1 0.2 0.3\n").unwrap();
    succeeds(path, &["locate", "p.csv", "beside.xyz", "-fo", "l.csv"]);
    assert_eq!(rows(&path.join("l.csv"))[1], ["-1", "-1", "-1", "-1", "-1", "0"]);
    // What asked `d3-voronoi` for cells of collinear points.
    fs::write(path.join("line.xyz"), "100 100\n200 200\n300 300\n").unwrap();
    let run = stats(path, &["voronoi", "line.xyz", "--dim", "2", "-fo", "v.csv"]);
    assert_eq!((&run["cells"], &run["area"]), (&3.into(), &40_000.0.into()));
    fs::write(path.join("empty.xyz"), "").unwrap();
    fs::write(path.join("p.csv"), CUBE).unwrap();
    for command in ["locate", "interpolate"] {
        let values = if command == "interpolate" { &["--values", "value"][..] } else { &[] };
        succeeds(path, &[&[command, "p.csv", "empty.xyz", "-fo", "o.csv"], values].concat());
        assert_eq!(rows(&path.join("o.csv")).len(), 1);
    }
}

/// The shortest digits that read back, without hundreds of zeros.
#[test]
fn tiny_and_huge_numbers_have_exponents() {
    let folder = samples();
    let path = folder.path();
    for scale in ["e-170", "e140", "e-23", "e300"] {
        fs::write(path.join("p.xyz"), format!("0 0\n3{scale} 0\n0 4{scale}\n")).unwrap();
        let total: f64 = [3, 4].iter().map(|length| format!("{length}{scale}").parse::<f64>().unwrap()).sum();
        let arguments = ["tree", "p.xyz", "--dim", "2", "-fo", "t.csv"];
        let summary = succeeds(path, &arguments);
        assert!(summary.contains(&format!("total length    {total:e}\n")), "{summary}");
        let csv = fs::read_to_string(path.join("t.csv")).unwrap();
        assert_eq!(csv, format!("v0,v1,length\n0,1,3{scale}\n0,2,4{scale}\n"));
        // The reader of JSON rounds the last bit its own way.
        let read = stats(path, &arguments)["total_length"].as_f64().unwrap();
        assert!((read / total - 1.0).abs() < 1e-15, "{read:e}");
    }
}

/// Two axes of different units: a function of the one that changes slowly along the other.
#[test]
fn rescaled_axes_have_the_same_weight() {
    let folder = samples();
    let path = folder.path();
    // The fractional parts of multiples of irrational numbers: 400 stations in space and time.
    let station = |i: u32| [f64::from(i) * 0.754_877_666 % 1.0, f64::from(i) * 0.569_840_290_998 % 1.0];
    let value = |[x, t]: [f64; 2]| (6.0 * x).sin() * (6.0 * t).cos();
    let row = |[x, t]: [f64; 2]| format!("{},{},{}\n", x * 1000.0, t, value([x, t]));
    fs::write(path.join("p.csv"), format!("x,y,v\n{}", (0..400).map(|i| row(station(i))).collect::<String>())).unwrap();
    let queries = (400..600).map(station).map(|p| p.map(|x| 0.1 + 0.8 * x));
    let lines: String = queries.clone().map(|[x, t]| format!("{} {t}\n", x * 1000.0)).collect();
    fs::write(path.join("q.xyz"), lines).unwrap();
    let error = |more: &[&str]| {
        let arguments = ["interpolate", "p.csv", "q.xyz", "--dim", "2", "--values", "v", "-fo", "o.csv"];
        succeeds(path, &[&arguments[..], more].concat());
        let found = column(&path.join("o.csv"), "value");
        let squares = queries.clone().zip(&found).map(|(q, v)| (value(q) - v) * (value(q) - v));
        assert!((column(&path.join("o.csv"), "x")[0] - queries.clone().next().unwrap()[0] * 1000.0).abs() < 1e-9);
        (squares.sum::<f64>() / found.len() as f64).sqrt()
    };
    let (as_is, scaled, by_factors) = (error(&[]), error(&["--rescale"]), error(&["--rescale=0.001,1"]));
    assert!(as_is > 0.3 && scaled < 0.04 && by_factors < 0.04, "{as_is} {scaled} {by_factors}");
    succeeds(path, &["triangulate", "p.csv", "--dim", "2", "--rescale", "--verify", "-o", "m.npz"]);
    let wrong = gdel(path, &["triangulate", "p.csv", "--dim", "2", "--rescale=1,2,3"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("2 factors"));
}

/// The three stations and the query on the border that had no value, and what is to be chosen.
#[test]
fn values_on_the_border_outside_and_of_duplicates() {
    let folder = samples();
    let path = folder.path();
    fs::write(path.join("p.csv"), "x,y,v\n0,0,1\n0.3,0.1,1\n0,1,1\n").unwrap();
    fs::write(path.join("q.xyz"), "0.03 0.01\n0 -1\n").unwrap();
    let value = |more: &[&str]| {
        let arguments = ["interpolate", "p.csv", "q.xyz", "--dim", "2", "--values", "v", "-fo", "o.csv"];
        let run = stats(path, &[&arguments[..], more].concat());
        let values: Vec<String> = rows(&path.join("o.csv"))[1..].iter().map(|row| row[2].clone()).collect();
        (run["outside"].as_u64().unwrap(), values.join(" "))
    };
    assert_eq!(value(&[]), (1, "1.0 nan".into()));
    assert_eq!(value(&["--exact"]), (2, "nan nan".into()));
    assert_eq!(value(&["--outside", "-3", "--method", "sibson"]), (1, "1.0 -3.0".into()));
    assert_eq!(value(&["--outside", "nearest"]), (1, "1.0 1.0".into()));
    assert_eq!(value(&["--outside", "linear"]), (1, "1.0 1.0".into()));
    fs::write(path.join("p.csv"), "x,y,v\n0,0,1\n1,0,1\n0,1,1\n0,0,9\n").unwrap();
    fs::write(path.join("q.xyz"), "0 0\n").unwrap();
    assert_eq!(value(&[]).1, "1.0");
    assert_eq!(value(&["--duplicates", "mean"]).1, "5.0");
    let arguments = ["interpolate", "p.csv", "q.xyz", "--dim", "2", "--values", "v", "-fo", "o.csv"];
    fails(
        path,
        &[&arguments[..], &["--duplicates", "error"]].concat(),
        "points 0 and 3 are equal, but their values differ",
    );
    let summary = succeeds(path, &arguments);
    assert!(summary.starts_with("points          4 (1 duplicates)\n"), "{summary}");
}

/// From stations to a raster.
#[test]
fn values_on_a_grid() {
    let folder = samples();
    let path = folder.path();
    let arguments = ["interpolate", "square.csv", "--dim", "2", "--values", "value", "--grid", "4x2"];
    let run = stats(path, &[&arguments[..], &["-fo", "g.csv"]].concat());
    assert_eq!((&run["queries"], &run["outside"]), (&8.into(), &0.into()));
    // The first row is the upper one.
    assert_eq!(column(&path.join("g.csv"), "y"), [1.5, 1.5, 1.5, 1.5, 0.5, 0.5, 0.5, 0.5]);
    let expected = [4.0, 9.0, 14.0, 19.0, 3.0, 8.0, 13.0, 18.0];
    for method in ["linear", "sibson", "sibson-c1", "clough-tocher"] {
        succeeds(path, &[&arguments[..], &["--method", method, "-fo", "g.npy"]].concat());
        let file = npyz::NpyFile::new(fs::File::open(path.join("g.npy")).unwrap()).unwrap();
        assert_eq!(file.shape(), [2, 4]);
        let values: Vec<f64> = file.into_vec().unwrap();
        assert!(values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{method}: {values:?}");
    }
    let bounds = [&arguments[..], &["--bounds", "-1,0,3,2", "--outside", "-9", "-fo", "g.csv"]].concat();
    assert_eq!(stats(path, &bounds)["outside"], 4);
    assert_eq!(column(&path.join("g.csv"), "value"), [-9.0, 6.5, 16.5, -9.0, -9.0, 5.5, 15.5, -9.0]);
    succeeds(path, &[&arguments[..], &["--rescale", "-fo", "g.tif"]].concat());
    assert!(fs::read(path.join("g.tif")).unwrap().starts_with(b"II*\0"));
    let solid = ["interpolate", "cube.csv", "--values", "value", "--grid", "2x3x4"];
    succeeds(path, &[&solid[..], &["-fo", "g.npy"]].concat());
    let file = npyz::NpyFile::new(fs::File::open(path.join("g.npy")).unwrap()).unwrap();
    assert_eq!(file.shape(), [4, 3, 2]);
    for (more, error) in [
        (&["--grid", "4x", "-fo", "g.npy"][..], "numbers with `x` between them"),
        (&["--grid", "4x0", "-fo", "g.npy"], "numbers with `x` between them"),
        (&["--grid", "4x4x4", "-fo", "g.npy"], "--grid needs 2 numbers, not 3"),
        (&["--grid", "4x4", "--bounds", "0,1", "-fo", "g.npy"], "--bounds needs 4 numbers, not 2"),
        (&["--grid", "4x4", "--bounds", "0,1,0,2", "-fo", "g.npy"], "box"),
        (&["--grid", "9999999x9999999", "-fo", "g.npy"], "the number of cells of a grid must be below 2³²"),
        (&["-fo", "g.npy"], "<QUERIES>"),
        (&["q2.xyz", "-fo", "g.tif"], "rasters need `--grid`"),
        (&["q2.xyz", "--grid", "4x4", "-fo", "g.npy"], "--grid"),
    ] {
        let run = gdel(path, &[&arguments[..6], more].concat());
        let stderr = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.code() == Some(2) && stderr.contains(error), "{more:?}: {stderr}");
    }
    assert_eq!(gdel(path, &[&solid[..], &["-fo", "g.tif"]].concat()).status.code(), Some(2));
    fails(
        path,
        &["interpolate", "cube.csv", "q.xyz", "--values", "value", "--method", "clough-tocher", "-fo", "g.csv"],
        "3D",
    );
}

#[test]
fn bad_points_queries_and_values() {
    let folder = samples();
    let path = folder.path();
    fs::write(path.join("nan.xyz"), "0 0 0\n1 nan 0\n").unwrap();
    // Text is checked by its reader, raw numbers where they are used.
    let numbers = [0.0, 0.0, 0.0, 1.0, f64::NAN, 0.0].map(f64::to_le_bytes);
    fs::write(path.join("nan.f64"), numbers.as_flattened()).unwrap();
    fs::write(path.join("short.csv"), "x,y,z,value\n0,0,0,1\n1,0,0\n").unwrap();
    fs::write(path.join("word.csv"), "x,y,z,value\n0,0,0,one\n").unwrap();
    fs::write(path.join("flat.xyz"), "1 2\n3 4\n").unwrap();
    fs::write(path.join("p.csv"), CUBE).unwrap();
    let to = ["-o", "o.npz"];
    let cases: [(&[&str], &str); 10] = [
        (&["locate", "cube.csv", "nan.xyz"], "nan.xyz: line 2: `nan` is not a finite number"),
        (&["locate", "cube.csv", "nan.f64"], "nan.f64: point 1: the y coordinate is NaN"),
        (&["locate", "nan.f64", "q.xyz"], "nan.f64: point 1: the y coordinate is NaN"),
        (&["tree", "nan.f64"], "nan.f64: point 1: the y coordinate is NaN"),
        (&["locate", "cube.csv", "flat.xyz"], "flat.xyz: line 1: "),
        (&["locate", "cube.csv", "none.xyz"], "none.xyz: cannot be read"),
        (&["interpolate", "cube.csv", "nan.f64", "--values", "value"], "nan.f64: point 1"),
        (&["interpolate", "cube.csv", "q.xyz", "--values", "heat"], "cube.csv: line 2: there is no column `heat`"),
        (&["interpolate", "word.csv", "q.xyz", "--values", "value"], "word.csv: line 2: `one` is not a number"),
        (&["interpolate", "nan.f64", "q.xyz", "--values", "1"], "values are read from text, CSV, PLY, .node, .npz and"),
    ];
    for (arguments, message) in cases {
        fails(path, &[arguments, &to].concat(), message);
    }
    fails(path, &["interpolate", "short.csv", "q.xyz", "--values", "value", "-o", "o.npz"], "short.csv: line 3: ");
    fails(path, &["locate", "cube.csv", "q.xyz", "-o", "none/o.csv"], "none/o.csv: cannot be written");
    assert!(!path.join("o.npz").exists());
}

#[test]
fn wrong_usage() {
    let folder = samples();
    let path = folder.path();
    for (arguments, message) in [
        (&["locate", "cube.csv", "-o", "o.csv"][..], "required"),
        (&["locate", "cube.csv", "q.xyz"], "required"),
        (&["locate", "cube.csv", "q.xyz", "-o", "o.vtu"], "o.vtu: unknown extension, tables end in .csv, .npz"),
        (&["locate", "cube.csv", "-", "-o", "o.csv"], "--queries-format"),
        (&["locate", "-", "q.xyz", "-o", "o.csv"], "--format"),
        (&["locate", "-", "-", "--format", "xyz", "--queries-format", "xyz", "-o", "o.csv"], "only one"),
        (&["interpolate", "cube.csv", "q.xyz", "-o", "o.csv"], "--values"),
        (&["interpolate", "cube.csv", "q.xyz", "--values", "value", "--method", "cubic", "-o", "o.csv"], "sibson"),
        (&["voronoi", "cube.csv", "--clip", "sphere", "-o", "o.csv"], "hull"),
        (&["voronoi", "cube.csv", "-o", "o.ply"], "o.ply: unknown extension, Voronoi cells end in .vtu, .csv, .npz"),
        (&["alpha", "cube.csv", "--alpha=-1", "-o", "o.ply"], "not negative"),
        (&["alpha", "cube.csv", "--alpha", "-1", "-o", "o.ply"], "not negative"),
        (&["alpha", "cube.csv", "--alpha", "nan", "-o", "o.ply"], "not negative"),
        (&["alpha", "cube.csv", "--components", "0", "-o", "o.ply"], "--components"),
        (&["alpha", "cube.csv", "--alpha", "1", "--components", "2", "-o", "o.ply"], "--components needs --alpha auto"),
        (
            &["alpha", "cube.csv", "--radii", "1", "--alpha", "auto", "-o", "o.ply"],
            "with weights, --alpha has to be a number",
        ),
        (&["alpha", "cube.csv", "--radii", "1", "--components", "2", "-o", "o.ply"], "--components needs --alpha auto"),
        (&["alpha", "cube.csv", "--singular", "-o", "o.ply"], "--singular needs an output that ends in .vtu"),
        (&["alpha", "cube.csv", "-o", "o.csv"], "o.csv: unknown extension, alpha shapes end in .ply"),
        (&["tree", "cube.csv", "-o", "o.ply"], "o.ply: unknown extension, spanning trees end in .csv, .npz, .vtu"),
        (&["tree", "cube.csv", "--dim", "4", "-o", "o.csv"], "--dim"),
        (
            &["interpolate", "cube.csv", "q.xyz", "--values", "value", "--outside", "far", "-o", "o.csv"],
            "a number is needed",
        ),
    ] {
        let output = gdel(path, arguments);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(stderr.contains(message), "{arguments:?}: {stderr}");
    }
    assert_eq!(files(path), ["cube.csv", "q.xyz", "q2.xyz", "square.csv"]);
}

#[test]
fn queries_from_standard_input() {
    let folder = samples();
    let path = folder.path();
    for arguments in [
        &["locate", "cube.csv", "-", "--queries-format", "xyz", "-o", "o.npz"][..],
        &["locate", "-", "cube.csv", "--format", "xyz", "-o", "o.npz"],
    ] {
        let mut child = command(path, arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child.stdin.take().unwrap().write_all(b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n").unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    assert_eq!(array::<i64>(&path.join("o.npz"), "nearest").len(), 9);
}

/// The input is never overwritten, other files only by force or if gdel marked them, and a failure
/// leaves the old file.
#[test]
fn outputs_are_replaced_with_care() {
    let folder = samples();
    let path = folder.path();
    fs::write(path.join("p.csv"), CUBE).unwrap();
    let message = "this is the input q.csv: choose another name for the output";
    fs::write(path.join("q.csv"), "x,y,z\n0,0,0\n").unwrap();
    fails(path, &["locate", "p.csv", "q.csv", "-fo", "q.csv"], message);
    fails(path, &["tree", "p.csv", "-fo", "p.csv"], "this is the input p.csv");
    for arguments in COMMANDS {
        let output = arguments.last().unwrap();
        fs::write(path.join(output), "precious").unwrap();
        fails(path, arguments, &format!("{output}: this file exists, and is not marked as an output of gdel"));
        assert_eq!(fs::read_to_string(path.join(output)).unwrap(), "precious");
        succeeds(path, &[arguments, &["--force"]].concat());
        succeeds(path, arguments);
    }
    // Nothing marks a CSV file.
    succeeds(path, &["tree", "p.csv", "-o", "t.csv"]);
    fails(path, &["tree", "p.csv", "-o", "t.csv"], "t.csv: this file exists");
    succeeds(path, &["tree", "p.csv", "-fo", "t.csv"]);
}

/// A limit on file sizes stands for the full disk: the system fails writes in the same way.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_old_files() {
    for (command, name) in
        [("locate p.f64 p.f64", "o.csv"), ("voronoi p.f64", "o.vtu"), ("alpha p.f64", "o.ply"), ("tree p.f64", "o.npz")]
    {
        let folder = folder();
        let path = folder.path();
        succeeds(path, &["generate", "uniform", "5000", "-o", "p.f64"]);
        fs::write(path.join(name), "the old file").unwrap();
        let script =
            format!("ulimit -f 8; trap '' XFSZ; exec '{}' {command} --force -o {name}", env!("CARGO_BIN_EXE_gdel"));
        let output = std::process::Command::new("sh").args(["-c", &script]).current_dir(path).output().unwrap();
        fails_with(output, &format!("{name}: cannot be written: File too large"));
        assert_eq!(files(path), [name, "p.f64"]);
        assert_eq!(fs::read(path.join(name)).unwrap(), b"the old file");
    }
}

/// Longitudes and latitudes: cells that cover the sphere, places in triangles, values between stations.
#[test]
fn places_on_a_sphere_have_answers() {
    let folder = samples();
    let path = folder.path();
    let octahedron = "lon,lat,value\n0,0,1\n90,0,2\n180,0,3\n-90,0,4\n0,90,5\n0,-90,6\n";
    fs::write(path.join("p.csv"), octahedron).unwrap();
    fs::write(path.join("q.xyz"), "80 10\n0 60\n-90 0\n").unwrap();
    let run = stats(path, &["voronoi", "p.csv", "--sphere", "-fo", "v.csv"]);
    assert_eq!(run["cells"], 6);
    assert!((run["area"].as_f64().unwrap() - 4.0 * std::f64::consts::PI).abs() < 1e-12, "{run}");
    let cells = rows(&path.join("v.csv"));
    assert_eq!(cells[0], ["point", "area", "neighbors"]);
    let mut neighbors: Vec<&str> = cells[1][2].split(' ').collect();
    neighbors.sort_unstable();
    assert_eq!(neighbors, ["1", "3", "4", "5"]);
    for output in ["v.vtu", "v.npz"] {
        succeeds(path, &["voronoi", "p.csv", "--sphere", "-fo", output]);
    }
    let grid = fs::read(path.join("v.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&grid).contains("NumberOfCells=\"6\""));
    assert_eq!(array::<f64>(&path.join("v.npz"), "areas").len(), 6);
    let run = stats(path, &["locate", "p.csv", "q.xyz", "--sphere", "-fo", "l.csv"]);
    assert_eq!((&run["queries"], &run["outside"]), (&3.into(), &0.into()));
    let found = rows(&path.join("l.csv"));
    assert_eq!(found[0], ["triangle", "v0", "v1", "v2", "nearest"]);
    assert_eq!([1, 2, 3].map(|row| found[row][4].as_str()), ["1", "4", "3"]);
    assert!(found[1..].iter().all(|row| row[0] != "-1"));
    let run = stats(path, &["interpolate", "p.csv", "q.xyz", "--values", "value", "--sphere", "-fo", "i.csv"]);
    assert_eq!(run["outside"], 0);
    let values = rows(&path.join("i.csv"));
    assert_eq!((values[3][0].parse(), values[3][2].parse()), (Ok(-90.0), Ok(4.0)));
    // Three places have a hull, beyond which nothing is known.
    fs::write(path.join("p.csv"), "lon,lat,value\n0,0,1\n10,0,2\n0,10,3\n").unwrap();
    let run = stats(path, &["interpolate", "p.csv", "q.xyz", "--values", "value", "--sphere", "-fo", "i.csv"]);
    assert_eq!(run["outside"], 3);
    let run = stats(path, &["voronoi", "p.csv", "--sphere", "-fo", "v.csv"]);
    assert!((run["area"].as_f64().unwrap() - 4.0 * std::f64::consts::PI).abs() < 1e-12, "{run}");
    // By their names, in whatever order they come.
    fs::write(path.join("p.csv"), "Latitude,Longitude\n0,0\n0,10\n10,0\n60,60\n").unwrap();
    fs::write(path.join("q.xyz"), "50 50\n").unwrap();
    succeeds(path, &["locate", "p.csv", "q.xyz", "--sphere", "-fo", "l.csv"]);
    assert_eq!(rows(&path.join("l.csv"))[1][4], "3");
    let clipped = gdel(path, &["voronoi", "p.csv", "--sphere", "--clip", "hull", "-fo", "v.csv"]);
    assert_eq!(clipped.status.code(), Some(2));
}

/// The polygon of flat points is written from both sides, and their alpha shape in their own dimension.
#[test]
fn flat_points_have_a_hull_and_alpha_shapes() {
    let folder = samples();
    let path = folder.path();
    let triangles = |file: &str| {
        let text = fs::read_to_string(path.join(file)).unwrap();
        text.lines().filter(|line| line.starts_with("f ")).count()
    };
    fs::write(path.join("flat.xyz"), "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0.3 0.4 0\n").unwrap();
    let summary = succeeds(path, &["triangulate", "flat.xyz", "--verify", "-o", "hull.obj", "-o", "mesh.npz"]);
    assert!(summary.contains("all points are coplanar"), "{summary}");
    assert_eq!(triangles("hull.obj"), 2 * 4);
    for extension in ["ply", "stl", "glb", "3mf"] {
        succeeds(path, &["triangulate", "flat.xyz", "-o", &format!("hull.{extension}")]);
    }
    let summary = succeeds(path, &["alpha", "flat.xyz", "-fo", "a.obj"]);
    assert!(
        summary.contains("coplanar, so there are no tetrahedra") && summary.contains("triangles       3"),
        "{summary}"
    );
    assert_eq!(triangles("a.obj"), 2 * 3);
    let run = stats(path, &["alpha", "flat.xyz", "--alpha", "0.51", "-fo", "a.vtu"]);
    let expected = [("solid", 0), ("surface", 2), ("components", 1), ("triangles", 1)];
    assert!(expected.iter().all(|&(key, count)| run[key] == count), "{run}");
    let grid = fs::read(path.join("a.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&grid).contains("NumberOfCells=\"1\""));
    for (dim, line) in [("2", "0 0\n1 1\n3 3\n"), ("3", "0 0 0\n1 1 1\n3 3 3\n")] {
        fs::write(path.join("line.xyz"), line).unwrap();
        let run = stats(path, &["alpha", "line.xyz", "--dim", dim, "-fo", "a.vtu"]);
        assert_eq!((&run["segments"], &run["components"]), (&2.into(), &1.into()), "{run}");
        let grid = fs::read(path.join("a.vtu")).unwrap();
        assert!(String::from_utf8_lossy(&grid).contains("NumberOfCells=\"2\""));
    }
    let summary = succeeds(path, &["alpha", "line.xyz", "-fo", "a.ply"]);
    assert!(summary.contains("collinear"), "{summary}");
}
