//! Terrain: all points are as near to the surface as was asked for, its mesh is the constrained Delaunay triangulation of
//! its vertices, and these are chosen greedily.

use crate::degenerate::{cases, points as any_points};
use gdel::{
    Backend, Constrained2, Constraints, Error, Fill, MeshView2, NONE, Tin, TinOptions, TinStats, Triangulator,
    orient2d, stats::Phase, verify2d,
};
use rand::RngExt;
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};
use std::{
    num::NonZeroUsize,
    ops::ControlFlow,
    sync::{Arc, Mutex},
};

type Place = [f64; 2];
type Point = [f64; 3];

fn place([x, y, _]: Point) -> Place {
    [x, y]
}

fn options(max_error: f64) -> TinOptions {
    let mut options = TinOptions::default();
    options.max_error = max_error;
    options
}

fn of_threads(threads: usize) -> Triangulator {
    Triangulator::new().backend(Backend::Cpu).threads(NonZeroUsize::new(threads).unwrap())
}

/// Returns the height of a triangle at a place: by shares of its area, which need not be exact.
fn height([a, b, c]: [Point; 3], p: Place) -> f64 {
    let area = |[ax, ay]: Place, [bx, by]: Place| {
        let ([ax, ay], [bx, by]) = ([ax - p[0], ay - p[1]], [bx - p[0], by - p[1]]);
        ax * by - ay * bx
    };
    let shares = [area(place(b), place(c)), area(place(c), place(a)), area(place(a), place(b))];
    let sum: f64 = shares.iter().sum();
    let share = |k: usize| shares[k] / sum;
    a[2] + share(1) * (b[2] - a[2]) + share(2) * (c[2] - a[2])
}

fn contains(corners: [Point; 3], p: Place) -> bool {
    let [a, b, c] = corners.map(place);
    [(a, b), (b, c), (c, a)].iter().all(|&(a, b)| orient2d(a, b, p) >= 0)
}

/// Returns whether a point counts, by the definition.
fn counts(points: &[Point], segments: &[[u32; 2]], i: usize) -> bool {
    let is_end = |i: usize| segments.iter().flatten().any(|&v| v as usize == i);
    let key = |i: usize| (!is_end(i), points[i][2], i);
    (0..points.len()).filter(|&j| place(points[j]) == place(points[i])).all(|j| key(i) <= key(j))
}

/// Returns the largest error of the points that count, and how many are in triangles inside.
fn largest_error(points: &[Point], segments: &[[u32; 2]], vertices: &[Point], found: &Constrained2) -> (f64, usize) {
    let (mut largest, mut inside) = (0.0f64, 0);
    for i in (0..points.len()).filter(|&i| counts(points, segments, i)) {
        let corners = found.inside_triangles().map(|t| t.map(|v| vertices[v as usize]));
        let errors = corners
            .filter(|&corners| contains(corners, place(points[i])))
            .map(|corners| (points[i][2] - height(corners, place(points[i]))).abs());
        if let Some(error) = errors.reduce(f64::max) {
            largest = largest.max(error);
            inside += 1;
        }
    }
    (largest, inside)
}

/// Makes terrain, and checks all that is promised of it.
fn tin(points: &[Point], constraints: &Constraints, options: &TinOptions) -> Tin {
    let found = of_threads(1).tin(points, constraints, options).unwrap();
    let context = || format!("{points:?}, {constraints:?}, {options:?}");
    let Tin { constrained, vertices, sources, max_error, stats, .. } = &found;
    let seen: Vec<Place> = vertices.iter().map(|&p| place(p)).collect();
    let mut view = MeshView2::from(&constrained.mesh);
    view.segments = Some(&constrained.segments);
    let report = verify2d(&seen, view).unwrap();
    assert!(report.passed(), "{report}\n{}", context());
    assert_eq!(constrained.inside.len(), constrained.mesh.triangles.len());

    // The vertices are points that count; the given ends of segments and the corners of the hull come first.
    let segments = constraints.segments();
    for (&vertex, &source) in vertices.iter().zip(sources).filter(|&(_, &source)| source != NONE) {
        assert_eq!(vertex, points[source as usize], "{}", context());
        assert!(counts(points, &segments, source as usize), "{}", context());
    }
    assert!(sources[..stats.start].is_sorted() && (stats.start..sources.len()).all(|v| sources[v] != NONE));
    let distinct = (0..points.len()).filter(|&i| counts(points, &segments, i)).count();
    assert_eq!(stats.duplicates, points.len() - distinct, "{}", context());
    assert_eq!(constrained.added.len(), sources.iter().filter(|&&source| source == NONE).count());

    // All points are near.
    let (largest, inside) = largest_error(points, &segments, vertices, constrained);
    let heights = || points.iter().map(|p| p[2]);
    let slack = 1e-7 * (heights().fold(0.0, f64::max) - heights().fold(0.0, f64::min));
    assert!((largest - max_error).abs() <= slack, "{largest}, {max_error}, {}", context());
    assert!(stats.limited || *max_error <= options.max_error, "{max_error}, {}", context());
    if constrained.mesh.dimension == 2 {
        assert_eq!(stats.outside, distinct - inside, "{}", context());
        assert!(stats.limited || constrained.added.is_empty() || *max_error <= options.max_error);
    }
    if let Some(most) = options.max_points {
        assert!(vertices.len() <= most.max(stats.start), "{}", context());
        assert!(!stats.limited || vertices.len() == most.max(stats.start), "{}", context());
    }

    // It does not depend on threads.
    let other = of_threads(3).tin(points, constraints, options).unwrap();
    assert_eq!((other.sources, other.stats), (sources.clone(), *stats), "{}", context());
    assert_eq!(other.constrained.mesh.triangles, constrained.mesh.triangles);
    found
}

/// Returns hills with noise: on a grid, or anywhere.
fn hills(random: &mut Pcg64Mcg, count: usize, on_grid: bool) -> Vec<Point> {
    let side = (count as f64).sqrt().ceil();
    let coordinate = |random: &mut Pcg64Mcg| match on_grid {
        true => (random.random::<f64>() * side).floor(),
        false => random.random::<f64>() * side,
    };
    let mut points = Vec::new();
    for _ in 0..count {
        let [x, y] = [0, 1].map(|_| coordinate(random));
        points.push([x, y, 3.0 * (x / 5.0).sin() * (y / 7.0).cos() + 0.1 * random.random::<f64>()]);
    }
    points
}

/// Returns random segments between points that do not cross.
fn free_segments(points: &[Point], count: usize, random: &mut Pcg64Mcg) -> Vec<[u32; 2]> {
    let seen: Vec<Place> = points.iter().map(|&p| place(p)).collect();
    let mut kept: Vec<[u32; 2]> = Vec::new();
    for _ in 0..if points.is_empty() { 0 } else { count } {
        kept.push([0, 1].map(|_| random.random_range(0..points.len() as u32)));
        if of_threads(1).constrained2d(&seen, &Constraints::new().edges(&kept)).is_err() {
            kept.pop();
        }
    }
    kept
}

#[test]
fn hills_with_and_without_breaklines() {
    for seed in cases(60) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let count = random.random_range(3..300);
        let on_grid = random.random();
        let points = hills(random, count, on_grid);
        let segments = free_segments(&points, random.random_range(0..6), random);
        let constraints = Constraints::new().edges(&segments);
        let max_error = [0.0, 0.05, 0.3, 2.0][random.random_range(0..4)];
        tin(&points, &constraints, &options(max_error));
        let mut few = options(max_error);
        few.max_points = Some(random.random_range(0..count));
        tin(&points, &constraints, &few);
    }
}

/// Ties, duplicates, points on one line, and numbers of all sizes.
#[test]
fn degenerate_points() {
    for seed in cases(400) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let mut points: Vec<Point> = any_points(random, 40);
        if random.random() {
            points.iter_mut().for_each(|p| p[2] = f64::from(random.random_range(0..4)));
        }
        let segments = free_segments(&points, random.random_range(0..5), random);
        let fill = if random.random() { Fill::All } else { Fill::Enclosed };
        let constraints = Constraints::new().edges(&segments).fill(fill);
        let max_error = if random.random() { 0.0 } else { 1.5 };
        let found = of_threads(1).tin(&points, &constraints, &options(max_error)).unwrap();
        assert!(found.max_error <= max_error, "{points:?}, {segments:?}");
        let sizes = || points.as_flattened().iter().map(|x| x.abs()).filter(|&x| x > 0.0);
        if sizes().all(|x| (1e-60..1e60).contains(&x)) {
            tin(&points, &constraints, &options(max_error));
        }
    }
}

/// Each vertex is the point that was farthest from the surface over those before it.
#[test]
fn the_farthest_point_comes_first() {
    for seed in cases(40) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let count = random.random_range(10..60);
        let on_grid = random.random();
        let points = hills(random, count, on_grid);
        let segments = free_segments(&points, 2, random);
        let found = tin(&points, &Constraints::new().edges(&segments), &options(0.0));
        for k in found.stats.start..found.vertices.len() {
            let before = &found.vertices[..k];
            let seen: Vec<Place> = before.iter().map(|&p| place(p)).collect();
            let constraints = Constraints::new().edges(&found.constrained.segments);
            let mesh = of_threads(1).constrained2d(&seen, &constraints).unwrap();
            let (largest, _) = largest_error(&points, &segments, before, &mesh);
            let (own, _) = largest_error(&found.vertices[k..=k], &[], before, &mesh);
            assert!((largest - own).abs() < 1e-9, "{k}: {largest}, {own}, {points:?}, {segments:?}");
        }
    }
}

#[test]
fn a_grid_with_one_peak() {
    // A raster: flat, but for one cell, which takes its neighbours with it.
    let mut points: Vec<Point> = (0..400).map(|i| [f64::from(i % 20), f64::from(i / 20), 7.0]).collect();
    let flat = tin(&points, &Constraints::new(), &options(0.0));
    assert_eq!((flat.sources.as_slice(), flat.max_error), (&[0, 19, 380, 399][..], 0.0));
    points[8 * 20 + 8][2] = 9.0;
    assert_eq!(tin(&points, &Constraints::new(), &options(2.0)).sources.len(), 4);
    let found = tin(&points, &Constraints::new(), &options(0.5));
    assert_eq!(found.sources[4], 168);
    assert!(found.sources.len() < 20, "{:?}", found.sources);
}

#[test]
fn too_few_points_and_points_on_a_line() {
    for points in [vec![], vec![[1.0, 2.0, 3.0]], vec![[0.0; 3], [1.0, 0.0, 5.0]], vec![[0.0; 3]; 4]] {
        let found = tin(&points, &Constraints::new(), &options(0.0));
        assert_eq!((found.triangles().count(), found.max_error), (0, 0.0));
    }
    let line: Vec<Point> = (0..9).map(|i| [f64::from(i), f64::from(2 * i), f64::from(i * i)]).collect();
    let found = tin(&line, &Constraints::new().edges(&[[3, 1]]), &options(0.0));
    assert_eq!((found.triangles().count(), found.sources.as_slice()), (0, &[0, 1, 3, 8][..]));
}

/// The lowest of several points at a place counts, but an end of a segment before all others.
#[test]
fn points_above_each_other() {
    let mut points = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
    points.extend([[1.0, 2.0, 9.0], [1.0, 2.0, 5.0], [1.0, 2.0, 5.0], [3.0, 2.0, 1.0], [3.0, 2.0, 6.0]]);
    let found = tin(&points, &Constraints::new(), &options(0.0));
    assert_eq!(found.sources, [0, 1, 2, 3, 5, 7]);
    let stats = found.stats;
    assert_eq!((stats.start, stats.duplicates, stats.other_heights), (4, 3, 2));
    let found = tin(&points, &Constraints::new().edges(&[[4, 8], [6, 5]]), &options(0.0));
    // Two ends at one place: the lower one.
    assert_eq!(found.sources, [0, 1, 2, 3, 5, 8]);
    assert_eq!((found.constrained.segments.as_slice(), found.constrained.zero_length), (&[[4, 5], [4, 4]][..], 1));
}

#[test]
fn points_outside_do_not_count() {
    // A square frame around a hole, in which there is a tower; and one beside it.
    let ring = |low: f64, high: f64| [[low, low, 0.0], [high, low, 0.0], [high, high, 0.0], [low, high, 0.0]];
    let mut points = [ring(0.0, 9.0), ring(3.0, 6.0)].concat();
    points.extend([[4.5, 4.5, 100.0], [20.0, 4.5, 50.0], [1.0, 4.5, 1.0], [4.5, 3.0, 2.0], [9.0, 2.0, 3.0]]);
    let constraints = Constraints::new().ring(&[0, 1, 2, 3]).ring(&[4, 5, 6, 7]).fill(Fill::EvenOdd);
    let found = tin(&points, &constraints, &options(0.5));
    // The outer point is a corner of the hull; those on the boundary count.
    let mut sources = found.sources.clone();
    sources.sort_unstable();
    assert_eq!(sources, [0, 1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12]);
    assert_eq!((found.stats.outside, found.max_error), (2, 0.0));
    let all = tin(&points, &Constraints::new(), &options(0.5));
    assert!(all.sources.contains(&8));
}

#[test]
fn breaklines_that_cross() {
    let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 8.0], [4.0, 4.0, 4.0], [0.0, 4.0, 0.0f64]];
    let crossing = Constraints::new().edges(&[[3, 1], [0, 2]]);
    let error = of_threads(1).tin(&points, &crossing, &options(0.0)).unwrap_err();
    assert_eq!(error, Error::CrossingConstraints { count: 1, pairs: vec![[[3, 1], [0, 2]]] });
    // The mean of 4 and 2.
    let found = tin(&points, &crossing.clone().split_crossings(), &options(0.0));
    assert_eq!((found.vertices[4], found.sources[4]), ([2.0, 2.0, 3.0], NONE));
    assert_eq!(found.triangles().count(), 4);
    // A point that is there says how high it is.
    let points = [&points[..], &[[2.0, 2.0, 77.0], [1.0, 2.0, 0.5], [2.0, 2.0, 78.0]]].concat();
    let found = tin(&points, &crossing.split_crossings(), &options(0.0));
    assert_eq!((found.vertices[4], found.stats.other_heights), ([2.0, 2.0, 77.0], 1));
}

/// A breakline along a row of a raster leads through its points, which may become vertices and cut it.
#[test]
fn breaklines_through_points() {
    let points: Vec<Point> =
        (0..121).map(|i| (i % 11, i / 11)).map(|(x, y)| [x, y, (x * 7 + y * y) % 5].map(f64::from)).collect();
    let segments = [[11, 21], [0, 120], [5, 65]];
    let found = tin(&points, &Constraints::new().edges(&segments), &options(0.5));
    let mesh = &found.constrained.mesh;
    assert!(mesh.constraints.len() > 20, "{:?}", mesh.constraints);
    let on = |[a, b]: [u32; 2], v: u32| {
        let [a, b, v] = [points[a as usize], points[b as usize], found.vertices[v as usize]].map(place);
        orient2d(a, b, v) == 0
    };
    assert!(mesh.constraints.iter().all(|&[a, b]| segments.iter().any(|&segment| on(segment, a) && on(segment, b))));
}

#[test]
fn wrong_input() {
    let mut points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, f64::NAN]];
    let none = Constraints::new();
    let wrong = |points: &[Point], constraints: &Constraints, max_error| {
        of_threads(1).tin(points, constraints, &options(max_error)).unwrap_err()
    };
    assert_eq!(wrong(&points, &none, 0.0), Error::NotFinite { index: 2, axis: 'z', value: "NaN" });
    points[2][2] = 1.0;
    for bad in [-1.0, f64::NAN] {
        let error = wrong(&points, &none, bad);
        assert_eq!(error, Error::BadOption { option: "the largest error", range: "a number from 0 on" });
    }
    let error = wrong(&points, &Constraints::new().edges(&[[0, 3]]), 0.0);
    assert_eq!(error, Error::BadConstraint { segment: [0, 3], points: 3 });
    // Point 3 is point 1.
    points.push([1.0, 0.0, -4.0]);
    let error = wrong(&points, &Constraints::new().boundary(&[[1, 2]]).fill(Fill::EvenOdd), 0.0);
    assert_eq!(error, Error::OpenBoundary { point: 1 });
    assert_eq!(of_threads(1).tin(&points, &none, &options(f64::INFINITY)).unwrap().stats, {
        let mut stats = TinStats::default();
        (stats.start, stats.duplicates, stats.other_heights) = (3, 1, 1);
        stats
    });
}

#[test]
fn progress_and_cancellation() {
    let points = hills(&mut Pcg64Mcg::seed_from_u64(1), 3000, false);
    let seen = Arc::new(Mutex::new(Vec::new()));
    let reports = Arc::clone(&seen);
    let triangulator = of_threads(1).on_progress(move |progress| {
        assert_eq!(progress.phase, Phase::Tin);
        reports.lock().unwrap().push(progress.fraction);
        ControlFlow::Continue(())
    });
    triangulator.tin(&points, &Constraints::new(), &options(0.0)).unwrap();
    let seen = seen.lock().unwrap();
    assert!(seen.len() > 10 && seen.is_sorted() && seen.iter().all(|x| (0.0..=1.0).contains(x)), "{seen:?}");
    let triangulator = of_threads(1).on_progress(|_| ControlFlow::Break(()));
    let error = triangulator.tin(&points, &Constraints::new(), &options(0.0)).unwrap_err();
    assert_eq!(error, Error::Cancelled);
}
