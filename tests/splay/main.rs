//! Star splaying, from triangulations that are Delaunay but for some flips, insertions or displaced points: the outcome
//! must be the CPU engine's triangulation.

mod flips;
mod inputs;

use flips::{Soup, found_out, near};
use gdel::{
    Options, Points, cpu,
    lattice::Lattice,
    predicates::vertices::Vertices,
    splay::{NearDelaunay, Outcome, SplayStats, splay},
};
use inputs::Cloud;
use rand::{RngExt, seq::SliceRandom};

/// The exact answer, as vertex numbers of the order `indices` of the points.
fn exact(points: &Cloud, indices: &[u32]) -> Vec<[u32; 4]> {
    let mesh = cpu::delaunay3d(points.into(), &Options::default()).unwrap();
    let mut vertex = vec![0; points.len()];
    indices.iter().enumerate().for_each(|(v, &i)| vertex[i as usize] = v as u32);
    mesh.tetrahedra.iter().map(|t| t.map(|i| vertex[i as usize])).collect()
}

fn canonical(mut tetrahedra: Vec<[u32; 4]>) -> Vec<[u32; 4]> {
    tetrahedra.iter_mut().for_each(|t| t.sort_unstable());
    tetrahedra.sort_unstable();
    tetrahedra
}

/// Splays, and demands the exact answer.
fn check(name: &str, vertices: &Vertices<'_>, near: NearDelaunay, answer: &[[u32; 4]]) -> SplayStats {
    // With nothing but doubts, and with just those that are justified.
    let known = found_out(vertices, &near);
    check_one(name, vertices, near, answer);
    check_one(name, vertices, known, answer)
}

fn check_one(name: &str, vertices: &Vertices<'_>, near: NearDelaunay, answer: &[[u32; 4]]) -> SplayStats {
    let started = std::time::Instant::now();
    let (mesh, stats) = match splay(vertices, near, u64::MAX, &|_| Ok(())).unwrap() {
        Outcome::Delaunay(mesh, stats) => (mesh, stats),
        Outcome::GaveUp(reason) => panic!("{name}: gave up: {reason:?}"),
    };
    println!("{name}: {} vertices, {:.1?}, {stats:?}", vertices.len(), started.elapsed());
    let names: Vec<u32> = (0..vertices.len() as u32).collect();
    let (tetrahedra, neighbors) = mesh.into_mesh(&names);
    for (t, n) in neighbors.iter().enumerate() {
        for (k, &other) in n.iter().enumerate() {
            if other >= 0 {
                let mut shared = tetrahedra[t].to_vec();
                shared.remove(k);
                assert!(shared.iter().all(|v| tetrahedra[other as usize].contains(v)), "{name}: neighbours of {t}");
                assert!(neighbors[other as usize].contains(&(t as i32)), "{name}: {other} does not know {t}");
            }
        }
    }
    assert!(tetrahedra.iter().all(|&[a, b, c, d]| vertices.orient3d(a, b, c, d) > 0), "{name}: orientation");
    assert_eq!(canonical(tetrahedra), canonical(answer.to_vec()), "{name}");
    stats
}

/// A random numbering of the points.
fn shuffled(n: usize, seed: u64) -> Vec<u32> {
    let mut indices: Vec<u32> = (0..n as u32).collect();
    indices.shuffle(&mut inputs::random(seed));
    indices
}

/// Flips anything that can be flipped, here and there.
fn with_random_flips(name: &str, points: &Cloud, flips: usize, seed: u64) -> SplayStats {
    let indices = shuffled(points.len(), seed);
    let answer = exact(points, &indices);
    let lattice = Lattice::fit(points.into());
    let vertices = Vertices::new(points.into(), &lattice, indices);
    let mut soup = Soup::new(&vertices, &answer);
    let mut rng = inputs::random(seed);
    let mut flipped = 0;
    for _ in 0..50 * flips {
        if flipped < flips && soup.flip(rng.random_range(0..soup.tetrahedra.len()), rng.random_range(0..4)) {
            flipped += 1;
        }
    }
    check(name, &vertices, soup.finish(), &answer)
}

/// The Delaunay triangulation of points a little off the true ones: ties are broken otherwise, and tetrahedra are flat
/// or inverted in the true coordinates.
fn from_displaced(name: &str, points: &Cloud, by: f64, seed: u64) -> SplayStats {
    let mut rng = inputs::random(seed);
    let displaced: Cloud = points.iter().map(|p| p.map(|x| x + by * (rng.random::<f64>() - 0.5))).collect();
    let indices = shuffled(points.len(), seed);
    let near = near(points.len() as u32, &exact(&displaced, &indices));
    let answer = exact(points, &indices);
    let lattice = Lattice::fit(points.into());
    let vertices = Vertices::new(points.into(), &lattice, indices);
    check(name, &vertices, near, &answer)
}

/// All points that are not on the hull are inserted by splitting, `batch` at a time; then flips go as far as they can.
fn from_split_and_flip(name: &str, points: &Cloud, batch: usize, seed: u64) -> SplayStats {
    let indices = shuffled(points.len(), seed);
    let mesh = cpu::delaunay3d(points.into(), &Options::default()).unwrap();
    let mut vertex = vec![0; points.len()];
    indices.iter().enumerate().for_each(|(v, &i)| vertex[i as usize] = v as u32);
    let mut on_hull: Vec<u32> = mesh.hull.as_flattened().to_vec();
    on_hull.sort_unstable();
    on_hull.dedup();
    let hull_points: Cloud = on_hull.iter().map(|&i| points[i as usize]).collect();
    let first = cpu::delaunay3d((&hull_points).into(), &Options::default()).unwrap();
    let first: Vec<[u32; 4]> =
        first.tetrahedra.iter().map(|t| t.map(|i| vertex[on_hull[i as usize] as usize])).collect();

    let lattice = Lattice::fit(points.into());
    let vertices = Vertices::new(points.into(), &lattice, indices);
    let mut soup = Soup::new(&vertices, &first);
    let inside: Vec<u32> = (0..points.len() as u32).filter(|i| on_hull.binary_search(i).is_err()).collect();
    for batch in inside.chunks(batch) {
        // A point on a facet stays out.
        batch.iter().for_each(|&i| {
            soup.split(vertex[i as usize]);
        });
        soup.lawson();
    }
    let answer: Vec<[u32; 4]> = mesh.tetrahedra.iter().map(|t| t.map(|i| vertex[i as usize])).collect();
    check(name, &vertices, soup.finish(), &answer)
}

fn clouds(n: usize, seed: u64) -> Vec<(&'static str, Cloud)> {
    vec![
        ("uniform", inputs::uniform(n, seed)),
        ("gaussian", inputs::gaussian(n, seed)),
        ("ball", inputs::ball(n, seed)),
        ("sphere", inputs::sphere(n, seed)),
        ("thin sphere", inputs::thin_sphere(n, seed)),
        ("clusters", inputs::clusters(n, seed)),
        ("skew lines", inputs::skew_lines(n.min(300), seed)),
        ("prism", inputs::prism(n, seed)),
        ("grid sample", inputs::grid_sample(n, 16, seed)),
    ]
}

fn is_spatial(points: &Cloud) -> bool {
    points.len() >= 4 && Points::from(points).len() == points.len() && {
        cpu::delaunay3d(points.into(), &Options::default()).unwrap().dimension == 3
    }
}

#[test]
fn an_exact_triangulation_is_left_alone() {
    for (name, points) in clouds(1000, 1) {
        let stats = with_random_flips(name, &points, 0, 1);
        assert_eq!(stats, SplayStats::default(), "{name}");
    }
}

#[test]
fn random_flips_are_undone() {
    for (name, points) in clouds(2000, 2) {
        for flips in [1, 10, 300, 3000] {
            let stats = with_random_flips(&format!("{name}, {flips} flips"), &points, flips, 3);
            // No facet between two skew lines can be flipped.
            assert!(stats.added > 0 || name == "skew lines", "{name}");
        }
    }
    with_random_flips("uniform 20,000", &inputs::uniform(20_000, 4), 2000, 5);
}

#[test]
fn displaced_points() {
    for (name, points) in clouds(1000, 7) {
        for by in [1e-12, 1e-6, 1e-3, 1e-2] {
            from_displaced(&format!("{name}, displaced by {by}"), &points, by, 8);
        }
    }
}

#[test]
fn displaced_grids_have_flat_tetrahedra() {
    for side in [4, 5, 9, 16] {
        for by in [1e-9, 0.1] {
            from_displaced(&format!("grid {side}, displaced by {by}"), &inputs::grid(side), by, 9);
        }
    }
}

#[test]
fn stuck_flipping_is_mended() {
    for (name, points) in [
        ("uniform", inputs::uniform(600, 10)),
        ("gaussian", inputs::gaussian(600, 11)),
        ("ball", inputs::ball(600, 12)),
        ("thin sphere", inputs::thin_sphere(600, 13)),
        ("clusters", inputs::clusters(600, 14)),
        ("grid", inputs::grid_sample(600, 12, 15)),
    ] {
        let all = from_split_and_flip(&format!("{name}, insert all"), &points, points.len(), 16);
        let some = from_split_and_flip(&format!("{name}, insert 20"), &points, 20, 16);
        println!("{name}: {} {}", all.failed, some.failed);
    }
}

#[test]
fn small_inputs_of_all_kinds() {
    for seed in 0..400 {
        let mut rng = inputs::random(seed);
        let n = rng.random_range(5..120);
        let side = rng.random_range(2..6);
        let mut all = clouds(n, seed);
        all.push(("small grid", inputs::grid_sample(n, side, seed)));
        let (name, points) = &all[seed as usize % all.len()];
        if is_spatial(points) {
            with_random_flips(&format!("{name}, seed {seed}"), points, n, seed);
            for by in [1e-9, 0.03, 0.3] {
                from_displaced(&format!("{name}, seed {seed}, displaced by {by}"), points, by, seed);
            }
        }
    }
}
