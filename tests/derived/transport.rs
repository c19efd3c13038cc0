//! Weights with which power cells have given volumes, checked against the diagrams of the meshes with these weights.

use crate::{
    inputs::{inputs2, inputs3},
    voronoi::{bounds, boxes},
    weighted::Weighted,
};
use gdel::{
    Backend, Clip, Error, Mesh2, Mesh3, NONE, Points, Transport, TransportOptions, Triangulator, Voronoi,
    internals::{
        derived::{VoronoiShapes, sites_by_halves},
        geometry::Euclidean,
    },
    stats::Phase,
};
use rand::RngExt;
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};
use std::{
    num::NonZeroUsize,
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
};

/// The method of either dimension.
trait Transported<const D: usize, const N: usize>: Weighted<D, N> {
    fn transport(
        triangulator: &Triangulator,
        points: &[[f64; D]],
        clip: Clip<'_, D>,
        options: &TransportOptions<'_>,
    ) -> Result<Transport, Error>;
}

impl Transported<3, 4> for Mesh3 {
    fn transport(
        triangulator: &Triangulator,
        points: &[[f64; 3]],
        clip: Clip<'_, 3>,
        options: &TransportOptions<'_>,
    ) -> Result<Transport, Error> {
        triangulator.transport3d(points, clip, options)
    }
}

impl Transported<2, 3> for Mesh2 {
    fn transport(
        triangulator: &Triangulator,
        points: &[[f64; 2]],
        clip: Clip<'_, 2>,
        options: &TransportOptions<'_>,
    ) -> Result<Transport, Error> {
        triangulator.transport2d(points, clip, options)
    }
}

fn with_masses(masses: &[f64]) -> TransportOptions<'_> {
    let mut options = TransportOptions::default();
    options.masses = Some(masses);
    options
}

fn normalized(masses: Option<&[f64]>) -> TransportOptions<'_> {
    let mut options = TransportOptions::default();
    (options.masses, options.normalize) = (masses, true);
    options
}

/// Checks that the cells of the mesh with the weights that are found have the masses.
fn check<M: Transported<D, N>, const D: usize, const N: usize>(
    name: &str,
    points: &[[f64; D]],
    clip: Clip<'_, D>,
    masses: Option<&[f64]>,
) where
    Euclidean: VoronoiShapes<D, N>,
{
    let options = normalized(masses);
    let found = match M::transport(&Triangulator::new(), points, clip, &options) {
        // Points that are 10⁻⁹ of the box apart have cells of 10⁻¹⁸ of it to begin with.
        Err(Error::TransportStopped { .. }) if ["clusters", "grids at 1e-9"].iter().any(|n| name.starts_with(n)) => {
            return;
        }
        found => found.unwrap_or_else(|e| panic!("{name}: {e}")),
    };
    let mesh = M::regular(points, &found.weights);
    let volumes = Voronoi::new(&mesh, Points::F64(points), clip).unwrap().volumes();
    assert_eq!((found.weights.len(), found.volumes.len()), (points.len(), points.len()), "{name}");
    let mut wanted = masses.map_or_else(|| vec![1.0; points.len()], <[f64]>::to_vec);
    let share = volumes.iter().sum::<f64>() / wanted.iter().sum::<f64>();
    wanted.iter_mut().for_each(|mass| *mass *= share);
    let mut own = found.volumes.clone();
    for (i, &first) in mesh.duplicate_of().iter().enumerate().filter(|&(_, &first)| first != NONE) {
        assert_eq!(found.weights[i], found.weights[first as usize], "{name} {i}");
        for all in [&mut wanted, &mut own] {
            all[first as usize] += all[i];
            all[i] = 0.0;
        }
    }
    for (i, (&volume, &mass)) in volumes.iter().zip(&wanted).enumerate() {
        assert!((volume - mass).abs() <= 1.0001 * options.tolerance * mass, "{name} {i}: {volume}, not {mass}");
        assert!((volume - own[i]).abs() <= 1e-7 * mass, "{name} {i}: {volume}, not {}", own[i]);
    }
    assert!(found.error <= options.tolerance, "{name}");
    assert_eq!(found.weights.iter().copied().fold(f64::INFINITY, f64::min), 0.0, "{name}");
}

/// Checks equal masses, and random ones with a ratio of 1 to 100.
fn check_masses<M: Transported<D, N>, const D: usize, const N: usize>(
    name: &str,
    points: &[[f64; D]],
    clip: Clip<'_, D>,
) where
    Euclidean: VoronoiShapes<D, N>,
{
    check::<M, D, N>(&format!("{name}, equal masses"), points, clip, None);
    let mut random = Pcg64Mcg::seed_from_u64(points.len() as u64);
    let masses: Vec<f64> = points.iter().map(|_| 100f64.powf(random.random())).collect();
    check::<M, D, N>(&format!("{name}, random masses"), points, clip, Some(&masses));
}

/// Checks an input with boxes around the points, and one that most are outside of.
fn check_boxes<M: Transported<D, N>, const D: usize, const N: usize>(inputs: Vec<(&'static str, Vec<[f64; D]>)>)
where
    Euclidean: VoronoiShapes<D, N>,
{
    for (name, points) in inputs {
        let [low, high] = bounds(&points);
        let size = (0..D).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        if !(1e-80..1e80).contains(&size) || points.iter().flatten().any(|x| x.abs() > 1e80) {
            continue;
        }
        let around = [low.map(|x| x - 0.1 * size), high.map(|x| x + 0.2 * size)];
        for bounds in boxes(&points).into_iter().step_by(3).chain([around]) {
            check_masses::<M, D, N>(&format!("{name}, {bounds:?}"), &points, Clip::Box(bounds));
        }
    }
}

#[test]
fn cells_have_the_masses_in_3d() {
    check_boxes::<Mesh3, 3, 4>(inputs3());
}

#[test]
fn cells_have_the_masses_in_2d() {
    check_boxes::<Mesh2, 2, 3>(inputs2());
}

/// The first `count` of uniform points.
fn uniform<const D: usize>(count: usize) -> Vec<[f64; D]> {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    (0..count).map(|_| std::array::from_fn(|_| random.random())).collect()
}

#[test]
fn convex_shapes_and_the_hull_are_divided_as_boxes_are() {
    let polygon = [[0.2, 0.0], [1.0, -0.5], [2.0, 0.5], [0.5, 1.5f64]];
    check_masses::<Mesh2, 2, 3>("polygon", &uniform(300), Clip::Convex(&polygon));
    check_masses::<Mesh2, 2, 3>("polygon far away", &uniform(300), Clip::Convex(&polygon.map(|[x, y]| [x + 9.0, y])));
    check_masses::<Mesh2, 2, 3>("hull", &uniform(300), Clip::Hull);
    let octahedron = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0f64]];
    let octahedron: Vec<_> = octahedron.into_iter().flat_map(|p| [p, p.map(|x| -x)]).collect();
    check_masses::<Mesh3, 3, 4>("octahedron", &uniform(200), Clip::Convex(&octahedron));
    check_masses::<Mesh3, 3, 4>("hull", &uniform(200), Clip::Hull);
}

#[test]
fn points_of_a_plane_or_a_line_divide_what_they_span() {
    let in_plane: Vec<[f64; 3]> = uniform::<2>(50).iter().map(|&[x, y]| [x, 2.0, y]).collect();
    check_masses::<Mesh3, 3, 4>("plane", &in_plane, Clip::Box([[0.0, 2.0, 0.0], [1.0, 2.0, 1.0]]));
    let on_line: Vec<[f64; 2]> = uniform::<1>(50).iter().map(|&[x]| [x, 7.0]).collect();
    check_masses::<Mesh2, 2, 3>("line", &on_line, Clip::Box([[0.0, 7.0], [1.0, 7.0]]));
    check_masses::<Mesh2, 2, 3>("line, outside", &on_line, Clip::Box([[0.3, 7.0], [0.9, 7.0]]));
}

#[test]
fn one_point_has_all_and_none_have_nothing() {
    let clip = Clip::Box([[0.0, 0.0], [2.0, 3.0]]);
    for point in [[1.0, 1.0], [0.0, 3.0], [50.0, -70.0]] {
        let found = Triangulator::new().transport2d(&[point], clip, &Default::default()).unwrap();
        assert_eq!((found.weights, found.volumes, found.steps), (vec![0.0], vec![6.0], 0));
    }
    let found = Triangulator::new().transport2d(&[[0.0; 2]; 0], clip, &Default::default()).unwrap();
    assert_eq!((found.weights.len(), found.volumes.len()), (0, 0));
}

#[test]
fn a_grid_with_equal_masses_has_equal_weights() {
    let grid: Vec<[f64; 3]> = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(|x| f64::from(x) + 0.5)).collect();
    let found = Triangulator::new().transport3d(&grid, Clip::Box([[0.0; 3], [4.0; 3]]), &Default::default()).unwrap();
    assert_eq!((found.weights, found.steps), (vec![0.0; 64], 0));
}

/// The intervals of points on a line end where the sums of masses do, whatever their places: with that the weights
/// follow one from the other.
#[test]
fn weights_on_a_line_are_those_that_can_be_found_by_hand() {
    let (xs, masses) = ([0.1, 0.15, 0.7, 0.9], [0.4, 0.1, 0.3, 0.2]);
    let mut options = TransportOptions::default();
    options.masses = Some(&masses);
    options.tolerance = 1e-12;
    let points = xs.map(|x| [x, 0.5]);
    let found = Triangulator::new().transport2d(&points, Clip::Box([[0.0; 2], [1.0; 2]]), &options).unwrap();
    let mut end = 0.0;
    for i in 0..3 {
        end += masses[i];
        let square = |x: f64| (end - x) * (end - x);
        let difference = square(xs[i + 1]) - square(xs[i]);
        let own = found.weights[i + 1] - found.weights[i];
        assert!((own - difference).abs() < 1e-10, "{i}: {own}, not {difference}");
    }
}

#[test]
fn any_number_of_threads_finds_the_same_weights() {
    // So many that several threads insert them, and that sums have several blocks.
    let points = uniform::<3>(20_000);
    let solve = |threads| {
        let triangulator = Triangulator::new().backend(Backend::Cpu).threads(NonZeroUsize::new(threads).unwrap());
        triangulator.transport3d(&points, Clip::Box([[0.0; 3], [1.0; 3]]), &Default::default()).unwrap()
    };
    let one = solve(1);
    assert!(one.steps > 0);
    for threads in [2, 5] {
        assert!(solve(threads) == one, "{threads} threads");
    }
}

#[test]
fn a_run_reports_and_can_be_cancelled_at_any_time() {
    let points = uniform::<2>(200);
    let clip = Clip::Box([[0.0; 2], [1.0; 2]]);
    let run = |limit: usize| {
        let reports = Arc::new((AtomicUsize::new(0), AtomicUsize::new(0)));
        let counted = Arc::clone(&reports);
        let triangulator = Triangulator::new().on_progress(move |progress| {
            assert_eq!(progress.phase, Phase::Transport);
            // It never decreases.
            let thousandths = (1000.0 * progress.fraction) as usize;
            assert!(thousandths <= 1000 && counted.1.fetch_max(thousandths, Ordering::Relaxed) <= thousandths);
            let count = counted.0.fetch_add(1, Ordering::Relaxed) + 1;
            if count < limit { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        let result = triangulator.transport2d(&points, clip, &Default::default());
        (result, reports.0.load(Ordering::Relaxed), reports.1.load(Ordering::Relaxed))
    };
    let (result, reports, last) = run(usize::MAX);
    assert_eq!(last, 1000);
    assert!(reports > 20, "{reports}");
    for limit in [1, 2, 3, reports / 2, reports] {
        assert_eq!(run(limit).0.unwrap_err(), Error::Cancelled, "{limit}");
    }
    assert_eq!(run(usize::MAX).0.unwrap(), result.unwrap());
}

#[test]
fn bad_masses_and_options_are_errors() {
    let points = uniform::<2>(3);
    let clip = Clip::Box([[0.0; 2], [1.0; 2]]);
    let error = |points: &[[f64; 2]], clip, options: &TransportOptions<'_>| {
        Triangulator::new().transport2d(points, clip, options).unwrap_err()
    };
    assert_eq!(error(&points, clip, &with_masses(&[0.5, 0.5])), Error::ValueCount { values: 2, points: 3 });
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(error(&points, clip, &with_masses(&[0.5, bad, 0.5])), Error::BadMass { index: 1 });
    }
    let sum = Error::MassSum { masses: "2.0".to_owned(), volume: "1.0".to_owned() };
    assert_eq!(error(&points, clip, &with_masses(&[0.5, 0.5, 1.0])), sum);
    Triangulator::new().transport2d(&points, clip, &with_masses(&[0.2, 0.3, 0.5])).unwrap();
    let is_bad_option = |error| matches!(error, Error::BadOption { .. });
    let default = TransportOptions::default();
    assert!(is_bad_option(error(&points, Clip::None, &default)));
    for tolerance in [0.0, 1.0, -1.0, f64::NAN] {
        let mut options = default;
        options.tolerance = tolerance;
        assert!(is_bad_option(error(&points, clip, &options)));
    }
    assert!(is_bad_option(error(&[[1e100, 0.0]], clip, &default)));
    assert!(is_bad_option(error(&points, Clip::Box([[0.0; 2], [1e-100; 2]]), &default)));
    assert_eq!(error(&points, Clip::Box([[0.0; 2], [1.0, 0.0]]), &default), Error::EmptyBox { axis: 'y' });
    assert!(matches!(error(&[[f64::NAN, 0.0]], clip, &default), Error::NotFinite { .. }));
    // More exact than numbers are.
    let mut options = default;
    options.tolerance = 1e-300;
    let Error::TransportStopped { error: reached } = error(&points, clip, &options) else { panic!("it stopped") };
    assert!(reached.parse::<f64>().unwrap() < 1e-12, "{reached}");
}

#[test]
fn sites_by_halves_are_few_steps_from_the_areas() {
    let polygon: Vec<[f64; 2]> =
        (0..7).map(|i| (f64::from(i) * std::f64::consts::TAU / 7.0).sin_cos()).map(|(y, x)| [1e3 + x, y]).collect();
    let backwards: Vec<[f64; 2]> = polygon.iter().rev().copied().collect();
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let masses: Vec<f64> = (0..500).map(|_| 100f64.powf(random.random())).collect();
    let sum: f64 = masses.iter().sum();
    for corners in [&polygon, &backwards] {
        let sites = sites_by_halves(corners, &masses);
        assert_eq!(sites, sites_by_halves(corners, &masses));
        let mesh = gdel::delaunay2d(&sites).unwrap();
        let areas = Voronoi::new(&mesh, &sites, Clip::Convex(corners)).unwrap().volumes();
        let area: f64 = areas.iter().sum();
        let wrong = |ratios: &mut dyn Iterator<Item = f64>| ratios.map(|ratio| ratio.ln().abs()).sum::<f64>() / 500.0;
        let own = wrong(&mut areas.iter().zip(&masses).map(|(own, mass)| own / area / (mass / sum)));
        let equal = wrong(&mut masses.iter().map(|mass| 500.0 * mass / sum));
        assert!(own < 0.75 * equal, "{own} {equal}");
        // From random sites, they are ten.
        let found = Triangulator::new().transport2d(&sites, Clip::Convex(corners), &normalized(Some(&masses))).unwrap();
        assert!(found.steps <= 7, "{}", found.steps);
    }
}

#[test]
fn sites_by_halves_of_few_and_strange_masses_are_inside() {
    let square = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0f64]];
    assert!(sites_by_halves(&square, &[]).is_empty());
    assert_eq!(sites_by_halves(&square, &[7.0]), [[0.5, 0.5]]);
    for masses in [vec![1.0, 1e-300, 1.0], vec![1e300; 9], vec![1e-18, 1.0, 1e-18, 1e18], vec![1.0; 64]] {
        let sites = sites_by_halves(&square, &masses);
        assert!(sites.iter().flatten().all(|x| (0.0..=1.0).contains(x)), "{masses:?}: {sites:?}");
    }
    // Without an inside, all are somewhere on it.
    let flat = [[0.0, 0.0], [1.0, 1.0], [0.5, 0.5f64]];
    assert!(sites_by_halves(&flat, &[1.0, 2.0, 3.0]).iter().all(|[x, y]| (x - y).abs() < 1e-12));
    assert_eq!(sites_by_halves(&[], &[1.0]), [[0.0, 0.0]]);
}
