//! Star splaying, from triangulations that are Delaunay except for some flips, insertions or
//! displaced points: the result must be the triangulation that the CPU makes.

mod flips;
mod inputs;
#[cfg(feature = "gpu")]
mod phase1;
#[cfg(feature = "gpu")]
mod regions;

use flips::{Soup, found_out, near};
use gdel::{
    MeshView3, NONE, Points,
    internals::{
        Options, cpu,
        d3::{
            splay::{Aborted, KeptRegion, NearDelaunay3, SplayOutcome, Terms, splay, splay_again},
            triangulation::{FiniteMesh, Triangulation3},
        },
        input::lattice::Lattice,
        parallel::Threads,
        predicates::filter::{PredicateContext, PredicateContext3},
    },
    stats::SplayStats,
    verify3d,
};
use inputs::Cloud;
use rand::{RngExt, seq::SliceRandom};

/// Returns the exact result, as vertex numbers of the order `indices` of the points.
fn exact(points: &Cloud, indices: &[u32]) -> Vec<[u32; 4]> {
    let mesh = cpu::delaunay::<3>(points.into(), &Options::default()).unwrap();
    let mut vertex = vec![0; points.len()];
    indices.iter().enumerate().for_each(|(v, &i)| vertex[i as usize] = v as u32);
    mesh.tetrahedra.iter().map(|t| t.map(|i| vertex[i as usize])).collect()
}

fn canonical(mut tetrahedra: Vec<[u32; 4]>) -> Vec<[u32; 4]> {
    tetrahedra.iter_mut().for_each(|t| t.sort_unstable());
    tetrahedra.sort_unstable();
    tetrahedra
}

/// Splays twice, once with everything uncertain, and once with only what is really wrong; checks
/// that the result is exact.
fn check(name: &str, vertices: &PredicateContext3<'_>, near: NearDelaunay3, answer: &[[u32; 4]]) -> SplayStats {
    let known = found_out(vertices, &near);
    #[cfg(feature = "gpu")]
    let mut kept = None;
    #[cfg(feature = "gpu")]
    let in_parts = [&near, &known].map(|near| regions::splayed(name, vertices, near.clone(), &mut kept));
    let mut kept = KeptRegion::default();
    let (doubting, _) = splayed(name, vertices, near, &mut kept);
    let (tetrahedra, stats) = splayed(name, vertices, known, &mut kept);
    let answer = canonical(answer.iter().map(|t| t.map(|v| vertices.input_index(v))).collect());
    assert_eq!(canonical(doubting), answer, "{name}");
    assert_eq!(canonical(tetrahedra), answer, "{name}");
    #[cfg(feature = "gpu")]
    for (tetrahedra, in_parts) in in_parts {
        assert_eq!(canonical(tetrahedra), answer, "{name}, in parts");
        // Each part does what is done with the whole, except for where walks begin.
        if stats.inserted == 0 {
            assert_eq!((in_parts.failed > 0, in_parts.inserted), (stats.failed > 0, stats.inserted), "{name}");
        }
    }
    stats
}

/// Returns the tetrahedra that splaying gives in the memory of `kept`, which the verifier must accept.
fn splayed(
    name: &str,
    vertices: &PredicateContext3<'_>,
    near: NearDelaunay3,
    kept: &mut KeptRegion,
) -> (Vec<[u32; 4]>, SplayStats) {
    let started = std::time::Instant::now();
    let (mesh, stats) = match splay_again(vertices, near, Terms::unlimited(Threads::All), kept).unwrap() {
        SplayOutcome::Delaunay(mesh, stats) => (mesh, stats),
        SplayOutcome::Aborted(reason) => panic!("{name}: aborted: {reason:?}"),
    };
    println!("{name}: {} vertices, {:.1?}, {stats:?}", vertices.len(), started.elapsed());
    (verified(name, vertices, *mesh), stats)
}

/// Returns the tetrahedra of a triangulation by input indices. The verifier must accept them.
fn verified(name: &str, vertices: &PredicateContext3<'_>, mesh: Triangulation3) -> Vec<[u32; 4]> {
    let names: Vec<u32> = (0..vertices.len() as u32).map(|v| vertices.input_index(v)).collect();
    let FiniteMesh { tetrahedra, neighbors, hull } = mesh.into_mesh(Some(&names), Threads::All);
    let mut points = vec![[0.0; 3]; names.len()];
    names.iter().zip(0..).for_each(|(&i, v)| points[i as usize] = vertices.point(v));
    let mut statement = MeshView3::of_tetrahedra(&tetrahedra);
    statement.neighbors = Some(&neighbors);
    statement.hull = Some(&hull);
    let report = verify3d(&points, statement).unwrap();
    assert!(report.passed(), "{name}: {:?}", report.failures().next());
    tetrahedra
}

/// Returns a random numbering of the points.
fn shuffled(n: usize, seed: u64) -> Vec<u32> {
    let mut indices: Vec<u32> = (0..n as u32).collect();
    indices.shuffle(&mut inputs::random(seed));
    indices
}

/// Flips random facets that can be flipped, then splays.
fn with_random_flips(name: &str, points: &Cloud, flips: usize, seed: u64) -> SplayStats {
    let indices = shuffled(points.len(), seed);
    let answer = exact(points, &indices);
    let lattice = Lattice::fit(points.into());
    let vertices = PredicateContext::new(points.into(), &lattice, indices);
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

/// Splays the Delaunay triangulation of points slightly displaced from the exact ones: ties are
/// broken differently, and tetrahedra are flat or inverted in the exact coordinates.
fn from_displaced(name: &str, points: &Cloud, by: f64, seed: u64) -> SplayStats {
    let mut rng = inputs::random(seed);
    let displaced: Cloud = points.iter().map(|p| p.map(|x| x + by * (rng.random::<f64>() - 0.5))).collect();
    let indices = shuffled(points.len(), seed);
    let near = near(points.len() as u32, &exact(&displaced, &indices));
    let answer = exact(points, &indices);
    let lattice = Lattice::fit(points.into());
    let vertices = PredicateContext::new(points.into(), &lattice, indices);
    check(name, &vertices, near, &answer)
}

/// Inserts all points that are not on the hull by splitting, `batch` at a time, each followed by
/// flips as far as they can go; then splays.
fn from_split_and_flip(name: &str, points: &Cloud, batch: usize, seed: u64) -> SplayStats {
    let indices = shuffled(points.len(), seed);
    let mesh = cpu::delaunay::<3>(points.into(), &Options::default()).unwrap();
    let mut vertex = vec![0; points.len()];
    indices.iter().enumerate().for_each(|(v, &i)| vertex[i as usize] = v as u32);
    let mut on_hull: Vec<u32> = mesh.hull.as_flattened().to_vec();
    on_hull.sort_unstable();
    on_hull.dedup();
    let hull_points: Cloud = on_hull.iter().map(|&i| points[i as usize]).collect();
    let first = cpu::delaunay::<3>((&hull_points).into(), &Options::default()).unwrap();
    let first: Vec<[u32; 4]> =
        first.tetrahedra.iter().map(|t| t.map(|i| vertex[on_hull[i as usize] as usize])).collect();

    let lattice = Lattice::fit(points.into());
    let vertices = PredicateContext::new(points.into(), &lattice, indices);
    let mut soup = Soup::new(&vertices, &first);
    let inside: Vec<u32> = (0..points.len() as u32).filter(|i| on_hull.binary_search(i).is_err()).collect();
    for batch in inside.chunks(batch) {
        // A point on a facet is left out.
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
        cpu::delaunay::<3>(points.into(), &Options::default()).unwrap().dimension == 3
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
    for side in [4, 5, 9, 14] {
        for by in [1e-9, 0.1] {
            from_displaced(&format!("grid {side}, displaced by {by}"), &inputs::grid(side), by, 9);
        }
    }
}

#[test]
fn stuck_flipping_is_mended() {
    let mut stuck = 0;
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
        assert!(some.failed <= all.failed, "{name}");
        stuck += all.failed;
    }
    assert!(stuck > 0);
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

/// Returns a triangulation whose splaying takes work.
fn spoilt(points: &Cloud) -> NearDelaunay3 {
    let mut rng = inputs::random(20);
    let displaced: Cloud = points.iter().map(|p| p.map(|x| x + 0.1 * (rng.random::<f64>() - 0.5))).collect();
    near(points.len() as u32, &exact(&displaced, &shuffled(points.len(), 21)))
}

/// The stars of thousands of failed vertices are each built in one of several threads: the result
/// does not depend on which.
#[test]
fn threads_share_the_stars() {
    let points = inputs::sphere(3000, 22);
    let identity: Vec<u32> = (0..points.len() as u32).collect();
    let mut rng = inputs::random(23);
    let displaced: Cloud = points.iter().map(|p| p.map(|x| x + 1e-3 * (rng.random::<f64>() - 0.5))).collect();
    let near = near(points.len() as u32, &exact(&displaced, &identity));
    let lattice = Lattice::fit((&points).into());
    let results = [Threads::One, Threads::All].map(|threads| {
        let vertices = PredicateContext::of_input((&points).into(), &lattice);
        match splay(&vertices, near.clone(), Terms::unlimited(threads)).unwrap() {
            SplayOutcome::Delaunay(mesh, stats) => {
                (canonical(mesh.into_mesh(None, threads).tetrahedra), stats, vertices.exact_counts())
            }
            SplayOutcome::Aborted(reason) => panic!("{reason:?}"),
        }
    });
    assert!(results[0].1.built > 100, "{:?}", results[0].1);
    assert!(results[0] == results[1], "{:?} {:?}", results[0].1, results[1].1);
    assert!(results[0].0 == canonical(exact(&points, &identity)));
}

#[test]
fn too_much_work_aborts() {
    let points = inputs::uniform(200, 19);
    let lattice = Lattice::fit((&points).into());
    let vertices = PredicateContext::new((&points).into(), &lattice, shuffled(points.len(), 21));
    let enough = match splay(&vertices, spoilt(&points), Terms::unlimited(Threads::All)).unwrap() {
        SplayOutcome::Delaunay(_, stats) => stats.signs,
        SplayOutcome::Aborted(reason) => panic!("{reason:?}"),
    };
    for max_evaluations in [0, enough / 4, enough / 2, enough - enough / 8] {
        let outcome =
            splay(&vertices, spoilt(&points), Terms { max_evaluations, ..Terms::unlimited(Threads::All) }).unwrap();
        assert!(matches!(outcome, SplayOutcome::Aborted(Aborted::BudgetExceeded)), "{max_evaluations} of {enough}");
    }
}

/// Where there are inverted tetrahedra, a triangulation can have the others twice: between two facets of a
/// tetrahedron and what is across, there may be two more of the same vertices, of which one is inverted.
#[test]
fn tetrahedra_that_are_there_twice_are_removed() {
    let points = inputs::uniform(200, 5);
    let lattice = Lattice::fit((&points).into());
    let indices: Vec<u32> = (0..points.len() as u32).collect();
    let vertices = PredicateContext::<3>::new((&points).into(), &lattice, indices.clone());
    let answer = exact(&points, &indices);
    let mut near = near(points.len() as u32, &answer);
    let mesh = near.triangulation;
    let infinite = mesh.infinite();
    let (mut tetrahedra, mut neighbors) = (mesh.tetrahedra().to_vec(), mesh.neighbors().to_vec());
    let inside = (0..tetrahedra.len()).find(|&t| {
        let across = neighbors[t].iter().map(|&across| tetrahedra[across as usize / 4]);
        !tetrahedra[t].contains(&infinite) && across.into_iter().all(|v| !v.contains(&infinite))
    });
    let t = inside.expect("a tetrahedron that is not at the hull");
    let [inverted, double] = [0, 1].map(|more| (tetrahedra.len() + more) as u32);
    let [a, b, c, d] = tetrahedra[t];
    // The facets opposite to c and d: from t to the inverted one, from there by its other two facets to
    // the double, and on to what was across.
    tetrahedra.extend([[b, a, c, d], [a, b, c, d]]);
    let beyond = [neighbors[t][2], neighbors[t][3]];
    neighbors.push([4 * double + 1, 4 * double, 4 * t as u32 + 2, 4 * t as u32 + 3]);
    neighbors.push([4 * inverted + 1, 4 * inverted, beyond[0], beyond[1]]);
    for (k, across) in (2..4).zip(beyond) {
        neighbors[t][k as usize] = 4 * inverted + k;
        neighbors[across as usize / 4][across as usize % 4] = 4 * double + k;
    }
    near.triangulation = Triangulation3::new(tetrahedra, neighbors, infinite);
    near.uncertain = vec![inverted];
    let stats = check("a tetrahedron twice", &vertices, near, &answer);
    assert_eq!((stats.removed, stats.added), (2, 0));
}

#[test]
fn what_is_not_a_triangulation_aborts() {
    let points = inputs::uniform(200, 22);
    let lattice = Lattice::fit((&points).into());
    let vertices = PredicateContext::new((&points).into(), &lattice, shuffled(points.len(), 21));
    let near = spoilt(&points);
    let no_tetrahedra = NearDelaunay3 { vertex_simplex: vec![NONE; points.len() + 1], ..near.clone() };
    let wrong_tetrahedra =
        NearDelaunay3 { vertex_simplex: near.vertex_simplex.iter().rev().copied().collect(), ..near };
    for near in [no_tetrahedra, wrong_tetrahedra] {
        let outcome = splay(&vertices, near, Terms::unlimited(Threads::All)).unwrap();
        assert!(matches!(outcome, SplayOutcome::Aborted(Aborted::Inconsistent(_))), "{outcome:?}");
    }
}

#[test]
fn a_caller_can_cancel() {
    let points = inputs::uniform(200, 23);
    let lattice = Lattice::fit((&points).into());
    let vertices = PredicateContext::new((&points).into(), &lattice, shuffled(points.len(), 21));
    let outcome = splay(
        &vertices,
        spoilt(&points),
        Terms { report: &|_| Err(gdel::Error::Cancelled), ..Terms::unlimited(Threads::All) },
    );
    assert_eq!(outcome.err(), Some(gdel::Error::Cancelled));
}

#[test]
fn missing_points_are_inserted() {
    for (name, points) in clouds(1000, 24) {
        let mut indices = shuffled(points.len(), 25);
        // The points of the first part are triangulated; the others have the highest vertex
        // numbers.
        let part = points.len() * 9 / 10;
        indices[..part].sort_unstable();
        let some: Cloud = indices[..part].iter().map(|&i| points[i as usize]).collect();
        let mesh = cpu::delaunay::<3>((&some).into(), &Options::default()).unwrap();
        let answer = exact(&points, &indices);
        let lattice = Lattice::fit((&points).into());
        let vertices = PredicateContext::new((&points).into(), &lattice, indices);
        let stats = check(name, &vertices, near(points.len() as u32, &mesh.tetrahedra), &answer);
        assert_eq!(stats.inserted, points.len() - part, "{name}");
    }
}
