//! Refined meshes are the constrained Delaunay triangulations of their points and pieces, have the shapes that were asked
//! for, and refinement ends.

use crate::degenerate::{cases, points as any_points};
use gdel::{
    Backend, Constrained2, Constraints, Error, Fill, MeshView2, NONE, RefineLeft, RefineOptions, RefineStats, Refined2,
    Size, Triangulator, verify2d,
};
use gdel_io::{ShapeFormat, files::read_shapes};
use rand::{RngExt, seq::SliceRandom};
use rand_pcg::{Pcg64Mcg, rand_core::SeedableRng};
use std::{num::NonZeroUsize, path::Path};

type Point = [f64; 2];
type Segment = [u32; 2];

/// No input of these tests needs as many points.
const MANY: usize = 300_000;

fn constrained(points: &[Point], constraints: &Constraints) -> Result<Constrained2, Error> {
    Triangulator::new().backend(Backend::Cpu).threads(NonZeroUsize::MIN).constrained2d(points, constraints)
}

fn options<'a>(min_angle: f64) -> RefineOptions<'a> {
    let mut options = RefineOptions::default();
    options.min_angle = min_angle;
    options.max_points = Some(MANY);
    options
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn length(a: Point, b: Point) -> f64 {
    let ab = minus(b, a);
    ab[0].hypot(ab[1])
}

/// Returns the points with a power of two as largest coordinate, so that products are numbers.
fn moderate(points: &[Point]) -> Vec<Point> {
    let largest = points.as_flattened().iter().fold(f64::MIN_POSITIVE, |largest, x| largest.max(x.abs()));
    let exponent = -(largest.log2() as i32).clamp(-1000, 1000);
    let half = exponent / 2;
    points.iter().map(|p| p.map(|x| x * 2f64.powi(half) * 2f64.powi(exponent - half))).collect()
}

fn smallest_angle([a, b, c]: [Point; 3]) -> f64 {
    let angle = |a, b, c| cross(minus(b, a), minus(c, a)).abs().atan2(dot(minus(b, a), minus(c, a)));
    [angle(a, b, c), angle(b, c, a), angle(c, a, b)].into_iter().fold(f64::INFINITY, f64::min).to_degrees()
}

fn area(points: &[Point], found: &Constrained2) -> f64 {
    found
        .inside_triangles()
        .map(|t| t.map(|v| points[v as usize]))
        .map(|[a, b, c]| cross(minus(b, a), minus(c, a)) / 2.0)
        .sum()
}

/// Returns the same mesh with its triangles in another order, and turned.
fn shuffled(found: &Constrained2, random: &mut Pcg64Mcg) -> Constrained2 {
    let mut other = found.clone();
    let mut order: Vec<usize> = (0..found.mesh.triangles.len()).collect();
    order.shuffle(random);
    let turns: Vec<u32> = order.iter().map(|_| random.random_range(0..3)).collect();
    let mut places = vec![0; order.len()];
    order.iter().enumerate().for_each(|(place, &t)| places[t] = place);
    let moved = |e: u32| match e {
        NONE => NONE,
        e => {
            let place = places[e as usize / 3];
            3 * place as u32 + (e % 3 + 3 - turns[place]) % 3
        }
    };
    for (place, &t) in order.iter().enumerate() {
        let (mut triangle, mut across) = (found.mesh.triangles[t], found.mesh.halfedges[t].map(moved));
        triangle.rotate_left(turns[place] as usize);
        across.rotate_left(turns[place] as usize);
        (other.mesh.triangles[place], other.mesh.halfedges[place], other.inside[place]) =
            (triangle, across, found.inside[t]);
    }
    other
}

/// Refines a mesh and checks all that is promised. `points` are those that it was made of.
fn refine(points: &[Point], found: &Constrained2, options: &RefineOptions<'_>) -> Refined2 {
    let refined = found.refine(points, options).unwrap();
    let RefineStats { points_on_segments, points_inside, min_angle, left, limited, .. } = refined.stats;
    let result = &refined.constrained;
    let all = [points, &result.added].concat();
    let context = || format!("{points:?}, {:?}, {options:?}", found.segments);
    assert_eq!(result.added[..found.added.len()], found.added, "{}", context());
    assert_eq!(result.added.len() - found.added.len(), points_on_segments + points_inside, "{}", context());

    if found.mesh.triangles.is_empty() {
        assert_eq!(result.segments, found.segments);
        return refined;
    }

    // The mesh is that of the points and pieces.
    let mut view = MeshView2::from(&result.mesh);
    view.segments = Some(&result.segments);
    let report = verify2d(&all, view).unwrap();
    assert!(report.passed(), "{report}\n{}", context());
    assert_eq!(result.inside.len(), result.mesh.triangles.len());
    // The hull of the points stays the hull.
    let is_given = |v: &&u32| (**v as usize) < points.len() + found.added.len();
    assert_eq!(
        result.mesh.hull.iter().filter(is_given).collect::<Vec<_>>(),
        found.mesh.hull.iter().collect::<Vec<_>>()
    );

    // The pieces of each segment are a chain from one end to the other, near the segment.
    let near = moderate(&all);
    let mut pieces = result.segments.iter().zip(&refined.segment_of).peekable();
    for (i, segment) in (0..).zip(&found.segments) {
        let [from, to] = segment.map(|v| found.mesh.representative(v));
        let mut at = from;
        while let Some((&[start, end], _)) = pieces.next_if(|&(_, &of)| of == i) {
            assert_eq!(start, at, "{}", context());
            at = end;
            let [a, b, p] = [from, to, end].map(|v| near[v as usize]);
            let height = (cross(minus(b, a), minus(p, a)) / length(a, b)).abs();
            let unit = near.as_flattened().iter().fold(0.0f64, |largest, x| largest.max(x.abs())) * f64::EPSILON;
            assert!(height.is_nan() || height <= 64.0 * unit, "{height} of {unit}, {}", context());
        }
        assert_eq!(at, to, "{}", context());
    }
    assert!(pieces.all(|(_, &of)| of == NONE), "{}", context());

    // What is inside stays inside.
    let (before, after) = (area(&near, found), area(&near, result));
    let rounding = 1e-15 * (1000 + result.inside.len()) as f64;
    assert!((before - after).abs() <= rounding * before.max(1.0), "{before}, {after}, {}", context());

    // No angle is too small, but those that are counted. Those that are just as large as the bound may be on either side.
    let angles = || result.inside_triangles().map(|t| smallest_angle(t.map(|v| near[v as usize])));
    let is_left = left.input_angle + left.resolution + left.limit;
    let small = |bound: f64| angles().filter(|&angle| angle < bound).count();
    assert!(
        small(options.min_angle - 1e-6) <= is_left && is_left <= small(options.min_angle + 1e-6),
        "{left:?}, {}",
        context()
    );
    let smallest = angles().reduce(f64::min).unwrap_or(0.0);
    assert!((smallest - min_angle).abs() < 1e-3, "{smallest}, {min_angle}, {}", context());
    assert!(!(limited && options.max_points == Some(MANY)), "{}", context());
    assert!(limited || left.limit == 0);

    // It depends neither on the order of the triangles nor on chance.
    let random = &mut Pcg64Mcg::seed_from_u64(1);
    let again = shuffled(found, random).refine(points, options).unwrap();
    assert_eq!(again.constrained.added, result.added, "{}", context());
    assert_eq!(again.constrained.mesh.canonical(), result.mesh.canonical(), "{}", context());
    assert_eq!((again.stats, again.constrained.segments), (refined.stats, result.segments.clone()), "{}", context());
    refined
}

fn refine_all(points: &[Point], constraints: &Constraints, options: &RefineOptions<'_>) -> Refined2 {
    let found = constrained(points, constraints).unwrap();
    refine(points, &found, options)
}

/// Returns random segments that do not cross.
fn free_segments(points: &[Point], count: usize, random: &mut Pcg64Mcg) -> Vec<Segment> {
    let mut kept: Vec<Segment> = Vec::new();
    for _ in 0..count {
        kept.push([0, 1].map(|_| random.random_range(0..points.len() as u32)));
        if constrained(points, &Constraints::new().edges(&kept)).is_err() {
            kept.pop();
        }
    }
    kept
}

/// Small integers, thousandths, and numbers with all digits.
#[test]
fn random_segments() {
    let mut left = 0;
    for seed in cases(400) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let kind = random.random_range(0..3);
        let count = random.random_range(3..14);
        let coordinate = |random: &mut Pcg64Mcg| match kind {
            0 => f64::from(random.random_range(0..6)),
            1 => f64::from(random.random_range(0..1000)) / 1000.0,
            _ => random.random::<f64>(),
        };
        let points: Vec<Point> = (0..count).map(|_| [0, 1].map(|_| coordinate(random))).collect();
        let segments = free_segments(&points, random.random_range(0..8), random);
        let fill = if random.random() { Fill::All } else { Fill::Enclosed };
        let constraints = Constraints::new().edges(&segments).fill(fill);
        let min_angle = [0.0, 15.0, 20.0, 25.0, 30.0][random.random_range(0..5)];
        let mut options = options(min_angle);
        let size = random.random_range(0.2..3.0) * if kind == 0 { 1.0 } else { 0.2 };
        match random.random_range(0..4) {
            0 => options.max_area = Some(size * size),
            1 => options.size = Size::Uniform(size),
            _ => {}
        }
        let refined = refine_all(&points, &constraints, &options);
        left += refined.stats.left.resolution;
        assert_eq!(refined.stats.left.too_large, 0, "{points:?}, {segments:?}");
    }
    assert_eq!(left, 0);
}

/// Coordinates of all sizes, ties, and nearly collinear points.
#[test]
fn degenerate_clouds() {
    for seed in cases(300) {
        let random = &mut Pcg64Mcg::seed_from_u64(seed);
        let points = any_points::<2>(random, 12);
        if points.is_empty() {
            continue;
        }
        let segments = free_segments(&points, random.random_range(0..6), random);
        let constraints = Constraints::new().edges(&segments);
        let mut options = options([20.0, 30.0][random.random_range(0..2)]);
        // Where segments almost coincide, the number of points has no bound.
        options.max_points = Some(1000);
        refine_all(&points, &constraints, &options);
    }
}

/// Segments from a point in all directions, with the angle between them, and lengths that differ.
fn star(degrees: f64, length: impl Fn(usize) -> f64) -> (Vec<Point>, Vec<Segment>) {
    let count = (360.0 / degrees) as u32;
    let mut points = vec![[0.0, 0.0]];
    for i in 0..count {
        let (sine, cosine) = (f64::from(i) * degrees).to_radians().sin_cos();
        let length = length(i as usize);
        points.push([length * cosine, length * sine]);
    }
    (points, (1..=count).map(|i| [0, i]).collect())
}

#[test]
fn stars_of_small_angles() {
    for degrees in [1.0, 3.0, 10.0, 25.0, 45.0, 59.0, 61.0] {
        for lengths in [|_: usize| 1.0, |i: usize| 1.0 + 0.37 * (i % 5) as f64, |i: usize| 1.0 + (i * i % 11) as f64] {
            let (mut points, segments) = star(degrees, lengths);
            refine_all(&points, &Constraints::new().edges(&segments), &options(30.0));
            let first = points.len() as u32;
            points.extend([[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]]);
            let frame = [0, 1, 2, 3].map(|i| [first + i, first + (i + 1) % 4]);
            let refined = refine_all(&points, &Constraints::new().edges(&segments).edges(&frame), &options(30.0));
            assert_eq!(refined.stats.left.resolution, 0);
            assert!(degrees < 60.0 || refined.stats.left.input_angle == 0, "{degrees}");
        }
    }
}

#[test]
fn wedges_of_tiny_angles() {
    for height in [1e-1, 1e-2, 1e-4, 1e-8, 1e-12, 1e-17] {
        let mut options = options(30.0);
        // Of the last ones, only the beginning: they need as many points as coordinates can tell apart.
        options.max_points = Some(if height < 1e-5 { 1000 } else { MANY });
        let points = [[0.0, 0.0], [1.0, 0.0], [0.9, height], [3.0, -2.0], [3.0, 2.0], [-2.0, 1.0]];
        refine_all(&points, &Constraints::new().edges(&[[0, 1], [0, 2]]), &options);
        refine_all(&points, &Constraints::new().ring(&[0, 1, 2]).fill(Fill::EvenOdd), &options);
    }
}

#[test]
fn segments_that_almost_touch() {
    for gap in [1e-1, 1e-2, 1e-3] {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.1, gap], [0.9, 2.0 * gap], [0.5, -gap], [0.5, -1.0]];
        let refined = refine_all(&points, &Constraints::new().edges(&[[0, 1], [2, 3], [4, 5]]), &options(25.0));
        assert_eq!(refined.stats.left.resolution, 0);
    }
}

#[test]
fn polygons_that_touch() {
    let points =
        [[0.0, 0.0], [4.0, 0.0], [2.0, 3.0], [4.0, 6.0], [0.0, 6.0], [2.0, 1.0], [3.0, 1.0], [1.5, 4.0], [2.5, 4.0]];
    let rings =
        Constraints::new().ring(&[0, 1, 2]).ring(&[2, 3, 4]).ring(&[0, 5, 6]).ring(&[2, 8, 7]).fill(Fill::EvenOdd);
    refine_all(&points, &rings, &options(30.0));
}

#[test]
fn duplicates_and_points_on_segments() {
    let mut points: Vec<Point> = (0..9).map(|i| [f64::from(i) / 8.0, f64::from(i) / 4.0]).collect();
    points.extend([[0.0, 0.0], [1.0, 2.0], [3.0, 0.1], [2.5, -1.0], [1.0, 2.0]]);
    let constraints = Constraints::new().edges(&[[9, 10], [0, 13], [11, 11], [8, 12], [12, 11], [10, 0]]);
    let refined = refine_all(&points, &constraints, &options(30.0));
    assert_eq!(refined.constrained.zero_length, 1);
}

#[test]
fn without_constraints_the_hull_is_the_boundary() {
    let points = [[0.1, 0.2], [7.3, 0.9], [6.1, 3.3], [0.7, 2.9], [3.0, 1.0]];
    let found = constrained(&points, &Constraints::new()).unwrap();
    let refined = refine(&points, &found, &options(33.0));
    assert!(refined.stats.min_angle > 32.999);
    assert!(refined.segment_of.iter().all(|&of| of == NONE) && refined.segment_of.len() > 4);
    let outside = refined.constrained.inside.iter().filter(|&&inside| !inside).count();
    // Rounded points on the hull are inside it: what is between them and the hull is outside.
    assert!(outside < refined.segment_of.len());
}

#[test]
fn nothing_to_refine() {
    for points in [&[][..], &[[1.0, 2.0]], &[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 0.0]]] {
        let edges: Vec<Segment> = (1..points.len() as u32).map(|v| [v - 1, v]).collect();
        let found = constrained(points, &Constraints::new().edges(&edges)).unwrap();
        let refined = found.refine(points, &options(30.0)).unwrap();
        assert_eq!(
            (refined.constrained.mesh.constraints, refined.constrained.segments),
            (found.mesh.constraints, edges)
        );
        assert_eq!(refined.stats, RefineStats::default());
    }
    // Nothing is inside.
    let points = [[0.0, 0.0], [9.0, 0.0], [0.0, 1.0]];
    let found = constrained(&points, &Constraints::new().fill(Fill::EvenOdd)).unwrap();
    assert_eq!(refine(&points, &found, &options(30.0)).constrained.added, [] as [Point; 0]);
}

/// An L with a hole and a segment in it, by another scale and place.
fn rooms(scale: f64, [x, y]: Point) -> (Vec<Point>, Constraints) {
    let corners = [[0, 0], [60, 0], [60, 10], [10, 12], [10, 60], [0, 61], [2, 2], [8, 3], [3, 9], [20, 3], [40, 7]];
    let points = corners.map(|p| p.map(f64::from)).map(|[u, v]| [u * scale + x, v * scale + y]).to_vec();
    let constraints =
        Constraints::new().ring(&[0, 1, 2, 3, 4, 5]).ring(&[6, 7, 8]).edges(&[[9, 10]]).fill(Fill::EvenOdd);
    (points, constraints)
}

#[test]
fn scales_and_places() {
    let [plain, ..] = [(1.0, [0.0, 0.0])].map(|(scale, place)| {
        let (points, constraints) = rooms(scale, place);
        refine_all(&points, &constraints, &options(30.0))
    });
    assert!(plain.stats.min_angle > 29.999 && plain.stats.left.input_angle == 0);
    for exponent in [-1000, -600, -100, 100, 600, 1000] {
        let (points, constraints) = rooms(2f64.powi(exponent), [0.0, 0.0]);
        let refined = refine_all(&points, &constraints, &options(30.0));
        // A power of two changes nothing.
        assert_eq!(refined.constrained.mesh.canonical(), plain.constrained.mesh.canonical(), "2^{exponent}");
    }
    for (scale, place) in [(1.0, [1e8, -3e8]), (1e-300, [0.0, 0.0]), (1e300, [0.0, 0.0]), (1e-3, [1e8, 1e8])] {
        let (points, constraints) = rooms(scale, place);
        let refined = refine_all(&points, &constraints, &options(30.0));
        assert_eq!(refined.stats.left.resolution, 0, "{scale} {place:?}");
    }
    // Coordinates are too coarse for that.
    let (points, constraints) = rooms(1e-7, [1e8, 1e8]);
    let refined = refine_all(&points, &constraints, &options(30.0));
    assert!(refined.stats.left.resolution > 0);
}

#[test]
fn subnormal_and_huge_coordinates() {
    for unit in [f64::from_bits(1), f64::MIN_POSITIVE, 2f64.powi(1017)] {
        let points = [[0.0, 0.0], [60.0, 0.0], [60.0, 7.0], [0.0, 5.0], [31.0, 2.0]].map(|p| p.map(|x: f64| x * unit));
        refine_all(&points, &Constraints::new().edges(&[[0, 4]]), &options(30.0));
    }
    let points = [[-1.7e308, -1.7e308], [1.7e308, -1.7e308], [1.7e308, -1.6e308], [-1.7e308, -1.6e308]];
    refine_all(&points, &Constraints::new(), &options(30.0));
    // A point that is near 0, in comparison.
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1e-200, 2e-200], [1e-100, 1e-150]];
    refine_all(&points, &Constraints::new().edges(&[[0, 3]]), &options(30.0));
}

#[test]
fn holes_and_islands() {
    let square = |side: f64| [[-side, -side], [side, -side], [side, side], [-side, side]];
    let points: Vec<Point> = [9.0, 7.0, 5.0, 3.0, 1.0].into_iter().flat_map(square).collect();
    let rings = (0..5).map(|i| [0, 1, 2, 3].map(|k| 4 * i + k));
    let nested = rings.clone().fold(Constraints::new(), |all, ring| all.ring(&ring)).fill(Fill::EvenOdd);
    let refined = refine_all(&points, &nested, &options(30.0));
    assert!(refined.stats.min_angle > 29.999);
    assert_eq!(refined.constrained.triangle_regions().iter().max(), Some(&4));
    let holes = nested.fill(Fill::Enclosed).hole([8.0, 0.0]).hole([0.0, 0.0]);
    assert!(refine_all(&points, &holes, &options(30.0)).stats.min_angle > 29.999);
}

/// Refines a file to 30°, and returns the number of triangles.
fn triangles_of(name: &str) -> usize {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/refine").join(name);
    let shapes = read_shapes(&path, ShapeFormat::Poly).unwrap();
    let refined = refine_all(&shapes.points, &shapes.constraints(), &options(30.0));
    assert!(refined.stats.min_angle > 29.999 && refined.stats.left == RefineLeft::default());
    refined.constrained.inside_triangles().count()
}

/// Triangle 1.6 makes 52 and 2821 triangles of these; 1.1 times as many are allowed.
#[test]
fn a_letter_and_a_lake() {
    let counts = ["letter-a.poly", "lake.poly"].map(triangles_of);
    assert!(counts[0] <= 57 && counts[1] <= 3103, "{counts:?}");
}

#[test]
fn sizes() {
    let (points, constraints) = rooms(1.0, [0.0, 0.0]);
    let found = constrained(&points, &constraints).unwrap();
    let longest = |refined: &Refined2, at: &dyn Fn(Point) -> bool| {
        let all = [&points[..], &refined.constrained.added].concat();
        let corners = refined.constrained.inside_triangles().map(|t| t.map(|v| all[v as usize]));
        let there = corners.filter(|[a, b, c]| at([0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0)));
        there.flat_map(|[a, b, c]| [length(a, b), length(b, c), length(c, a)]).fold(0.0, f64::max)
    };
    let mut with = options(25.0);
    with.size = Size::Uniform(2.0);
    assert!(longest(&refine(&points, &found, &with), &|_| true) <= 2.0);

    let mut with = options(25.0);
    with.max_area = Some(0.5);
    let refined = refine(&points, &found, &with);
    let all = [&points[..], &refined.constrained.added].concat();
    let areas = refined.constrained.mesh.areas(&all).zip(&refined.constrained.inside);
    assert!(areas.filter(|&(_, &inside)| inside).all(|(area, _)| area <= 0.5));

    let field = |p: Point| if p[0] > 30.0 { 0.5 } else { f64::NAN };
    let mut with = options(25.0);
    with.size = Size::Field(&field);
    let refined = refine(&points, &found, &with);
    assert!(longest(&refined, &|p| p[0] > 30.0) <= 0.5);
    assert!(longest(&refined, &|p| p[1] > 30.0) > 3.0);

    let sizes: Vec<f64> = points.iter().map(|p| 0.5 + p[1] / 10.0).collect();
    let mut with = options(25.0);
    with.size = Size::PerPoint(&sizes);
    let refined = refine(&points, &found, &with);
    assert!(longest(&refined, &|p| p[1] < 5.0) < 1.5);
    assert!(longest(&refined, &|p| p[1] > 30.0) > 2.0);
}

#[test]
fn a_limit_is_kept_and_told() {
    let (points, constraints) = rooms(1.0, [0.0, 0.0]);
    let found = constrained(&points, &constraints).unwrap();
    let needed = refine(&points, &found, &options(30.0)).constrained.added.len();
    for limit in [0, 1, 5, needed - 1] {
        let mut with = options(30.0);
        with.max_points = Some(limit);
        let refined = refine(&points, &found, &with);
        assert!(refined.stats.limited && refined.stats.left.limit > 0, "{limit}");
        assert!(refined.constrained.added.len() <= limit);
    }
}

#[test]
fn a_refined_mesh_can_be_refined() {
    let (points, constraints) = rooms(1.0, [0.3, 0.1]);
    let found = constrained(&points, &constraints).unwrap();
    let first = refine(&points, &found, &options(20.0)).constrained;
    let mut with = options(30.0);
    with.max_area = Some(3.0);
    let second = refine(&points, &first, &with);
    assert!(second.constrained.added.len() > first.added.len());
    assert!(second.stats.min_angle > 29.999);
}

#[test]
fn crossings_that_are_split() {
    let points = [[0.0, 0.0], [3.0, 0.1], [3.1, 3.0], [0.0, 3.0], [1.0, -1.0], [1.3, 4.0]];
    let constraints = Constraints::new().edges(&[[0, 2], [1, 3], [4, 5]]).split_crossings();
    let found = constrained(&points, &constraints).unwrap();
    assert_eq!(found.added.len(), 3);
    refine(&points, &found, &options(30.0));
}

#[test]
fn what_is_wrong_is_an_error() {
    let (points, constraints) = rooms(1.0, [0.0, 0.0]);
    let found = constrained(&points, &constraints).unwrap();
    let error = |change: &dyn Fn(&mut RefineOptions<'static>)| {
        let mut options = RefineOptions::default();
        change(&mut options);
        found.refine(&points, &options).map(drop).unwrap_err().to_string()
    };
    let angle = "the smallest angle must be a number of degrees from 0 to 34";
    for bad in [-1.0, 34.5, f64::NAN] {
        assert_eq!(error(&|options| options.min_angle = bad), angle);
    }
    for bad in [0.0, -1.0, f64::NAN] {
        assert_eq!(error(&|options| options.max_area = Some(bad)), "the largest area must be a positive number");
        assert_eq!(error(&|options| options.size = Size::Uniform(bad)), "the size must be a positive number");
    }
    assert_eq!(error(&|options| options.size = Size::PerPoint(&[1.0, 2.0])), "there are 2 values for 11 points");
    assert_eq!(error(&|options| options.size = Size::PerPoint(&[-1.0; 11])), "sizes must be positive numbers");
    let fewer = found.refine(&points[1..], &RefineOptions::default()).map(drop);
    assert_eq!(fewer.unwrap_err(), Error::PointCount { points: 10, expected: 11 });
    let other: Vec<Point> = points.iter().rev().copied().collect();
    assert!(matches!(found.refine(&other, &RefineOptions::default()), Err(Error::BrokenMesh { .. })));
    let breaks: [fn(&mut Constrained2); 6] = [
        |found| _ = found.inside.pop(),
        |found| found.mesh.triangles[0][1] = 99,
        |found| found.mesh.triangles[0][1] = NONE,
        |found| found.mesh.halfedges[0] = [1, 2, 99],
        |found| found.mesh.duplicate_of[3] = 99,
        |found| found.mesh.constraints.swap(0, 1),
    ];
    for (i, spoil) in breaks.iter().enumerate() {
        let mut broken = found.clone();
        spoil(&mut broken);
        let error = broken.refine(&points, &RefineOptions::default()).map(drop);
        assert!(matches!(error, Err(Error::BrokenMesh { .. })), "{i}: {error:?}");
    }
    let mut broken = found.clone();
    broken.segments[1] = [3, 99];
    let error = broken.refine(&points, &RefineOptions::default()).map(drop).unwrap_err();
    assert_eq!(error, Error::BadConstraint { segment: [3, 99], points: 11 });
}
