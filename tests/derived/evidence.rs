//! Surfaces with evidence, and open ones: checked by counting, and against shapes whose sides are known.

use crate::{
    inputs::{mesh2, mesh3},
    surface::{grid_box, noisy, random, sphere, torus},
};
use gdel::{Error, Evidence, Open, Points, Side, Surface, SurfaceOptions};
use std::{
    collections::{BTreeMap, BTreeSet},
    f64::consts::{PI, TAU},
};

/// Finds the surface, and checks that it is oriented and a manifold, perhaps with a boundary.
fn found(points: &[[f64; 3]], options: &SurfaceOptions<'_>) -> Surface {
    let surface = Surface::new(&mesh3(points), Points::F64(points), options).unwrap();
    check(&surface);
    surface
}

pub(crate) fn check(surface: &Surface) {
    let facets = surface.facets();
    assert_eq!(surface.vertices().len(), surface.sources().len());
    assert!(surface.sources().is_sorted());
    // Each edge has at most one triangle in each direction.
    let edges = || facets.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let directed: BTreeSet<[u32; 2]> = edges().collect();
    assert_eq!(directed.len(), 3 * facets.len());
    let rim: Vec<[u32; 2]> = edges().filter(|&[a, b]| !directed.contains(&[b, a])).collect();
    assert_eq!(surface.is_closed(), rim.is_empty());
    assert_eq!(surface.boundaries() == 0, rim.is_empty());
    // The triangles around each vertex are one cycle or one fan.
    let mut around: Vec<BTreeMap<u32, u32>> = vec![BTreeMap::new(); surface.vertices().len()];
    for &[a, b, c] in facets {
        for [v, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
            assert_eq!(around[v as usize].insert(from, to), None);
        }
    }
    for next in around {
        let targets: BTreeSet<u32> = next.values().copied().collect();
        let starts: Vec<u32> = next.keys().copied().filter(|from| !targets.contains(from)).collect();
        assert!(starts.len() <= 1, "two fans");
        let mut at = starts.first().copied().unwrap_or(*next.keys().next().expect("a vertex has triangles"));
        let steps = (0..next.len()).take_while(|_| next.get(&at).map(|&to| at = to).is_some()).count();
        assert_eq!(steps, next.len());
    }
    // Each boundary is a cycle of edges.
    let next: BTreeMap<u32, u32> = rim.iter().map(|&[a, b]| (a, b)).collect();
    let (mut left, mut cycles): (BTreeSet<u32>, _) = (next.keys().copied().collect(), 0);
    while let Some(start) = left.pop_first() {
        cycles += 1;
        let mut at = next[&start];
        while at != start {
            assert!(left.remove(&at));
            at = next[&at];
        }
    }
    assert_eq!(cycles, surface.boundaries());
}

/// The share of the area whose normal has a positive product with a direction that depends on the place.
fn share(surface: &Surface, direction: impl Fn([f64; 3]) -> [f64; 3]) -> f64 {
    let (mut positive, mut all) = (0.0, 0.0);
    for facet in surface.facets() {
        let [a, b, c] = facet.map(|v| surface.vertices()[v as usize]);
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let area = dot(normal, normal).sqrt();
        all += area;
        if dot(normal, direction(a)) > 0.0 {
            positive += area;
        }
    }
    positive / all
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Random points of the part of the unit sphere above a height.
fn cap(n: usize, above: f64) -> Vec<[f64; 3]> {
    let points = random(n, 3).into_iter().map(|[u, v, _]| {
        let z = above + (1.0 - above) * u;
        let r = (1.0 - z * z).sqrt();
        [r * libm::cos(TAU * v), r * libm::sin(TAU * v), z]
    });
    points.collect()
}

/// Random points of hills in a square of side 10.
fn hills(n: usize) -> Vec<[f64; 3]> {
    let points = random(n, 8).into_iter().map(|[x, y, _]| [10.0 * x, 10.0 * y]);
    points.map(|[x, y]| [x, y, libm::sin(x) * libm::cos(0.7 * y)]).collect()
}

/// A wall with a ball before it, as a camera at the origin sees them.
fn view(columns: u32) -> Vec<[f64; 3]> {
    let rows = columns * 3 / 4;
    let jitter = random((columns * rows) as usize, 2);
    let rays = (0..columns * rows).zip(jitter).map(|(i, [a, b, noise])| {
        let x = (f64::from(i % columns) + 0.3 * a) / f64::from(columns) - 0.5;
        let y = (f64::from(i / columns) + 0.3 * b) / f64::from(columns) - 0.375;
        ([x, y, 1.0], 3.0 + 0.001 * noise)
    });
    rays.map(|(ray, wall)| {
        let center = [0.2, 0.1, 2.2];
        let (a, b, c) = (dot(ray, ray), dot(ray, center), dot(center, center) - 0.16);
        let discriminant = b * b - a * c;
        let t = if discriminant > 0.0 { (b - discriminant.sqrt()) / a } else { wall };
        ray.map(|x| t * x)
    })
    .collect()
}

fn auto<'a>() -> SurfaceOptions<'a> {
    let mut options = SurfaceOptions::default();
    options.open = Open::Auto;
    options
}

#[test]
fn a_cap_of_a_sphere_comes_out_as_the_cap() {
    for above in [-0.5, 0.0, 0.7] {
        let points = cap(6000, above);
        let closed = found(&points, &SurfaceOptions::default());
        assert!(closed.is_closed());
        assert_eq!(closed.evidence(), Evidence::Guess, "{above}");
        let surface = found(&points, &auto());
        assert_eq!((surface.components(), surface.boundaries(), surface.genus()), (1, 1, 0), "{above}");
        assert!((surface.area() / (TAU * (1.0 - above)) - 1.0).abs() < 0.01, "{above}: {}", surface.area());
        assert_eq!(surface.volume(), closed.volume());
        assert!(surface.sides().iter().filter(|&&side| side == Side::On).count() > 5950);
    }
}

#[test]
fn points_far_away_leave_terrain_and_walls_open() {
    let up = [0.0, 0.0, 1.0];
    for (name, points, middle, size, up) in [
        ("terrain", hills(6000), [5.0, 5.0, 0.0], 10.0, Some(up)),
        ("terrain whose side is unknown", hills(6000), [5.0, 5.0, 0.0], 10.0, None),
        ("wall", view(80), [0.0, 0.0, 2.5], 3.0, None),
    ] {
        let mut options = auto();
        options.up = up;
        let expected = found(&points, &options).area();
        // A few that are many times farther away than the scan is large, and one of a hundred around it.
        for (count, reach) in [(1, 5.0), (4, 5.0), (20, 3.0), (60, 1.5)] {
            let far = random(count, 9).into_iter();
            let far = far.map(|p| std::array::from_fn(|axis| middle[axis] + 2.0 * reach * size * (p[axis] - 0.5)));
            let points: Vec<[f64; 3]> = points.iter().copied().chain(far).collect();
            let surface = found(&points, &options);
            println!("{name}, {count}: {} dropped, {} of {expected}", surface.isolated(), surface.area());
            assert!(!surface.is_closed(), "{name}, {count}");
            assert!((surface.area() / expected - 1.0).abs() < 0.02, "{name}, {count}");
            assert!(surface.isolated() >= count - count / 10, "{name}, {count}");
        }
    }
}

#[test]
fn closed_shapes_stay_closed() {
    let boxes = [grid_box([0.0; 3], [8, 6, 4], 0.5), grid_box([4.0, 0.0, 0.0], [8, 6, 4], 0.5)].concat();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/bunny.ply");
    let bunny = gdel_io::files::read_points(std::path::Path::new(path)).expect("the bunny");
    let bunny: Vec<[f64; 3]> = Points::from(&bunny).iter().collect();
    let few: Vec<[f64; 3]> = bunny.iter().copied().step_by(20).collect();
    let corners: Vec<[f64; 3]> = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
    for points in [sphere(500, 1.0), torus(5000), boxes, bunny, few, corners] {
        let mut options = SurfaceOptions::default();
        options.smooth = Some(0);
        let closed = found(&points, &options);
        options.open = Open::Auto;
        let surface = found(&points, &options);
        assert!(surface.is_closed());
        assert_eq!((surface.facets(), surface.evidence()), (closed.facets(), Evidence::Hull));
    }
}

#[test]
fn the_ground_is_solid_where_up_is_known() {
    let points = hills(6000);
    let mut options = auto();
    options.up = Some([0.0, 0.0, 2.0]);
    let surface = found(&points, &options);
    assert_eq!((surface.evidence(), surface.components()), (Evidence::Below, 1));
    assert!(share(&surface, |_| [0.0, 0.0, 1.0]) > 0.99);
    assert!((100.0..135.0).contains(&surface.area()), "{}", surface.area());
    assert!(surface.sides().iter().filter(|&&side| side == Side::On).count() > 5900);
    // With its flat bottom.
    options.open = Open::Never;
    assert!(found(&points, &options).is_closed());
    // Upside down, the space above is solid.
    (options.open, options.up) = (Open::Auto, Some([0.0, 0.0, -1.0]));
    assert!(share(&found(&points, &options), |_| [0.0, 0.0, 1.0]) < 0.01);
}

#[test]
fn a_sensor_sees_one_side() {
    let points = view(80);
    let sensor = [[0.0; 3]];
    let mut options = auto();
    options.sensors = Some(Points::F64(&sensor));
    let surface = found(&points, &options);
    assert_eq!(surface.evidence(), Evidence::Sensors);
    let towards = |p: [f64; 3]| p.map(|x| -x);
    assert!(share(&surface, towards) > 0.98, "{}", share(&surface, towards));
    assert!(surface.sides().iter().filter(|&&side| side == Side::On).count() > points.len() * 98 / 100);
    // One sensor for each point says the same.
    let sensors = vec![[0.0f32; 3]; points.len()];
    options.sensors = Some(Points::F32(&sensors));
    assert_eq!(found(&points, &options).facets(), surface.facets());
    // From behind, the other side is outside.
    let behind = [[0.3, 0.2, 60.0]];
    options.sensors = Some(Points::F64(&behind));
    assert!(share(&found(&points, &options), towards) < 0.05);
    options.sensors = None;
    assert_eq!(found(&points, &options).evidence(), Evidence::Guess);
}

/// Returns the directions from the circle in the middle of a torus to points around it.
fn normals_of_torus(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let outward = |&[x, y, z]: &[f64; 3]| {
        let r = libm::hypot(x, y);
        [x - x / r, y - y / r, z]
    };
    points.iter().map(outward).collect()
}

#[test]
fn normals_decide() {
    let points = torus(6000);
    let normals = normals_of_torus(&points);
    let mut options = SurfaceOptions::default();
    options.normals = Some(Points::F64(&normals));
    let surface = found(&points, &options);
    assert_eq!((surface.evidence(), surface.components(), surface.genus()), (Evidence::Normals, 1, 1));
    assert!((surface.volume() / (2.0 * PI * PI * 0.16) - 1.0).abs() < 0.01);
    // A few wrong ones, and a third that are unknown, do no harm.
    let mut some = normals.clone();
    some.iter_mut().step_by(20).for_each(|n| *n = n.map(|x| -x));
    some.iter_mut().skip(1).step_by(3).for_each(|n| *n = [0.0; 3]);
    options.normals = Some(Points::F64(&some));
    let surface = found(&points, &options);
    assert_eq!((surface.components(), surface.genus()), (1, 1));
    assert!((surface.volume() / (2.0 * PI * PI * 0.16) - 1.0).abs() < 0.02, "{}", surface.volume());
    // If all are unknown, it is as without.
    let zeros = vec![[0.0; 3]; points.len()];
    options.normals = Some(Points::F64(&zeros));
    let surface = found(&points, &options);
    assert_eq!(surface.evidence(), Evidence::Hull);
    assert_eq!(surface.facets(), found(&points, &SurfaceOptions::default()).facets());
}

#[test]
fn normals_turn_terrain_over() {
    let points = hills(4000);
    for direction in [1.0, -1.0] {
        let normals = vec![[0.0, 0.0, direction]; points.len()];
        let mut options = auto();
        options.normals = Some(Points::F64(&normals));
        let surface = found(&points, &options);
        assert!(share(&surface, |_| [0.0, 0.0, direction]) > 0.99, "{direction}");
    }
}

#[test]
fn normals_of_moved_and_dropped_points() {
    let mut points = noisy(&torus(6000), 0.01);
    points.extend(random(30, 9).iter().map(|p| p.map(|x| 4.0 * x - 2.0)));
    let normals = normals_of_torus(&points);
    let mut options = SurfaceOptions::default();
    options.normals = Some(Points::F64(&normals));
    let surface = found(&points, &options);
    assert!(surface.isolated() > 20 && surface.moved_points().is_some());
    assert_eq!((surface.components(), surface.genus()), (1, 1));
}

#[test]
fn shapes_within_shapes_have_the_sides_that_normals_say() {
    // A ball in a ball: with all normals outwards, both are solid, and nothing is between.
    let points = [sphere(3000, 2.0), sphere(1000, 1.0)].concat();
    let mut options = SurfaceOptions::default();
    assert_eq!(found(&points, &options).components(), 2);
    let inwards: Vec<[f64; 3]> =
        points.iter().enumerate().map(|(i, p)| if i < 3000 { *p } else { p.map(|x| -x) }).collect();
    options.normals = Some(Points::F64(&inwards));
    let surface = found(&points, &options);
    assert_eq!(surface.components(), 2);
    assert!((surface.volume() / (4.0 / 3.0 * PI * 7.0) - 1.0).abs() < 0.01);
    // Boxes that touch, with the normals of each face.
    let boxes = [grid_box([0.0; 3], [8, 6, 4], 0.5), grid_box([4.0, 3.0, 0.0], [8, 6, 4], 0.5)].concat();
    let normals: Vec<[f64; 3]> = boxes
        .iter()
        .enumerate()
        .map(|(i, p)| minus(*p, if i < boxes.len() / 2 { [2.0, 1.5, 1.0] } else { [6.0, 4.5, 1.0] }))
        .collect();
    (options.normals, options.smooth) = (Some(Points::F64(&normals)), Some(0));
    let surface = found(&boxes, &options);
    assert!((surface.volume() / 48.0 - 1.0).abs() < 0.02, "{}", surface.volume());
}

#[test]
fn degenerate_points_with_evidence() {
    let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [2.0, 5.0, 0.0]];
    let equal = [[1.0, 2.0, 3.0]; 7];
    let ones = [[0.0, 0.0, 1.0]; 7];
    for points in [&flat[..], &flat[..3], &flat[..0], &equal] {
        let mut options = auto();
        options.normals = Some(Points::F64(&ones[..points.len()]));
        // A sensor at a point sees it from nowhere.
        options.sensors = Some(Points::F64(&flat[..1]));
        options.up = Some([0.0, 0.0, 1.0]);
        let surface = found(points, &options);
        assert_eq!((surface.facets().len(), surface.boundaries(), surface.genus()), (0, 0, 0));
        assert_eq!(surface.sides(), vec![Side::Outside; points.len()]);
    }
    // Grids have many equal spheres, and lines of sight through edges and vertices.
    let grid: Vec<[f64; 3]> = (0..216).map(|i| [i % 6, i / 6 % 6, i / 36].map(f64::from)).collect();
    for sensor in [[2.0, 2.0, 2.0], [-5.0, 0.0, 0.0], [100.0, 100.0, 100.0], [1e300, 0.0, 0.0]] {
        let mut options = auto();
        options.sensors = Some(Points::F64(std::slice::from_ref(&sensor)));
        found(&grid, &options);
    }
}

#[test]
fn bad_evidence_is_an_error() {
    let points = sphere(50, 1.0);
    let error = |options: &SurfaceOptions<'_>| Surface::new(&mesh3(&points), &points, options).unwrap_err();
    let mut options = SurfaceOptions::default();
    let mut vectors = points.clone();
    options.normals = Some(Points::F64(&vectors[1..]));
    assert_eq!(error(&options), Error::ValueCount { values: 49, points: 50 });
    options.normals = None;
    options.sensors = Some(Points::F64(&vectors[..2]));
    assert_eq!(error(&options), Error::ValueCount { values: 2, points: 50 });
    options.sensors = None;
    for bad in [[0.0; 3], [f64::NAN, 0.0, 1.0], [0.0, f64::INFINITY, 1.0]] {
        options.up = Some(bad);
        assert_eq!(error(&options), Error::BadOption { option: "up", range: "finite and not zero" });
    }
    vectors[7][1] = f64::NAN;
    let mut options = SurfaceOptions::default();
    options.normals = Some(Points::F64(&vectors));
    let range = "finite; zero where one is unknown";
    assert_eq!(error(&options), Error::BadOption { option: "normals", range });
    options.normals = None;
    options.sensors = Some(Points::F64(&vectors));
    assert_eq!(error(&options), Error::BadOption { option: "sensors", range: "finite" });
}

#[test]
fn curves_may_be_open() {
    // Half a circle, and its diameter, which closes it.
    let arc: Vec<[f64; 2]> = (0..100).map(|i| PI * f64::from(i) / 99.0).map(|a| [libm::cos(a), libm::sin(a)]).collect();
    let mut options = SurfaceOptions::default();
    let closed = Surface::new(&mesh2(&arc), &arc, &options).unwrap();
    assert_eq!((closed.evidence(), closed.boundaries(), closed.components()), (Evidence::Guess, 0, 1));
    options.open = Open::Auto;
    let curve = Surface::new(&mesh2(&arc), &arc, &options).unwrap();
    assert_eq!((curve.facets().len(), curve.boundaries()), (closed.facets().len() - 1, 1));
    assert_eq!(curve.vertices().len(), curve.facets().len() + 1);
    assert!((curve.area() / PI - 1.0).abs() < 0.05 && !curve.is_closed());
    // A profile of terrain, with the ground below.
    let profile: Vec<[f64; 2]> = (0..400).map(|i| 0.05 * f64::from(i)).map(|x| [x, libm::sin(x)]).collect();
    options.up = Some([0.0, 1.0]);
    let curve = Surface::new(&mesh2(&profile), &profile, &options).unwrap();
    assert_eq!((curve.evidence(), curve.components(), curve.boundaries()), (Evidence::Below, 1, 1));
    // At the end of the last slope, the ground is thinner than the points are far from each other.
    assert!(curve.facets().len() > 355, "{}", curve.facets().len());
    // The inside is on the left of each edge, so that the ground is passed from right to left.
    assert!(curve.facets().iter().all(|e| curve.vertices()[e[0] as usize][0] > curve.vertices()[e[1] as usize][0]));
    let normals: Vec<[f64; 2]> = profile.iter().map(|p| [-libm::cos(p[0]), 1.0]).collect();
    let mut options = SurfaceOptions::default();
    (options.open, options.normals) = (Open::Auto, Some(Points::F64(&normals)));
    let by_normals = Surface::new(&mesh2(&profile), &profile, &options).unwrap();
    assert!(by_normals.facets().len() > 355, "{}", by_normals.facets().len());
}
