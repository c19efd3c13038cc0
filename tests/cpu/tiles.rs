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
    tiles::{self, Core, Link, Message, Part, Piece, Plan, Proof, Provable, Seam, Survey, Tile, Tiled, join},
    verify::{Check, Report},
    verify2d, verify3d,
};
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_pcg::Pcg64Mcg;
use std::thread;

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

/// Returns the parts of tiles.
fn parts_by_bytes<const D: usize, const N: usize>(points: &[[f64; D]], tiles: u32, seed: u64) -> Vec<Part<N>>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
    for<'a> Points<'a, D>: From<&'a [[f64; D]]>,
{
    tiles_by_bytes(points, tiles, seed).into_iter().map(|tile| tile.finish().unwrap()).collect()
}

/// Takes all steps of tiles, in any order, with messages as bytes that arrive in any order.
fn tiles_by_bytes<const D: usize, const N: usize>(points: &[[f64; D]], tiles: u32, seed: u64) -> Vec<Tile<D, N>>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
    for<'a> Points<'a, D>: From<&'a [[f64; D]]>,
{
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let (one, other) = points.split_at(points.len() / 3);
    let mut survey = Survey::<D>::new(one, 0, 20).unwrap();
    let more = Survey::<D>::new(other, one.len() as u32, 20).unwrap().to_bytes();
    survey.merge(Survey::from_bytes(&more).unwrap());
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
            // Tiles may rest anywhere between steps.
            if random.random_bool(0.3) {
                all[from] = Tile::from_bytes(plan(), &all[from].to_bytes()).unwrap();
            }
        }
        if steps > 1 && sent.iter().all(Vec::is_empty) {
            break;
        }
        received = sent;
    }
    all
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

/// Takes all steps of tiles of which the cores are taken after some step from the second one on, as bytes. Returns the
/// pieces, and the numbers of simplices in the cores.
fn pieces_by_cores<const D: usize, const N: usize>(
    points: &[[f64; D]],
    tiles: u32,
    every: u32,
    from: u32,
) -> (Vec<Piece<D, N>>, usize)
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
    for<'a> Points<'a, D>: From<&'a [[f64; D]]>,
{
    let plan = Plan::new(Survey::<D>::new(points, 0, every).unwrap(), tiles);
    let parts = (0..).zip(plan.split(points, 0));
    let mut all: Vec<(Tile<D, N>, Option<Vec<u8>>)> =
        parts.map(|(i, (own, indices))| (Tile::new(plan.clone(), i, own, indices).unwrap(), None)).collect();
    let mut received = vec![Vec::new(); all.len()];
    for step in 1.. {
        let mut sent = vec![Vec::new(); all.len()];
        for (from_tile, (tile, core)) in (0..).zip(&mut all) {
            for (to, message) in tile.step(std::mem::take(&mut received[from_tile as usize])).unwrap() {
                sent[to as usize].push((from_tile, message));
            }
            if core.is_none() && step >= from + from_tile % 2 {
                let bytes = core.insert(Vec::new());
                tile.take_core().unwrap().write(bytes).unwrap();
                assert!(matches!(tile.take_core(), Err(Error::BadTile { .. })), "only once");
                *tile = Tile::from_bytes(plan.clone(), &tile.to_bytes()).unwrap();
            }
        }
        if step > from + 1 && sent.iter().all(Vec::is_empty) {
            break;
        }
        received = sent;
    }
    let mut inside = 0;
    let pieces = all.into_iter().map(|(tile, core)| {
        let bytes = core.unwrap();
        let core = Core::<D, N>::read(&mut &bytes[..], bytes.len() as u64).unwrap().unwrap();
        inside += core.simplices();
        core.complete(tile).unwrap()
    });
    (pieces.collect(), inside)
}

/// Checks that pieces are those of tiles of which no cores were taken.
fn check_cores<const D: usize, const N: usize>(
    name: &str,
    points: &[[f64; D]],
    every: u32,
    simplices: fn(MeshOf<D>) -> Vec<[u32; N]>,
) -> usize
where
    Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
    for<'a> Points<'a, D>: From<&'a [[f64; D]]>,
{
    let mut expected = canonical(&simplices(cpu::delaunay::<D>(points.into(), &Options::default()).unwrap()));
    expected.sort_unstable();
    let mut most = 0;
    for (tiles, from) in [(1, 2), (3, 2), (3, 3), (8, 2)] {
        let (pieces, inside) = pieces_by_cores::<D, N>(points, tiles, every, from);
        let names = |piece: &Piece<D, N>| -> Vec<[u32; N]> {
            piece.part.simplices.iter().map(|simplex| simplex.map(|v| piece.indices[v as usize])).collect()
        };
        let mut found = canonical(&pieces.iter().flat_map(names).collect::<Vec<_>>());
        found.sort_unstable();
        assert!(found == expected, "{name}, {tiles} tiles, cores taken after {from} steps");
        let report = proof(&linked(pieces.into_iter().map(|piece| (piece, Vec::new())).collect()));
        assert!(report.passed(), "{name}, {tiles} tiles, cores taken after {from} steps:\n{report}");
        if tiles > 1 {
            most = most.max(inside);
        }
    }
    most
}

fn cores3(name: &str, points: &[[f64; 3]], every: u32) -> usize {
    check_cores::<3, 4>(name, points, every, |mesh| mesh.tetrahedra)
}

fn cores2(name: &str, points: &[[f64; 2]], every: u32) -> usize {
    check_cores::<2, 3>(name, points, every, |mesh| mesh.triangles)
}

#[test]
fn pieces_of_cores_and_their_shells_are_those_of_whole_tiles() {
    let uniform = generate3d(Distribution3::Uniform, 20_000, 1);
    let inside = cores3("uniform", &uniform, 100);
    assert!(inside > 40_000, "{inside} simplices in cores");
    for distribution in Distribution3::ALL {
        cores3(distribution.name(), &generate3d(distribution, 2000, 2), 100);
    }
    for distribution in Distribution2::ALL {
        cores2(distribution.name(), &generate2d(distribution, 5000, 2), 100);
    }
    cores3("grid", &clouds::shuffled(&clouds::grid(12), 1), 100);
    cores3("duplicates", &clouds::thirty_percent_duplicates(3000), 50);
    cores3("clusters", &clouds::clusters_at_1e_9_spacing(2000), 50);
    cores3("terrain", &clouds::terrain(30, 0.3, 0.1), 50);
    cores3("points in a plane", &clouds::grid(6).iter().map(|&[x, y, _]| [x, y, 1.0]).collect::<Vec<_>>(), 10);
    let far: Vec<[f64; 3]> = uniform.iter().map(|p| p.map(|x| 1e9 + x)).collect();
    cores3("far away", &far[..5000], 100);
    for scale in [1e-300, 1e-162, 3e-162, 1e-161, 1e-160, 1e-150, 1e150, 1e300] {
        let scaled: Vec<[f64; 3]> = uniform[..2000].iter().map(|p| p.map(|x| scale * x)).collect();
        cores3("absurd scale", &scaled, 100);
    }
    for case in degenerate::cases(100) {
        let mut random = Pcg64Mcg::seed_from_u64(case);
        cores3(&format!("case {case}"), &degenerate::points(&mut random, 60), 3);
        cores2(&format!("case {case}"), &degenerate::points(&mut random, 60), 3);
    }
}

/// Returns the pieces of tiles with their links.
fn pieces<const D: usize, const N: usize>(points: &[[f64; D]], tiles: u32) -> Vec<(Piece<D, N>, Vec<Link>)>
where
    Dimension<D>: Tiled<D, N>,
    Euclidean: Geometry<D, N>,
    for<'a> Points<'a, D>: From<&'a [[f64; D]]>,
{
    let pieces = tiles_by_bytes(points, tiles, 0).into_iter().map(|tile| (tile.into_piece().unwrap(), Vec::new()));
    linked(pieces.collect())
}

/// Adds the links.
fn linked<const D: usize, const N: usize>(mut pieces: Vec<(Piece<D, N>, Vec<Link>)>) -> Vec<(Piece<D, N>, Vec<Link>)> {
    let mut seam = Seam::default();
    for tile in 0..pieces.len() {
        for (from, link) in seam.add_rim(tile as u32, &pieces[tile].0.rim()) {
            pieces[from as usize].1.push(link);
        }
    }
    assert!(seam.is_closed());
    pieces
}

fn proof<const D: usize, const N: usize>(pieces: &[(Piece<D, N>, Vec<Link>)]) -> Report
where
    Dimension<D>: Provable<D, N>,
    Euclidean: Geometry<D, N>,
{
    let proof = Proof::default();
    // From several threads, in any order.
    thread::scope(|scope| {
        for (tile, (piece, links)) in (0..).zip(pieces) {
            let proof = &proof;
            scope.spawn(move || proof.add(tile, piece, Some(links)).unwrap());
        }
    });
    proof.finish()
}

#[test]
fn pieces_are_proven_one_by_one() {
    for (name, points) in [
        ("uniform", generate3d(Distribution3::Uniform, 2000, 1)),
        ("grid", clouds::shuffled(&clouds::grid(10), 1)),
        ("sphere", generate3d(Distribution3::Sphere, 500, 1)),
        ("duplicates", clouds::thirty_percent_duplicates(2000)),
        ("points in a plane", clouds::grid(6).iter().map(|&[x, y, _]| [x, y, 1.0]).collect()),
        ("no points", Vec::new()),
    ] {
        for tiles in [1, 2, 7] {
            let pieces = pieces::<3, 4>(&points, tiles);
            let report = proof(&pieces);
            assert!(report.passed(), "{name}, {tiles} tiles:\n{report}");
            assert_eq!(report.counts.points, points.len());
            let mut found = vec![false; points.len()];
            for (piece, _) in &pieces {
                for (&i, p) in piece.indices.iter().zip(&piece.points) {
                    assert_eq!(points[i as usize], *p);
                    found[i as usize] = true;
                }
            }
            assert!(found.iter().all(|&found| found));
        }
    }
    for distribution in Distribution2::ALL {
        let report = proof(&pieces::<2, 3>(&generate2d(distribution, 1000, 1), 5));
        assert!(report.passed(), "{}:\n{report}", distribution.name());
    }
    for case in degenerate::cases(100) {
        let mut random = Pcg64Mcg::seed_from_u64(case);
        let report = proof(&pieces::<3, 4>(&degenerate::points(&mut random, 40), 3));
        assert!(report.passed(), "case {case}:\n{report}");
        let report = proof(&pieces::<2, 3>(&degenerate::points(&mut random, 40), 3));
        assert!(report.passed(), "case {case}:\n{report}");
    }
}

#[test]
fn a_proof_finds_whatever_is_wrong_with_pieces() {
    type Pieces = Vec<(Piece<3, 4>, Vec<Link>)>;
    let right = pieces::<3, 4>(&generate3d(Distribution3::Uniform, 600, 1), 3);
    let check = |name: &str, expected: &[Check], damage: &dyn Fn(&mut Pieces)| {
        let mut pieces = right.clone();
        damage(&mut pieces);
        let report = proof(&pieces);
        let failed: Vec<Check> = report.failures().map(|(check, ..)| check).collect();
        assert!(expected.iter().all(|check| failed.contains(check)) && !failed.is_empty(), "{name}:\n{report}");
    };
    let is_foreign = |piece: &Piece<3, 4>, v: usize, tile: u32| piece.owners[v] != tile;
    check("a missing piece", &[Check::HullClosed], &|pieces| _ = pieces.pop());
    check("a missing simplex", &[Check::Neighbors], &|pieces| {
        pieces[1].0.part.simplices.pop();
        pieces[1].0.part.neighbors.pop();
    });
    check("a moved point", &[Check::Vertices], &|pieces| {
        let piece = &mut pieces[2].0;
        let v = (0..piece.points.len()).find(|&v| is_foreign(piece, v, 2)).unwrap();
        piece.points[v][0] += 1e-9;
    });
    check("another index", &[Check::Vertices], &|pieces| {
        let last = pieces[0].0.indices.last_mut().unwrap();
        *last += 1000;
    });
    check("no links", &[Check::Neighbors], &|pieces| pieces[0].1.clear());
    check("a wrong link", &[Check::Neighbors], &|pieces| pieces[0].1[0].entry ^= 1);
    check("a link too many", &[Check::Neighbors], &|pieces| {
        let link = Link { place: u32::MAX, tile: 0, entry: 0 };
        pieces[1].1.push(link);
    });
    check("a duplicate that is none", &[Check::Duplicates], &|pieces| {
        let i = pieces[0].0.indices[1];
        pieces[0].0.part.duplicates.push([i, 0]);
    });
    check("a point in two tiles", &[Check::Vertices], &|pieces| {
        let piece = &mut pieces[1].0;
        let v = (0..piece.points.len()).find(|&v| is_foreign(piece, v, 1)).unwrap();
        piece.owners[v] = 1;
    });
    check("an inverted simplex", &[Check::Orientation], &|pieces| pieces[0].0.part.simplices[5].swap(0, 1));
    check("a vertex out of range", &[Check::Indices], &|pieces| pieces[0].0.part.simplices[5][2] = u32::MAX);
    check("points in the wrong order", &[Check::Indices], &|pieces| pieces[0].0.indices.swap(0, 1));
    // Pieces of another triangulation of the same points: ties are broken the other way.
    let grid = clouds::shuffled(&clouds::grid(5), 1);
    let mut other = pieces::<3, 4>(&grid.iter().rev().copied().collect::<Vec<_>>(), 2);
    assert!(proof(&other).passed());
    for (piece, _) in &mut other {
        piece.indices.iter_mut().for_each(|i| *i = grid.len() as u32 - 1 - *i);
        for array in [&mut piece.indices, &mut piece.owners] {
            array.reverse();
        }
        piece.points.reverse();
        let last = piece.points.len() as u32 - 1;
        piece.part.simplices.as_flattened_mut().iter_mut().for_each(|v| *v = last - *v);
    }
    let report = proof(&other);
    assert!(report.failures().any(|(check, ..)| check == Check::CanonicalTies), "{report}");
    let mut lengths = right[0].clone();
    lengths.0.owners.pop();
    assert!(matches!(Proof::default().add(0, &lengths.0, None), Err(Error::ValueCount { .. })));
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

/// Returns the first tile of a plan after two steps, as bytes.
fn tile_after_two_steps(plan: &Plan<3>, points: &[[f64; 3]]) -> Vec<u8> {
    let parts = (0..).zip(plan.split(points, 0));
    let mut tiles: Vec<Tile<3, 4>> =
        parts.map(|(number, (own, indices))| Tile::new(plan.clone(), number, own, indices).unwrap()).collect();
    let mut hellos = Vec::new();
    for (from, tile) in (0..).zip(&mut tiles) {
        let sent = tile.step(Vec::new()).unwrap();
        hellos.extend(sent.into_iter().filter(|&(to, _)| to == 0).map(|(_, message)| (from, message)));
    }
    tiles[0].step(hellos).unwrap();
    tiles[0].to_bytes()
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
    let resting = tile_after_two_steps(&plan, &points);
    let survey = Survey::<3>::new(&points, 0, 10).unwrap().to_bytes();
    for (bytes, kind) in [(plan.to_bytes(), 0), (hello.to_bytes(), 1), (resting, 2), (survey, 3)] {
        let is_plan = kind == 0;
        let is_read = |bytes: &[u8]| match kind {
            0 => Plan::<3>::from_bytes(bytes).is_ok(),
            1 => Message::<3>::from_bytes(bytes).is_ok(),
            3 => Survey::<3>::from_bytes(bytes).is_ok(),
            _ => Tile::<3, 4>::from_bytes(plan.clone(), bytes).is_ok(),
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
        assert!(kind == 2 || Tile::<3, 4>::from_bytes(plan.clone(), &bytes).is_err());
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
