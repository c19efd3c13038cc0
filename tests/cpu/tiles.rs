//! Any number of tiles makes the mesh of all points.

use crate::{clouds, degenerate, threads::facets};
use gdel::{
    Error, Mesh2, Mesh3, NONE, Points,
    internals::{
        Options,
        cpu::{self, MeshOf},
        d2::generate::{Distribution2, generate2d},
        d3::generate::{Distribution3, generate3d},
        dimension::Dimension,
        geometry::{Euclidean, Geometry},
        mesh::canonical,
    },
    tiles::{self, Message, Part, Plan, Survey, Tile, Tiled, join},
    verify2d, verify3d,
};
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;

const TILES: [u32; 5] = [1, 2, 3, 8, 64];

/// Returns how many facets are on the hull, and the facets of the hull.
fn hull3(mesh: &Mesh3) -> (usize, Vec<[u32; 3]>) {
    let outside = mesh.neighbors.as_flattened().iter().filter(|&&t| t == NONE).count();
    (outside, facets(mesh))
}

fn check3(name: &str, points: &[[f64; 3]], every: u32) {
    let options = Options::default();
    let expected: Mesh3 = cpu::delaunay::<3>(points.into(), &options).unwrap();
    for tiles in TILES {
        let (mesh, _) = tiles::delaunay::<3, 4>(points.into(), tiles, every, &options).unwrap();
        assert!(mesh.canonical() == expected.canonical(), "{name}, {tiles} tiles of {} points", points.len());
        assert!(hull3(&mesh) == hull3(&expected), "{name}, {tiles} tiles of {} points", points.len());
        assert_eq!((&mesh.duplicate_of, mesh.dimension), (&expected.duplicate_of, expected.dimension), "{name}");
        if tiles == 3 {
            let report = verify3d(points, &mesh).unwrap();
            assert!(report.passed(), "{name}:\n{report}");
        }
    }
}

fn check2(name: &str, points: &[[f64; 2]], every: u32) {
    let options = Options::default();
    let expected: Mesh2 = cpu::delaunay::<2>(points.into(), &options).unwrap();
    let parts = |mesh: &Mesh2| (mesh.canonical(), mesh.hull.clone(), mesh.duplicate_of.clone(), mesh.dimension);
    for tiles in TILES {
        let (mesh, _) = tiles::delaunay::<2, 3>(points.into(), tiles, every, &options).unwrap();
        assert!(parts(&mesh) == parts(&expected), "{name}, {tiles} tiles of {} points", points.len());
        if tiles == 3 {
            let report = verify2d(points, &mesh).unwrap();
            assert!(report.passed(), "{name}:\n{report}");
        }
    }
}

#[test]
fn tiles_agree_on_all_distributions() {
    for distribution in Distribution3::ALL {
        check3(distribution.name(), &generate3d(distribution, 3000, 1), 100);
    }
    for distribution in Distribution2::ALL {
        check2(distribution.name(), &generate2d(distribution, 5000, 1), 100);
    }
}

#[test]
fn tiles_agree_on_ties_and_duplicates_across_their_borders() {
    check3("grid", &clouds::shuffled(&clouds::grid(10), 1), 50);
    check3("duplicates", &clouds::grid_64_with_duplicates(2000), 50);
    check3("thirty percent duplicates", &clouds::thirty_percent_duplicates(2000), 50);
    check3("skew lines", &clouds::two_skew_lines(60), 7);
    check3("moment curve", &clouds::moment_curve(60), 7);
    check3("cylinder", &clouds::cylinder(200), 20);
    check3("circle and its axis", &clouds::circle_and_its_axis(100), 20);
    check3("clusters", &clouds::clusters_at_1e_9_spacing(2000), 50);
    check3("terrain", &clouds::terrain(30, 0.3, 0.1), 50);
    check3("flat ground", &clouds::flat_ground(500), 50);
    let flat: Vec<[f64; 3]> = clouds::grid(10).iter().map(|&[x, y, _]| [x, y, 1.0]).collect();
    check3("points in a plane", &flat, 10);
    check3("no points", &[], 1);
    check3("one point", &[[1.0, 2.0, 3.0]], 1);
    check3("equal points", &[[1.0, -0.0, 3.0], [1.0, 0.0, 3.0]], 1);
}

#[test]
fn tiles_agree_on_a_scan_which_is_hollow() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/bunny.ply");
    let bunny = gdel_io::files::read_points(std::path::Path::new(path)).expect("the bunny");
    let bunny: Vec<[f64; 3]> = Points::from(&bunny).iter().collect();
    check3("bunny", &bunny, 100);
    let above: Vec<[f64; 2]> = bunny.iter().map(|&[x, _, z]| [x, z]).collect();
    check2("bunny from above", &above, 100);
}

#[test]
fn degenerate_inputs_agree() {
    for case in degenerate::cases(150) {
        let mut random = Pcg64Mcg::seed_from_u64(case);
        let every = [1, 3, 10, 1000][random.random_range(0..4)];
        check3(&format!("case {case}"), &degenerate::points(&mut random, 60), every);
        check2(&format!("case {case}"), &degenerate::points(&mut random, 60), every);
    }
}

/// Takes all steps of tiles, in any order, with messages as bytes that arrive in any order.
fn parts_by_bytes<const D: usize, const N: usize>(points: &[[f64; D]], tiles: u32, seed: u64) -> Vec<Part<N>>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
    for<'a> Points<'a, D>: From<&'a [[f64; D]]>,
{
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let (one, other) = points.split_at(points.len() / 3);
    let mut survey = Survey::<D>::new(one, 0, 20).unwrap();
    survey.merge(Survey::new(other, one.len() as u32, 20).unwrap());
    let plan = Plan::new(survey, tiles).to_bytes();
    let plan = || Plan::<D>::from_bytes(&plan).unwrap();
    let mut all: Vec<Tile<D, N>> = Vec::new();
    for (number, (mut own, mut indices)) in (0..).zip(plan().split(one, 0)) {
        let (more, more_indices) = plan().split(other, one.len() as u32).swap_remove(number as usize);
        own.extend(more);
        indices.extend(more_indices);
        all.push(Tile::new(plan(), number, own, indices).unwrap());
    }
    let mut received: Vec<Vec<(u32, Vec<u8>)>> = vec![Vec::new(); all.len()];
    for steps in 1.. {
        let mut sent = vec![Vec::new(); all.len()];
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.shuffle(&mut random);
        for from in order {
            received[from].shuffle(&mut random);
            let messages = received[from].drain(..).map(|(from, bytes)| (from, Message::from_bytes(&bytes).unwrap()));
            for (to, message) in all[from].step(messages.collect()).unwrap() {
                sent[to as usize].push((from as u32, message.to_bytes()));
            }
        }
        if steps > 1 && sent.iter().all(Vec::is_empty) {
            break;
        }
        received = sent;
    }
    all.into_iter().map(Tile::finish).collect()
}

#[test]
fn the_order_of_messages_does_not_matter() {
    let points = clouds::shuffled(&clouds::grid(8), 3);
    let expected = cpu::delaunay::<3>((&points).into(), &Options::default()).unwrap();
    for seed in 0..10 {
        let mesh: MeshOf<3> = join::<3, 4>(parts_by_bytes(&points, 4, seed), points.len()).unwrap();
        assert!(mesh.canonical() == expected.canonical());
    }
    let points = generate2d(Distribution2::Grid, 2000, 1);
    let expected = cpu::delaunay::<2>((&points).into(), &Options::default()).unwrap();
    for seed in 0..10 {
        let mesh: MeshOf<2> = join::<2, 3>(parts_by_bytes(&points, 4, seed), points.len()).unwrap();
        assert!(mesh.canonical() == expected.canonical());
    }
}

#[test]
fn no_simplex_is_in_two_parts_and_a_missing_part_is_noticed() {
    let points = generate3d(Distribution3::Uniform, 1000, 1);
    let mut parts = parts_by_bytes::<3, 4>(&points, 5, 0);
    let all: Vec<[u32; 4]> = parts.iter().flat_map(|part| part.simplices.iter().copied()).collect();
    let mut distinct = canonical(&all);
    distinct.dedup();
    assert_eq!(distinct.len(), all.len());
    parts.remove(2);
    assert!(matches!(join::<3, 4>(parts, points.len()), Err(Error::BrokenMesh { .. })));
    assert!(matches!(join::<3, 4>(parts_by_bytes(&points, 2, 0), 10), Err(Error::BrokenMesh { .. })));
}

#[test]
fn broken_bytes_are_errors() {
    let points = generate3d(Distribution3::Uniform, 100, 1);
    let plan = Plan::new(Survey::<3>::new(&points, 0, 10).unwrap(), 4);
    let mut tile = Tile::<3, 4>::new(plan.clone(), 1, Vec::new(), Vec::new()).unwrap();
    let (_, hello) = tile.step(Vec::new()).unwrap().swap_remove(0);
    let mut many = plan.to_bytes();
    many[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(Plan::<3>::from_bytes(&many).is_err(), "so many tiles are not in it");
    assert_eq!(Plan::new(Survey::<3>::new(&points, 0, 10).unwrap(), u32::MAX).tiles(), 1 << 16);
    let mut random = Pcg64Mcg::seed_from_u64(1);
    for (bytes, is_plan) in [(plan.to_bytes(), true), (hello.to_bytes(), false)] {
        let is_read = |bytes: &[u8]| match is_plan {
            true => Plan::<3>::from_bytes(bytes).is_ok(),
            false => Message::<3>::from_bytes(bytes).is_ok(),
        };
        assert!(is_read(&bytes));
        for length in 0..bytes.len() {
            assert!(!is_read(&bytes[..length]), "{length} of {} bytes", bytes.len());
        }
        assert!(!is_read(&[&bytes[..], &[0]].concat()));
        for _ in 0..2000 {
            let mut broken = bytes.clone();
            let at = random.random_range(0..broken.len());
            broken[at] = random.random();
            // What is read can be used.
            if let (true, Ok(plan)) = (is_plan, Plan::<3>::from_bytes(&broken)) {
                points.iter().for_each(|&p| assert!(plan.tile_of(p) < plan.tiles()));
            }
            is_read(&broken);
        }
        assert!(Plan::<2>::from_bytes(&bytes).is_err() && Message::<2>::from_bytes(&bytes).is_err());
    }
}

#[test]
fn what_does_not_belong_to_a_tile_is_an_error() {
    let points = generate2d(Distribution2::Uniform, 100, 1);
    let plan = Plan::new(Survey::<2>::new(&points, 0, 10).unwrap(), 2);
    let (own, indices) = plan.split(&points, 0).swap_remove(0);
    let new = |number, points: &[[f64; 2]], indices: &[u32]| {
        Tile::<2, 3>::new(plan.clone(), number, points.to_vec(), indices.to_vec()).map(drop)
    };
    assert_eq!(new(0, &own, &indices), Ok(()));
    let text = |number, points: &[[f64; 2]], indices: &[u32]| new(number, points, indices).unwrap_err().to_string();
    assert_eq!(text(2, &own, &indices), "tile 2 cannot be made: there is none with this number");
    assert_eq!(text(1, &own, &indices), "tile 1 cannot be made: one of its points belongs to another one");
    let reversed: Vec<u32> = indices.iter().rev().copied().collect();
    assert_eq!(text(0, &own, &reversed), "tile 0 cannot be made: the indices of its points do not ascend");
    assert_eq!(text(0, &own, &indices[1..]), format!("there are {} values for {} points", own.len() - 1, own.len()));
    assert!(text(0, &[[f64::NAN, 0.0]], &[0]).contains("not a finite number"));

    // Messages out of turn.
    let tile = |number| {
        let (own, indices) = plan.split(&points, 0).swap_remove(number as usize);
        Tile::<2, 3>::new(plan.clone(), number, own, indices).unwrap()
    };
    let (mut a, mut b) = (tile(0), tile(1));
    let hello = |sent: Vec<(u32, Message<2>)>, from| sent.into_iter().map(|(_, message)| (from, message)).collect();
    let (from_a, from_b): (Vec<_>, Vec<_>) =
        (hello(a.step(Vec::new()).unwrap(), 0), hello(b.step(Vec::new()).unwrap(), 1));
    let is_bad = |result| matches!(result, Err(Error::BadMessage { .. }));
    assert!(is_bad(tile(0).step(from_b.clone())), "it has not begun");
    assert!(is_bad(a.step(from_a)), "it is its own");
    let mut a = tile(0);
    a.step(Vec::new()).unwrap();
    assert!(is_bad(a.step(Vec::new())), "the other tile has said nothing");
    let mut a = tile(0);
    a.step(Vec::new()).unwrap();
    a.step(from_b.clone()).unwrap();
    assert!(is_bad(a.step(from_b)), "it was there before");
    assert_eq!(Survey::<2>::new(&[[0.0, 0.0], [f64::NAN, 0.0]], 7, 1).unwrap_err().to_string(), {
        "point 8: the x coordinate is NaN, which is not a finite number"
    });
}
